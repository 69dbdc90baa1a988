// A surface from a file: STL from memory, as scenarios read it, and STL, PLY, OBJ and OFF from a
// file, as `cavum tooth import` and, open ones too, `cavum scan` do.
#include <array>
#include <fstream>

#include "engine/tooth/mesh/read_mesh.h"
#include "tests/fuzz/material.h"
#include "tests/fuzz/targets.h"

namespace cavum::fuzz {
namespace {

constexpr std::array<const char*, 5> k_kinds{"", ".stl", ".ply", ".obj", ".off"};

constexpr std::array<std::array<int, 3>, 4> k_faces{{{0, 2, 1}, {0, 1, 3}, {1, 2, 3}, {2, 0, 3}}};
constexpr std::array<std::array<int, 3>, 4> k_corners{{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}}};

std::string corner(int i, const char* begin) {
  const auto& c = k_corners[static_cast<std::size_t>(i)];
  return begin + std::to_string(c[0]) + " " + std::to_string(c[1]) + " " + std::to_string(c[2]) +
         "\n";
}

std::string stl_text() {
  std::string s = "solid a\n";
  for (const auto& f : k_faces) {
    s += "facet normal 0 0 1\nouter loop\n";
    for (const int i : f) s += corner(i, "vertex ");
    s += "endloop\nendfacet\n";
  }
  return s + "endsolid a\n";
}

Bytes stl_binary() {
  ByteWriter out;
  for (int i = 0; i < 80; ++i) out.put(std::uint8_t{0});
  out.put(static_cast<std::uint32_t>(k_faces.size()));
  for (const auto& f : k_faces) {
    for (int i = 0; i < 3; ++i) out.put(0.0F);
    for (const int i : f)
      for (const int x : k_corners[static_cast<std::size_t>(i)]) out.put(static_cast<float>(x));
    out.put(std::uint16_t{0});
  }
  return out.take();
}

std::string ply_head(const std::string& format) {
  return "ply\nformat " + format +
         " 1.0\ncomment x\nelement vertex 4\nproperty float x\nproperty float y\nproperty float z\nelement face 4\nproperty list uchar int "
         "vertex_indices\nend_header\n";
}

std::string ply_text() {
  std::string s = ply_head("ascii");
  for (int i = 0; i < 4; ++i) s += corner(i, "");
  for (const auto& f : k_faces)
    s += "3 " + std::to_string(f[0]) + " " + std::to_string(f[1]) + " " + std::to_string(f[2]) +
         "\n";
  return s;
}

Bytes ply_binary() {
  ByteWriter out;
  for (const char c : ply_head("binary_little_endian")) out.put(c);
  for (const auto& c : k_corners)
    for (const int x : c) out.put(static_cast<float>(x));
  for (const auto& f : k_faces) {
    out.put(std::uint8_t{3});
    for (const int i : f) out.put(static_cast<std::int32_t>(i));
  }
  return out.take();
}

std::string obj_text() {
  std::string s = "# a\nmtllib a.mtl\no a\n";
  for (int i = 0; i < 4; ++i) s += corner(i, "v ");
  s += "vt 0 0\nvn 0 0 1\nusemtl a\n";
  for (const auto& f : k_faces)
    s += "f " + std::to_string(f[0] + 1) + "/1/1 " + std::to_string(f[1] + 1) + "//1 " +
         std::to_string(f[2] + 1) + "\n";
  return s;
}

std::string off_text() {
  std::string s = "OFF\n4 4 6\n";
  for (int i = 0; i < 4; ++i) s += corner(i, "");
  for (const auto& f : k_faces)
    s += "3 " + std::to_string(f[0]) + " " + std::to_string(f[1]) + " " + std::to_string(f[2]) +
         "\n";
  return s;
}

Bytes with(std::uint8_t kind, const Bytes& rest) {
  Bytes out;
  out.reserve(rest.size() + 1);
  out.push_back(kind);
  out.insert(out.end(), rest.begin(), rest.end());
  return out;
}

}  // namespace

void fuzz_mesh(Data data) {
  if (data.empty()) return;
  const std::size_t kind = data[0] % k_kinds.size();
  const Bytes file(data.begin() + 1, data.end());
  try {
    if (kind == 0) {
      static_cast<void>(connected_parts(read_closed_stl(file, "zone.stl").mesh));
      return;
    }
    const std::string path = work_folder() + "/surface" + k_kinds[kind];
    std::ofstream(path, std::ios::binary | std::ios::trunc)
        .write(reinterpret_cast<const char*>(file.data()),
               static_cast<std::streamsize>(file.size()));
    static_cast<void>(connected_parts(read_open_mesh(path)));
    static_cast<void>(connected_parts(read_closed_mesh(path).mesh));
  } catch (const Error&) {
  }
}

std::vector<Bytes> mesh_seeds() {
  return {with(0, bytes_of(stl_text())), with(0, stl_binary()),
          with(1, bytes_of(stl_text())), with(1, stl_binary()),
          with(2, bytes_of(ply_text())), with(2, ply_binary()),
          with(3, bytes_of(obj_text())), with(4, bytes_of(off_text()))};
}

}  // namespace cavum::fuzz
