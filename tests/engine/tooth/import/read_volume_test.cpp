// The process that reads volumes: what damaged files do to it, and what it does to us.
#include "engine/tooth/import/read_volume.h"

#include <gtest/gtest.h>
#include <sys/stat.h>
#include <unistd.h>

#include <array>
#include <chrono>
#include <cstdlib>
#include <thread>

#include "engine/base/encoding.h"
#include "engine/base/file_error.h"
#include "engine/base/random.h"
#include "engine/tooth/volume/volume_limits.h"
#include "engine/tooth/volume/volume_wire.h"
#include "tests/engine/tooth/import/import_testing.h"

namespace cavum {
namespace {

using namespace testing_import;

/// Test programs do not lie beside cavum.
class Program : public ::testing::Environment {
 public:
  void SetUp() override { ::setenv("CAVUM_READ_VOLUME", CAVUM_READ_VOLUME_PROGRAM, 1); }
};
[[maybe_unused]] const auto* const k_program = testing::AddGlobalTestEnvironment(new Program);

constexpr int k_edge = 12;

Voxels ramp(int edge = k_edge) {
  Voxels v{edge, edge, edge, 0.2, {}};
  v.gray.resize(static_cast<std::size_t>(edge) * static_cast<std::size_t>(edge) *
                static_cast<std::size_t>(edge));
  for (std::size_t i = 0; i < v.gray.size(); ++i)
    v.gray[i] = static_cast<std::uint8_t>(i * 7 % 251);
  return v;
}

std::string slice_name(int z) { return "s" + std::to_string(z) + ".dcm"; }

fs::path series(const Voxels& v) {
  auto folder = fresh_folder();
  for (int z = 0; z < v.nz; ++z) write_dicom_slice(folder / slice_name(z), v, z);
  return folder;
}

std::optional<Error> refused(const fs::path& path) {
  return thrown_by([&] { (void)read_volume(path.string(), {}); });
}

void expect_ramp(const Volume& v) {
  const Voxels was = ramp();
  ASSERT_EQ(v.gray.size(), was.gray.size());
  for (std::size_t i = 0; i < was.gray.size(); ++i)
    ASSERT_EQ(v.gray[i], static_cast<float>(was.gray[i])) << i;
  for (const double s : v.spacing_mm) EXPECT_NEAR(s, 0.2, 1e-6);
}

TEST(ReadVolume, EveryFormatGivesItsVoxelsThroughTheOtherProcess) {
  expect_ramp(read_volume(series(ramp()).string(), {}));
  const auto folder = fresh_folder();
  expect_ramp(read_volume(write_mhd(folder, ramp(), "0.2 0.2 0.2"), {}));
  expect_ramp(read_volume(write_nrrd(folder / "l.nrrd", ramp()), {}));
  expect_ramp(read_volume(write_nifti(folder / "l.nii", ramp()), {}));
}

TEST(ReadVolume, APackedNiftiBesideOneThatIsNotIsRefusedForItkWouldReadTheOther) {
  const auto folder = fresh_folder();
  write_file((folder / "v.nii.gz").string(), Bytes(100));
  write_file((folder / "v.nii").string(), Bytes(100));
  EXPECT_TRUE(tells(refused(folder / "v.nii.gz"), (folder / "v.nii").string()));
}

TEST(ReadVolume, ASliceThatWasCutIsRefusedAndNamedWhereverTheCutIs) {
  const auto folder = series(ramp());
  for (const int z : {0, 5, k_edge - 1}) {
    const fs::path slice = folder / slice_name(z);
    const Bytes whole = read_file(slice.string());
    ASSERT_GT(whole.size(), 500u);
    for (const std::size_t kept :
         {std::size_t{0}, std::size_t{100}, std::size_t{131}, std::size_t{140}, std::size_t{200},
          std::size_t{420}, whole.size() - 145, whole.size() - 144, whole.size() - 70,
          whole.size() - 2, whole.size() - 1}) {
      write_bytes(slice, {whole.begin(), whole.begin() + static_cast<std::ptrdiff_t>(kept)});
      EXPECT_EQ(place_of(refused(folder)), slice.string()) << kept << " of " << whole.size();
    }
    write_bytes(slice, whole);
  }
  expect_ramp(read_volume(folder.string(), {}));
}

TEST(ReadVolume, DamagedHeadersAreErrorsOrVolumesButNeverOurEnd) {
  const auto folder = series(ramp());
  Random random(
      testing_basics::drawn_seed("ReadVolume.DamagedHeadersAreErrorsOrVolumesButNeverOurEnd"));
  const fs::path slice = folder / slice_name(4);
  const Bytes whole = read_file(slice.string());
  int refusals = 0;
  for (int i = 0; i < 40; ++i) {
    Bytes damaged = whole;
    for (int n = 0; n < 4; ++n)
      damaged[132 + random.below(whole.size() - 144 - 132)] =
          static_cast<std::uint8_t>(random.below(256));
    write_bytes(slice, damaged);
    const auto began = std::chrono::steady_clock::now();
    refusals += refused(folder) ? 1 : 0;
    EXPECT_LT(std::chrono::steady_clock::now() - began, std::chrono::seconds(20));
  }
  EXPECT_GT(refusals, 10);
  write_bytes(slice, whole);
}

TEST(ReadVolume, SlicesOfOneSeriesSayInTheSameWayHowTheyAreRead) {
  const auto folder = series(ramp());
  Bytes slice = read_file((folder / slice_name(3)).string());
  const std::array<std::uint8_t, 8> stored{0x28, 0,   1, 1,
                                           'U',  'S', 2, 0};  // (0028,0101), bits stored
  const auto at = std::search(slice.begin(), slice.end(), stored.begin(), stored.end());
  ASSERT_NE(at, slice.end());
  at[8] = 7;
  write_bytes(folder / slice_name(3), slice);
  EXPECT_EQ(code_of(refused(folder)), FileError::inconsistent);
  EXPECT_EQ(place_of(refused(folder)), (folder / "s3.dcm").string());
}

TEST(ReadVolume, SizesThatAreClaimedAreRefusedBeforeTheyAreTaken) {
  const auto folder = fresh_folder();
  std::ofstream(folder / "a.nrrd")
      << "NRRD0004\ntype: float\nendian: little\ndimension: 3\nsizes: 1300 1000 1000\nencoding: gzip\n\nnothing";
  const auto claimed = refused(folder / "a.nrrd");
  EXPECT_EQ(code_of(claimed), FileError::too_large);
  EXPECT_TRUE(tells(claimed, 16777216));
  std::ofstream(folder / "a.mha")
      << "ObjectType = Image\nNDims = 3\nBinaryData = True\nCompressedData = True\nDimSize = 900000 900000 9\n"
         "ElementType = MET_UCHAR\nElementDataFile = LOCAL\n0";
  EXPECT_TRUE(refused(folder / "a.mha"));
  // slices of 1.7 kB that claim 65,535 x 65,535 each
  const auto slices = series(ramp());
  for (int z = 0; z < k_edge; ++z) {
    Bytes slice = read_file((slices / slice_name(z)).string());
    for (const std::uint8_t element : {std::uint8_t{0x10}, std::uint8_t{0x11}}) {
      const std::array<std::uint8_t, 8> field{0x28, 0, element, 0, 'U', 'S', 2, 0};
      const auto at = std::search(slice.begin(), slice.end(), field.begin(), field.end());
      ASSERT_NE(at, slice.end());
      at[8] = at[9] = 255;
    }
    write_bytes(slices / slice_name(z), slice);
  }
  EXPECT_EQ(code_of(refused(slices)), FileError::truncated);
  EXPECT_TRUE(tells(refused(slices), Value(std::int64_t{4294836225})));
}

/// Packed by gzip: 4096 bytes, of which byte i is i % 7. Made by Python: gzip.compress(bytes(i % 7
/// for i in range(4096)), mtime=0).
constexpr const char* k_packed =
    "1f8b0800000000000203edc5c1110030040030b4ec3fb23d5cf24964bddf139224499224e96e0b77d3c17400100000";

std::string packed_meta(std::size_t size) {
  return "ObjectType = Image\nNDims = 3\nBinaryData = True\nCompressedData = True\n" +
         (size == 0 ? std::string() : "CompressedDataSize = " + std::to_string(size) + "\n") +
         "DimSize = 16 16 16\nElementSpacing = 0.2 0.2 0.2\nElementType = MET_UCHAR\nElementDataFile = LOCAL\n";
}

// MetaIO unpacks the header when the size is missing, and gives whatever that makes for a volume.
TEST(ReadVolume, AMetaImageThatMisstatesItsPackedBytesIsRefused) {
  const auto folder = fresh_folder();
  const Bytes packed = from_hex(k_packed).value();
  for (const std::size_t said : {std::size_t{0}, std::size_t{1}, packed.size() - 1,
                                 packed.size() + 1, std::size_t{1'000'000'000'000}}) {
    const std::string head = packed_meta(said);
    Bytes all(head.begin(), head.end());
    all.insert(all.end(), packed.begin(), packed.end());
    write_bytes(folder / "v.mha", all);
    EXPECT_EQ(code_of(refused(folder / "v.mha")), FileError::inconsistent) << said;
  }
}

TEST(ReadVolume, PackedDataThatWereCutOrDamagedAreRefused) {
  const auto folder = fresh_folder();
  const Bytes packed = from_hex(k_packed).value();
  const std::string meta = packed_meta(packed.size());
  const std::string nrrd =
      "NRRD0004\ntype: uchar\ndimension: 3\nsizes: 16 16 16\nspacings: 0.2 0.2 0.2\nencoding: gzip\n\n";
  for (const auto& format : {std::pair("v.mha", meta), std::pair("v.nrrd", nrrd)}) {
    const auto& name = format.first;
    const auto& head = format.second;
    const auto write = [&](const Bytes& data) {
      Bytes all(head.begin(), head.end());
      all.insert(all.end(), data.begin(), data.end());
      write_bytes(folder / name, all);
    };
    write(packed);
    const Volume v = read_volume((folder / name).string(), {});
    ASSERT_EQ(v.gray.size(), 4096u);
    for (std::size_t i = 0; i < v.gray.size(); ++i) ASSERT_EQ(v.gray[i], static_cast<float>(i % 7));
    for (std::size_t cut = 1; cut < packed.size(); cut += 3) {
      write({packed.begin(), packed.end() - static_cast<std::ptrdiff_t>(cut)});
      EXPECT_EQ(place_of(refused(folder / name)), (folder / name).string()) << cut;
    }
    Bytes damaged = packed;
    damaged[damaged.size() - 6] ^= 1;  // of the checksum
    write(damaged);
    EXPECT_EQ(code_of(refused(folder / name)), FileError::damaged);
  }
}

/// Pages of 8 x 8 gray pixels, each with its pixels before its fields.
Bytes tiff(int pages) {
  ByteWriter out;
  for (const char c : {'I', 'I', '*', '\0'}) out.put(c);
  const auto page_at = [](int page) {
    return static_cast<std::uint32_t>(8 + page * (64 + 2 + 9 * 12 + 4) + 64);
  };
  out.put(page_at(0));
  for (int page = 0; page < pages; ++page) {
    for (int i = 0; i < 64; ++i) out.put(static_cast<std::uint8_t>(i * 3 + page));
    out.put(std::uint16_t{9});
    const auto field = [&out](int tag, int type, std::uint32_t value) {
      out.put(static_cast<std::uint16_t>(tag));
      out.put(static_cast<std::uint16_t>(type));
      out.put(std::uint32_t{1});
      out.put(value);
    };
    field(256, 3, 8), field(257, 3, 8), field(258, 3, 8), field(259, 3, 1), field(262, 3, 1),
        field(273, 4, page_at(page) - 64);
    field(277, 3, 1), field(278, 3, 8), field(279, 4, 64);
    out.put(page + 1 < pages ? page_at(page + 1) : 0);
  }
  return out.take();
}

TEST(ReadVolume, ATiffWhosePagesBreakOffIsRefused) {
  const auto folder = fresh_folder();
  const Bytes whole = tiff(6);
  write_bytes(folder / "v.tif", whole);
  EXPECT_EQ(read_volume((folder / "v.tif").string(), {}).size, (IVec3{8, 8, 6}));
  for (std::size_t cut = 1; cut < whole.size(); cut += 37) {
    write_bytes(folder / "v.tif", {whole.begin(), whole.end() - static_cast<std::ptrdiff_t>(cut)});
    EXPECT_EQ(code_of(refused(folder / "v.tif")), FileError::truncated) << cut;
  }
  Bytes endless = whole;
  std::copy_n(whole.begin() + 4, 4, endless.end() - 4);  // the last page is followed by the first
  write_bytes(folder / "v.tif", endless);
  EXPECT_EQ(code_of(refused(folder / "v.tif")), FileError::damaged);
}

TEST(ReadVolume, OnlyOrdinaryFilesAreOpened) {
  const auto folder = series(ramp());
  ASSERT_EQ(::mkfifo((folder / "t.dcm").c_str(), 0600), 0);
  EXPECT_EQ(code_of(refused(folder)), FileError::not_a_file);
  EXPECT_EQ(place_of(refused(folder)), (folder / "t.dcm").string());
  ASSERT_EQ(::mkfifo((folder / "p.nrrd").c_str(), 0600), 0);
  EXPECT_EQ(code_of(refused(folder / "p.nrrd")), FileError::missing);
  for (const char* data : {"/dev/zero", "p.nrrd", "LIST", "s%03d.raw 1 9 1"}) {
    std::ofstream(folder / "d.mhd")
        << "ObjectType = Image\nNDims = 3\nDimSize = 8 8 8\nElementType = MET_UCHAR\nElementDataFile = "
        << data << "\n";
    std::ofstream(folder / "d.nhdr")
        << "NRRD0004\ntype: uchar\ndimension: 3\nsizes: 8 8 8\nencoding: raw\ndata file: " << data
        << "\n";
    for (const char* header : {"d.mhd", "d.nhdr"}) EXPECT_TRUE(refused(folder / header)) << data;
  }
}

/// What is told of a program that is run instead of ours.
std::optional<Error> told_by(const std::string& script) {
  const auto folder = fresh_folder();
  const std::string program = (folder / "program").string(),
                    volume = write_nrrd(folder / "l.nrrd", ramp());
  std::ofstream(program) << "#!/bin/sh\n" << script << "\n";
  fs::permissions(program, fs::perms::owner_all);
  ::setenv("CAVUM_READ_VOLUME", program.c_str(), 1);
  auto error = refused(volume);
  ::setenv("CAVUM_READ_VOLUME", CAVUM_READ_VOLUME_PROGRAM, 1);
  return error;
}

TEST(ReadVolume, TheOtherProcessMayEndInAnyWay) {
  EXPECT_TRUE(tells(told_by("kill -ABRT $$"), ::strsignal(SIGABRT)));
  EXPECT_TRUE(tells(told_by("kill -SEGV $$"), ::strsignal(SIGSEGV)));
  EXPECT_TRUE(told_by("ulimit -t 1; while :; do :; done"));
  EXPECT_TRUE(tells(told_by("exit 3"), 3));
  EXPECT_TRUE(tells(told_by("printf 'CVVOLUME\\001\\000\\000\\000\\004' >&3"), 0));
  EXPECT_EQ(code_of(told_by("echo some other words than ours >&3")), FileError::malformed);
  const auto told = told_by(
      "printf "
      "'CVVOLUME\\000\\000\\000\\000\\017\\000\\000\\000{\"say\":\"where\"}\\013\\000\\000\\000{\"say\":\"a\"}\\015\\000\\000\\000{"
      "\"say\":\"do!\"}' >&3");
  ASSERT_TRUE(told);
  EXPECT_STREQ(told->where().english(), "where");
  EXPECT_STREQ(told->problem().english(), "a");
  EXPECT_STREQ(told->advice().english(), "do!");
  ::setenv("CAVUM_READ_VOLUME", "/nowhere/cavum-read-volume", 1);
  EXPECT_EQ(place_of(refused(write_nrrd(fresh_folder() / "l.nrrd", ramp()))),
            "/nowhere/cavum-read-volume");
  ::setenv("CAVUM_READ_VOLUME", CAVUM_READ_VOLUME_PROGRAM, 1);
}

/// What receive_volume makes of these bytes.
std::optional<Error> received(const Bytes& bytes, std::uint64_t most = 1000,
                              bool close_after = true) {
  std::array<int, 2> ends{};
  EXPECT_EQ(::pipe(ends.data()), 0);
  std::thread sender([&] {
    static_cast<void>(!::write(ends[1], bytes.data(), bytes.size()));
    if (close_after) ::close(ends[1]);
  });
  auto error = thrown_by([&] { (void)receive_volume(ends[0], "v", most, 1); });
  sender.join();
  if (!close_after) ::close(ends[1]);
  ::close(ends[0]);
  return error;
}

Bytes sent(IVec3 size, std::size_t voxels) {
  ByteWriter out;
  for (const char c : std::string("CVVOLUME")) out.put(c);
  out.put(std::uint32_t{1});
  for (const auto n : {size.x, size.y, size.z}) out.put(n);
  for (int i = 0; i < 15; ++i) out.put(1.0);
  for (std::size_t i = 0; i < voxels; ++i) out.put(1.0F);
  return out.take();
}

TEST(VolumeWire, WhatIsNotAWholeVolumeIsAnError) {
  EXPECT_FALSE(received(sent({10, 10, 10}, 1000)));
  EXPECT_EQ(code_of(received(sent({10, 10, 10}, 999))), FileError::truncated);
  EXPECT_EQ(code_of(received(sent({10, 10, 10}, 1001))), FileError::malformed);
  const auto larger = received(sent({10, 10, 11}, 1100));
  EXPECT_TRUE(tells(larger, 1100) && tells(larger, 1000));
  EXPECT_EQ(code_of(received(sent({65536, 65536, 65536}, 0), ~0ULL >> 20)), FileError::too_large);
  for (const IVec3 size : {IVec3{0, 10, 10}, IVec3{-1, -1, 10}, IVec3{1 << 30, 1, 1}})
    EXPECT_EQ(code_of(received(sent(size, 0))), FileError::malformed);
  EXPECT_EQ(code_of(received({})), FileError::truncated);
  EXPECT_EQ(code_of(received(Bytes(100, 'x'))), FileError::malformed);
  EXPECT_TRUE(tells(received(sent({10, 10, 10}, 500), 1000, false), 1)) << "the limit in seconds";
  for (std::size_t n = 0; n < 150; ++n) {
    const Bytes whole = sent({1, 1, 1}, 1);
    EXPECT_EQ(!received({whole.begin(),
                         whole.begin() + static_cast<std::ptrdiff_t>(std::min(n, whole.size()))}),
              n >= whole.size())
        << n;
  }
}

TEST(VolumeWire, LimitsFollowTheBytesOfTheFiles) {
  EXPECT_EQ(most_voxels(0), 16'777'216u);
  EXPECT_EQ(most_voxels(10'000'000), 40'000'000u);
  EXPECT_EQ(most_voxels(~std::uint64_t{0} / 4), 536'870'912u);
  EXPECT_LT(most_read_memory(10'000'000), 1'000'000'000u) << "an input below 10 MB";
  EXPECT_LE(most_read_seconds(10'000'000), 5u);
}

}  // namespace
}  // namespace cavum
