// Files that the import tests write themselves, byte by byte, so that reader and writer share no
// code: meshes with volumes known in closed form, raw volumes behind headers, NIfTI, and a DICOM
// series.
#pragma once

#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <functional>
#include <string>
#include <vector>

#include "engine/base/file.h"
#include "engine/tooth/surface_mesh.h"
#include "tests/engine/support/basics.h"

namespace cavum::testing_import {

namespace fs = std::filesystem;

/// A folder of its own for the running test, emptied first.
inline fs::path fresh_folder() {
  const auto* test = ::testing::UnitTest::GetInstance()->current_test_info();
  auto folder = fs::temp_directory_path() /
                (std::string("cavum_") + test->test_suite_name() + "_" + test->name());
  fs::remove_all(folder);
  fs::create_directories(folder);
  return folder;
}

using namespace testing_basics;

/// The folder `shared/` beside the repository, or an empty path.
inline fs::path shared_folder() {
  const fs::path shared = fs::path(CAVUM_SOURCE_DIR) / ".." / "shared";
  return fs::exists(shared / "teeth") ? shared : fs::path();
}

/// Ball of triangles whose corners lie on the sphere; `rings` 60 misses the ball's volume by 0.2 %.
inline TriangleMesh ball(Vec3 centre, double radius, int rings) {
  TriangleMesh m;
  const int around = 2 * rings;
  m.vertices_mm.push_back(centre + Vec3{0, 0, radius});
  for (int r = 1; r < rings; ++r)
    for (int a = 0; a < around; ++a) {
      const double t = M_PI * r / rings, p = 2 * M_PI * a / around;
      m.vertices_mm.push_back(
          centre +
          Vec3{std::sin(t) * std::cos(p), std::sin(t) * std::sin(p), std::cos(t)} * radius);
    }
  m.vertices_mm.push_back(centre - Vec3{0, 0, radius});
  const auto at = [&](int r, int a) {
    return static_cast<std::uint32_t>(1 + (r - 1) * around + (a + around) % around);
  };
  const auto last = static_cast<std::uint32_t>(m.vertices_mm.size() - 1);
  for (int a = 0; a < around; ++a) {
    m.triangles.push_back({0, at(1, a), at(1, a + 1)});
    m.triangles.push_back({last, at(rings - 1, a + 1), at(rings - 1, a)});
    for (int r = 1; r + 1 < rings; ++r) {
      m.triangles.push_back({at(r, a), at(r + 1, a), at(r + 1, a + 1)});
      m.triangles.push_back({at(r, a), at(r + 1, a + 1), at(r, a + 1)});
    }
  }
  return m;
}

inline TriangleMesh box(Vec3 low, Vec3 high) {
  TriangleMesh m;
  for (int i = 0; i < 8; ++i)
    m.vertices_mm.push_back(
        {i & 1 ? high.x : low.x, i & 2 ? high.y : low.y, i & 4 ? high.z : low.z});
  m.triangles = {{0, 2, 3}, {0, 3, 1}, {4, 5, 7}, {4, 7, 6}, {0, 1, 5}, {0, 5, 4},
                 {2, 6, 7}, {2, 7, 3}, {0, 4, 6}, {0, 6, 2}, {1, 3, 7}, {1, 7, 5}};
  return m;
}

inline void turn_inside_out(TriangleMesh& m) {
  for (auto& t : m.triangles) std::swap(t[1], t[2]);
}

inline TriangleMesh together(TriangleMesh a, const TriangleMesh& b) {
  const auto shift = static_cast<std::uint32_t>(a.vertices_mm.size());
  a.vertices_mm.insert(a.vertices_mm.end(), b.vertices_mm.begin(), b.vertices_mm.end());
  for (const auto& t : b.triangles)
    a.triangles.push_back({t[0] + shift, t[1] + shift, t[2] + shift});
  return a;
}

inline std::string write_obj(const fs::path& path, const TriangleMesh& m) {
  std::ofstream out(path);
  out.precision(12);
  for (const Vec3 v : m.vertices_mm) out << "v " << v.x << ' ' << v.y << ' ' << v.z << '\n';
  for (const auto& t : m.triangles)
    out << "f " << t[0] + 1 << ' ' << t[1] + 1 << ' ' << t[2] + 1 << '\n';
  return path.string();
}

inline std::string write_ascii_stl(const fs::path& path, const TriangleMesh& m) {
  std::ofstream out(path);
  out.precision(12);
  out << "solid test\n";
  for (const auto& t : m.triangles) {
    out << "facet normal 0 0 0\nouter loop\n";
    for (const auto v : t)
      out << "vertex " << m.vertices_mm[v].x << ' ' << m.vertices_mm[v].y << ' '
          << m.vertices_mm[v].z << '\n';
    out << "endloop\nendfacet\n";
  }
  out << "endsolid test\n";
  return path.string();
}

/// Voxels of a made-up volume.
struct Voxels {
  int nx, ny, nz;
  double spacing_mm;
  std::vector<std::uint8_t> gray;
  [[nodiscard]] std::size_t index(int x, int y, int z) const {
    return (static_cast<std::size_t>(z) * static_cast<std::size_t>(ny) +
            static_cast<std::size_t>(y)) *
               static_cast<std::size_t>(nx) +
           static_cast<std::size_t>(x);
  }
};

inline void write_bytes(const fs::path& path, const std::vector<std::uint8_t>& bytes) {
  std::ofstream out(path, std::ios::binary);
  out.write(reinterpret_cast<const char*>(bytes.data()),
            static_cast<std::streamsize>(bytes.size()));
}

inline std::string write_mhd(const fs::path& folder, const Voxels& v, const std::string& spacing) {
  write_bytes(folder / "v.raw", v.gray);
  std::ofstream(folder / "v.mhd")
      << "ObjectType = Image\nNDims = 3\nBinaryData = True\nBinaryDataByteOrderMSB = False\nElementSpacing = "
      << spacing << "\nDimSize = " << v.nx << ' ' << v.ny << ' ' << v.nz
      << "\nElementType = MET_UCHAR\nElementDataFile = v.raw\n";
  return (folder / "v.mhd").string();
}

/// NRRD with the data inside and a direction matrix, as 3D Slicer writes it (here: x and y
/// mirrored).
inline std::string write_nrrd(const fs::path& path, const Voxels& v) {
  std::ofstream out(path, std::ios::binary);
  const double s = v.spacing_mm;
  out << "NRRD0004\ntype: unsigned char\ndimension: 3\nspace: left-posterior-superior\nsizes: "
      << v.nx << ' ' << v.ny << ' ' << v.nz << "\nspace directions: (" << -s << ",0,0) (0," << -s
      << ",0) (0,0," << s
      << ")\nkinds: domain domain domain\nencoding: raw\nspace origin: (10,20,30)\n\n";
  out.write(reinterpret_cast<const char*>(v.gray.data()),
            static_cast<std::streamsize>(v.gray.size()));
  return path.string();
}

/// NIfTI-1 with an sform, as ITK-SNAP writes it.
inline std::string write_nifti(const fs::path& path, const Voxels& v) {
  std::vector<std::uint8_t> b(352, 0);
  const auto put = [&](std::size_t at, auto value) {
    std::memcpy(b.data() + at, &value, sizeof value);
  };
  put(0, std::int32_t{348});
  const std::int16_t dim[8] = {3,
                               static_cast<std::int16_t>(v.nx),
                               static_cast<std::int16_t>(v.ny),
                               static_cast<std::int16_t>(v.nz),
                               1,
                               1,
                               1,
                               1};
  std::memcpy(b.data() + 40, dim, sizeof dim);
  put(70, std::int16_t{2});  // unsigned char
  put(72, std::int16_t{8});
  const auto s = static_cast<float>(v.spacing_mm);
  const float pixdim[8] = {1, s, s, s, 0, 0, 0, 0};
  std::memcpy(b.data() + 76, pixdim, sizeof pixdim);
  put(108, 352.0f);
  put(112, 1.0f);
  b[123] = 2;  // mm
  put(254, std::int16_t{1});
  const float rows[12] = {s, 0, 0, 5, 0, s, 0, 6, 0, 0, s, 7};
  std::memcpy(b.data() + 280, rows, sizeof rows);
  std::memcpy(b.data() + 344, "n+1", 4);
  b.insert(b.end(), v.gray.begin(), v.gray.end());
  write_bytes(path, b);
  return path.string();
}

/// A minimal CT slice in explicit little-endian DICOM.
inline void write_dicom_slice(const fs::path& path, const Voxels& v, int z) {
  std::vector<std::uint8_t> out(128, 0);
  const auto raw = [](std::vector<std::uint8_t>& to, const void* p, std::size_t n) {
    const auto* b = static_cast<const std::uint8_t*>(p);
    to.insert(to.end(), b, b + n);
  };
  raw(out, "DICM", 4);
  const auto element = [&](std::vector<std::uint8_t>& to, std::uint16_t group, std::uint16_t tag,
                           const char* vr, std::vector<std::uint8_t> value) {
    const bool is_long = std::string(vr) == "OW" || std::string(vr) == "OB";
    if (value.size() % 2) value.push_back(std::string(vr) == "UI" || is_long ? 0 : ' ');
    raw(to, &group, 2);
    raw(to, &tag, 2);
    raw(to, vr, 2);
    if (is_long) {
      const std::uint16_t zero = 0;
      const auto n = static_cast<std::uint32_t>(value.size());
      raw(to, &zero, 2);
      raw(to, &n, 4);
    } else {
      const auto n = static_cast<std::uint16_t>(value.size());
      raw(to, &n, 2);
    }
    raw(to, value.data(), value.size());
  };
  const auto text = [](const std::string& s) {
    return std::vector<std::uint8_t>(s.begin(), s.end());
  };
  const auto us = [](int n) {
    return std::vector<std::uint8_t>{static_cast<std::uint8_t>(n & 255),
                                     static_cast<std::uint8_t>(n >> 8)};
  };
  const std::string instance = "1.2.826.0.1.3680043.9.9999.1." + std::to_string(z + 1),
                    ct = "1.2.840.10008.5.1.4.1.1.2", s = std::to_string(v.spacing_mm);
  std::vector<std::uint8_t> meta;
  element(meta, 2, 1, "OB", {0, 1});
  element(meta, 2, 2, "UI", text(ct));
  element(meta, 2, 3, "UI", text(instance));
  element(meta, 2, 0x10, "UI", text("1.2.840.10008.1.2.1"));
  element(meta, 2, 0x12, "UI", text("1.2.826.0.1.3680043.9.9999"));
  const auto length = static_cast<std::uint32_t>(meta.size());
  std::vector<std::uint8_t> four(4);
  std::memcpy(four.data(), &length, 4);
  element(out, 2, 0, "UL", four);
  raw(out, meta.data(), meta.size());
  element(out, 8, 0x16, "UI", text(ct));
  element(out, 8, 0x18, "UI", text(instance));
  element(out, 8, 0x60, "CS", text("CT"));
  element(out, 0x20, 0xd, "UI", text("1.2.826.0.1.3680043.9.9999.2"));
  element(out, 0x20, 0xe, "UI", text("1.2.826.0.1.3680043.9.9999.3"));
  element(out, 0x20, 0x13, "IS", text(std::to_string(z + 1)));
  element(out, 0x20, 0x32, "DS", text("0\\0\\" + std::to_string(z * v.spacing_mm)));
  element(out, 0x20, 0x37, "DS", text("1\\0\\0\\0\\1\\0"));
  element(out, 0x28, 2, "US", us(1));
  element(out, 0x28, 4, "CS", text("MONOCHROME2"));
  element(out, 0x28, 0x10, "US", us(v.ny));
  element(out, 0x28, 0x11, "US", us(v.nx));
  element(out, 0x28, 0x30, "DS", text(s + "\\" + s));
  element(out, 0x28, 0x100, "US", us(8));
  element(out, 0x28, 0x101, "US", us(8));
  element(out, 0x28, 0x102, "US", us(7));
  element(out, 0x28, 0x103, "US", us(0));
  const auto slice = [&v](int at) {
    return v.gray.begin() + static_cast<std::ptrdiff_t>(v.index(0, 0, at));
  };
  element(out, 0x7fe0, 0x10, "OW", {slice(z), slice(z + 1)});
  write_bytes(path, out);
}

}  // namespace cavum::testing_import
