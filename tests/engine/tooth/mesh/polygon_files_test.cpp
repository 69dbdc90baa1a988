// The same cube in every form that PLY, OBJ and OFF know, and files that are none.
#include "engine/tooth/mesh/polygon_files.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "tests/engine/support/basics.h"

namespace cavum {
namespace {

using testing_basics::error_of;

Bytes bytes_of(const std::string& text) { return {text.begin(), text.end()}; }

const std::vector<std::vector<std::uint32_t>> k_sides{{0, 2, 3, 1}, {4, 5, 7, 6}, {0, 1, 5, 4}, {2, 6, 7, 3}, {0, 4, 6, 2}, {1, 3, 7, 5}};
Vec3 corner(std::uint32_t i) { return {2.5 * (i & 1), 2.5 * (i >> 1 & 1), 2.5 * (i >> 2)}; }

std::string words(const Vec3& p) { return std::to_string(p.x) + " " + std::to_string(p.y) + " " + std::to_string(p.z); }

void expect_cube(const Polygons& read) {
  ASSERT_EQ(read.corners_mm.size(), 8u);
  for (std::uint32_t i = 0; i < 8; ++i) EXPECT_EQ(read.corners_mm[i], corner(i));
  EXPECT_EQ(read.polygons, k_sides);
}

/// With a property before and a list behind the coordinates, and an element that nobody knows.
Bytes binary_ply(const std::string& format) {
  const std::string head =
      "ply\nformat " + format +
      " 1.0\nelement extra 1\nproperty list uchar short numbers\nelement vertex 8\nproperty uchar red\nproperty float x\nproperty double "
      "y\nproperty float z\nelement face 6\nproperty list uchar int vertex_indices\nproperty ushort group\nend_header\n";
  ByteWriter out;
  for (const char c : head) out.put(c);
  const auto put = [&](auto value) {
    ByteWriter one;
    one.put(value);
    Bytes b = one.take();
    if (format == "binary_big_endian") std::reverse(b.begin(), b.end());
    out.put_bytes(b);
  };
  put(std::uint8_t{2});
  put(std::int16_t{-7});
  put(std::int16_t{7});
  for (std::uint32_t i = 0; i < 8; ++i) {
    put(std::uint8_t{200});
    put(static_cast<float>(corner(i).x));
    put(corner(i).y);
    put(static_cast<float>(corner(i).z));
  }
  for (const auto& side : k_sides) {
    put(std::uint8_t{4});
    for (const auto i : side) put(static_cast<std::int32_t>(i));
    put(std::uint16_t{65535});
  }
  return out.take();
}

TEST(PolygonFiles, PlyInBothByteOrdersAndAsText) {
  expect_cube(read_ply(binary_ply("binary_little_endian"), "a.ply"));
  expect_cube(read_ply(binary_ply("binary_big_endian"), "a.ply"));
  std::string text =
      "ply\r\nformat ascii 1.0\r\ncomment a cube\r\nelement vertex 8\r\nproperty float x\r\nproperty float y\r\nproperty float z\r\nelement face "
      "6\r\nproperty list uchar int vertex_index\r\nend_header\r\n";
  for (std::uint32_t i = 0; i < 8; ++i) text += words(corner(i)) + "\r\n";
  for (const auto& s : k_sides) {
    text += "4";
    for (const auto i : s) text += " " + std::to_string(i);
    text += "\r\n";
  }
  expect_cube(read_ply(bytes_of(text), "a.ply"));
}

TEST(PolygonFiles, ObjWithNumbersFromTheBeginningOrTheEnd) {
  std::string text = "# a cube\nmtllib a.mtl\no cube\n", from_end;
  for (std::uint32_t i = 0; i < 8; ++i) text += "v " + words(corner(i)) + " 0.5 0.5 0.5\n";
  from_end = text;
  for (const auto& s : k_sides) {
    text += "f";
    from_end += "f";
    for (const auto i : s) {
      text += " " + std::to_string(i + 1) + "/1/2";
      from_end += std::string(i == s[2] ? " \\\n" : " ") + std::to_string(static_cast<int>(i) - 8) + "//1";
    }
    text += "  # side\n";
    from_end += "\n";
  }
  expect_cube(read_obj(bytes_of(text), "a.obj"));
  expect_cube(read_obj(bytes_of(from_end), "a.obj"));
}

TEST(PolygonFiles, OffWithNormalsColoursAndComments) {
  std::string text = "NOFF # normals\n\n8 6 12\n";
  for (std::uint32_t i = 0; i < 8; ++i) text += words(corner(i)) + " 0 0 1\n# nothing\n";
  for (const auto& s : k_sides) {
    text += "4";
    for (const auto i : s) text += " " + std::to_string(i);
    text += " 255 0 0\n";
  }
  expect_cube(read_off(bytes_of(text), "a.off"));
}

TEST(PolygonFiles, WhatIsNoneIsNamedWithItsPlace) {
  const auto ply = [](const std::string& text) { return error_of([&] { static_cast<void>(read_ply(bytes_of(text), "a.ply")); }); };
  const auto obj = [](const std::string& text) { return error_of([&] { static_cast<void>(read_obj(bytes_of(text), "a.obj")); }); };
  const auto off = [](const std::string& text) { return error_of([&] { static_cast<void>(read_off(bytes_of(text), "a.off")); }); };
  EXPECT_NE(ply("ply\nformat ascii 1.0\nproperty float x\nend_header\n").find("a.ply:3: has a property of no element"), std::string::npos);
  EXPECT_NE(ply("ply\nformat ascii 1.0\nelement vertex 4000000000\nend_header\n").find("without a property"), std::string::npos);
  EXPECT_NE(ply("ply\nformat ascii 1.0\nelement vertex 4000000000\nproperty float x\nend_header\n1\n").find("without x, y or z"), std::string::npos);
  EXPECT_NE(ply("ply\nformat binary_little_endian 1.0\nelement vertex 9\nproperty double x\nend_header\n1").find("cut off"), std::string::npos);
  EXPECT_NE(ply("ply\nformat ascii 1.0\nelement face 1\nproperty list uchar int vertex_index\nend_header\n3 0 1 2\n")
                .find("names a corner that is not there"),
            std::string::npos);
  EXPECT_NE(ply("ply\nelement vertex 0\n").find("within its head"), std::string::npos);
  EXPECT_NE(obj("v 0 0 0\nf 1 -2 1\n").find("a.obj:2: '-2' is no corner"), std::string::npos);
  EXPECT_NE(obj("v 0 zero 0\n").find("'zero' is no coordinate"), std::string::npos);
  EXPECT_NE(obj("v 0 0 0\nf 1 1 5000000\n").find("names a corner that is not there"), std::string::npos);
  EXPECT_NE(off("OFF\n4000000000 4000000000 0\n0 0 0\n").find("cut off"), std::string::npos);
  EXPECT_NE(off("4OFF\n1 1 1\n").find("another kind"), std::string::npos);
  EXPECT_NE(off("OFF BINARY\n").find("another kind"), std::string::npos);
}

}  // namespace
}  // namespace cavum
