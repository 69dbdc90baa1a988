// The same cube in every form that PLY, OBJ and OFF know, and files that are none.
#include "engine/tooth/mesh/polygon_files.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "engine/base/file_error.h"
#include "tests/engine/support/basics.h"

namespace cavum {
namespace {

using testing_basics::bytes_of;

const std::vector<std::vector<std::uint32_t>> k_sides{{0, 2, 3, 1}, {4, 5, 7, 6}, {0, 1, 5, 4},
                                                      {2, 6, 7, 3}, {0, 4, 6, 2}, {1, 3, 7, 5}};
Vec3 corner(std::uint32_t i) { return {2.5 * (i & 1), 2.5 * (i >> 1 & 1), 2.5 * (i >> 2)}; }

std::string words(const Vec3& p) {
  return std::to_string(p.x) + " " + std::to_string(p.y) + " " + std::to_string(p.z);
}

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
      from_end +=
          std::string(i == s[2] ? " \\\n" : " ") + std::to_string(static_cast<int>(i) - 8) + "//1";
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
  using enum FileError;
  const struct {
    Polygons (*read)(const Bytes&, const std::string&);
    const char* text;
    FileError code;
    const char* place;
  } cases[] = {
      {read_ply, "ply\nformat ascii 1.0\nproperty float x\nend_header\n", inconsistent, "a:3"},
      {read_ply, "ply\nformat ascii 1.0\nelement vertex 4000000000\nend_header\n", inconsistent,
       "a"},
      {read_ply,
       "ply\nformat ascii 1.0\nelement vertex 4000000000\nproperty float x\nend_header\n1\n",
       inconsistent, "a"},
      {read_ply,
       "ply\nformat binary_little_endian 1.0\nelement vertex 9\nproperty double x\nend_header\n1",
       truncated, "a"},
      {read_ply,
       "ply\nformat ascii 1.0\nelement face 1\nproperty list uchar int vertex_index\nend_header\n3 0 1 2\n",
       inconsistent, "a"},
      {read_ply, "ply\nelement vertex 0\n", truncated, "a"},
      {read_obj, "v 0 0 0\nf 1 -2 1\n", malformed, "a:2"},
      {read_obj, "v 0 zero 0\n", malformed, "a:1"},
      {read_obj, "v 0 0 0\nf 1 1 5000000\n", inconsistent, "a"},
      {read_off, "OFF\n4000000000 4000000000 0\n0 0 0\n", truncated, "a"},
      {read_off, "4OFF\n1 1 1\n", unsupported, "a"},
      {read_off, "OFF BINARY\n", unsupported, "a"},
  };
  for (const auto& c : cases) {
    const auto error =
        testing_basics::thrown_by([&] { static_cast<void>(c.read(bytes_of(c.text), "a")); });
    EXPECT_EQ(testing_basics::code_of(error), c.code) << c.text;
    EXPECT_EQ(testing_basics::place_of(error), c.place) << c.text;
  }
}

}  // namespace
}  // namespace cavum
