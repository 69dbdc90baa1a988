#include <gtest/gtest.h>
#include <zstd.h>

#include <cstring>
#include <functional>

#include "engine/base/error.h"
#include "engine/base/file.h"
#include "engine/base/hash.h"
#include "engine/tooth/make/make_block.h"
#include "tests/engine/tooth/tooth_testing.h"

namespace cavum {
namespace {

using namespace testing_basics;

Tooth small_block() { return make_block({2.13, 1.9, 2.4}, {{"enamel", 0.7}, {"dentin", 0.8}, {"pulp", 0.5}, {"lesion", 0.4}}, 0.1); }

TEST(ToothFile, SavesTheSameBytesAfterLoading) {
  const Tooth tooth = small_block();
  const Bytes once = save_tooth(tooth);
  const Tooth again = load_tooth(once, "memory");
  EXPECT_EQ(save_tooth(again), once);
  EXPECT_EQ(tooth_hash(again), tooth_hash(tooth));
  EXPECT_EQ(again.name, tooth.name);
  EXPECT_EQ(again.tissues, tooth.tissues);
  EXPECT_EQ(again.octree.to_grid().distance, tooth.octree.to_grid().distance);
}

TEST(ToothFile, EveryTruncationIsAnError) {
  const Bytes bytes = save_tooth(make_cube(0.5, "dentin", 0.1));
  for (std::size_t n = 0; n < bytes.size(); ++n) ASSERT_THROW((void)load_tooth(std::span(bytes).first(n), "short"), Error) << n << " bytes";
}

TEST(ToothFile, NamesThatCannotBeShownAreMadeReadableOrRefused) {
  Tooth tooth = make_cube(0.5, "enamel", 0.1);
  tooth.name = "z\xe4hne\n";
  EXPECT_EQ(load_tooth(save_tooth(tooth), "t.cvt").name, "z?hne ");
  tooth.tissues[0].name = "ena\xffmel";
  EXPECT_TRUE(tells(thrown_by([&] { (void)load_tooth(save_tooth(tooth), "t.cvt"); }), 1)) << "the tissue";
}

TEST(ToothFile, EveryFlippedBitIsAnError) {
  Bytes bytes = save_tooth(make_cube(0.5, "dentin", 0.1));
  for (std::size_t bit = 0; bit < 8 * bytes.size(); ++bit) {
    bytes[bit / 8] ^= static_cast<std::uint8_t>(1u << bit % 8);
    ASSERT_THROW((void)load_tooth(bytes, "flipped"), Error) << "bit " << bit;
    bytes[bit / 8] ^= static_cast<std::uint8_t>(1u << bit % 8);
  }
}

/// What programs before version 2 wrote, by the layout in tooth_file.cpp.
Bytes saved_as_version_1(const Tooth& tooth) {
  ByteWriter body;
  body.put_string(tooth.name);
  body.put_string(tooth.source);
  body.put(static_cast<std::uint8_t>(tooth.tissues.size()));
  for (const auto& t : tooth.tissues) {
    body.put(t.id);
    body.put(static_cast<std::uint8_t>(t.solid));
    body.put_string(t.name);
  }
  tooth.octree.write(body);
  Bytes packed(ZSTD_compressBound(body.bytes().size()));
  packed.resize(ZSTD_compress(packed.data(), packed.size(), body.bytes().data(), body.bytes().size(), 3));
  ByteWriter out;
  for (const char c : {'C', 'V', 'T', 'O', 'O', 'T', 'H', '1'}) out.put(c);
  out.put(static_cast<std::uint64_t>(body.bytes().size()));
  out.put(static_cast<std::uint64_t>(packed.size()));
  out.put_bytes(packed);
  out.put_bytes(sha256(out.bytes()));
  return out.take();
}

std::optional<Error> refusal_of(const Bytes& file) {
  return thrown_by([&] { static_cast<void>(load_tooth(file, "t.cvt")); });
}

/// A tooth of version 1 that nobody made: `octree` as Octree::write would have written it.
Bytes version_1_of(double leaf_mm, int edge, const Bytes& shape, std::size_t bricks) {
  ByteWriter body;
  body.put_string("made up");
  body.put_string("");
  body.put(std::uint8_t{0});
  body.put(leaf_mm);
  for (int i = 0; i < 3; ++i) body.put(0.0);
  for (int i = 0; i < 3; ++i) body.put(static_cast<std::int32_t>(edge));
  for (const Bytes& part : {shape, Bytes(bricks * 64), Bytes()}) {
    body.put(static_cast<std::uint64_t>(part.size()));
    body.put_bytes(part);
  }
  Bytes packed(ZSTD_compressBound(body.bytes().size()));
  packed.resize(ZSTD_compress(packed.data(), packed.size(), body.bytes().data(), body.bytes().size(), 1));
  ByteWriter out;
  for (const char c : {'C', 'V', 'T', 'O', 'O', 'T', 'H', '1'}) out.put(c);
  out.put(static_cast<std::uint64_t>(body.bytes().size()));
  out.put(static_cast<std::uint64_t>(packed.size()));
  out.put_bytes(packed);
  out.put_bytes(sha256(out.bytes()));
  return out.take();
}

TEST(ToothFile, LeavesAndBoxesOfNoToothAreRefusedWithTheLimitNamed) {
  constexpr int k_most_leaves = Octree::k_max_edge_leaves;
  const Bytes uniform{0, 0};  // one uniform cube of air
  EXPECT_FALSE(refusal_of(version_1_of(0.05, 512, uniform, 0)));
  for (const double leaf : {0.001, 10.0, -1.0}) EXPECT_TRUE(tells(refusal_of(version_1_of(leaf, 8, uniform, 0)), k_most_leaves)) << leaf;
  EXPECT_TRUE(tells(refusal_of(version_1_of(0.1, 1024, uniform, 0)), k_most_leaves));
}

TEST(ToothFile, Version1HasNoMoreBricksThanVersion2) {
  // a full tree of six levels over bricks of label: 64³ of them, one more than may be
  Bytes shape;
  const std::function<void(int)> node = [&](int level) {
    shape.push_back(level > 0 ? 1 : 2);
    for (int i = 0; level > 0 && i < 8; ++i) node(level - 1);
  };
  node(6);
  const std::size_t bricks = 64UL * 64 * 64;
  EXPECT_FALSE(refusal_of(version_1_of(0.05, 256, shape, bricks))) << "2^18 are the most";
  node(6);  // and the root of a larger one
  Bytes larger{1};
  larger.insert(larger.end(), shape.begin(), shape.end());
  for (int i = 0; i < 6; ++i) larger.push_back(0), larger.push_back(0);
  EXPECT_TRUE(tells(refusal_of(version_1_of(0.05, 512, larger, 2 * bricks)), 262144));
}

TEST(ToothFile, ReadsVersion1) {
  const Tooth tooth = small_block();
  const Tooth again = load_tooth(saved_as_version_1(tooth), "old.cvt");
  EXPECT_EQ(save_tooth(again), save_tooth(tooth));
}

TEST(ToothFile, DamagedFilesOfVersion1AreErrors) {
  Bytes bytes = saved_as_version_1(make_cube(0.5, "dentin", 0.1));
  for (std::size_t n = 0; n < bytes.size(); ++n) ASSERT_THROW((void)load_tooth(std::span(bytes).first(n), "short"), Error) << n << " bytes";
  for (std::size_t bit = 0; bit < 8 * bytes.size(); ++bit) {
    bytes[bit / 8] ^= static_cast<std::uint8_t>(1u << bit % 8);
    ASSERT_THROW((void)load_tooth(bytes, "flipped"), Error) << "bit " << bit;
    bytes[bit / 8] ^= static_cast<std::uint8_t>(1u << bit % 8);
  }
}

TEST(ToothFile, PlacedLandmarksMakeItVersion3AndCountInTheHash) {
  Tooth tooth = small_block();
  const Bytes plain = save_tooth(tooth);
  const std::string hash = tooth_hash(tooth);
  tooth.placed_landmarks = {{"central_pit", {0.1, 0.2, 1.0}}, {"cusp_1", {-1, 2, 3}}};
  const Bytes placed = save_tooth(tooth);
  EXPECT_EQ(plain[7], '2');
  EXPECT_EQ(placed[7], '3');
  const Tooth again = load_tooth(placed, "t.cvt");
  EXPECT_EQ(again.placed_landmarks, tooth.placed_landmarks);
  EXPECT_EQ(save_tooth(again), placed);
  EXPECT_NE(tooth_hash(tooth), hash);
  EXPECT_EQ(tooth_hash(again), tooth_hash(tooth));
  tooth.placed_landmarks[0].at_mm.z = 1.5;
  EXPECT_NE(tooth_hash(tooth), tooth_hash(again));
  tooth.placed_landmarks.clear();
  EXPECT_EQ(save_tooth(tooth), plain) << "old teeth keep their bytes";
  EXPECT_EQ(tooth_hash(tooth), hash);
}

TEST(ToothFile, DamagedFilesOfVersion3AreErrors) {
  Tooth tooth = make_cube(0.5, "dentin", 0.1);
  tooth.placed_landmarks = {{"apex_1", {0.1, 0.2, 1.0}}};
  Bytes bytes = save_tooth(tooth);
  for (std::size_t n = 0; n < bytes.size(); ++n) ASSERT_THROW((void)load_tooth(std::span(bytes).first(n), "short"), Error) << n << " bytes";
  for (std::size_t bit = 0; bit < 8 * bytes.size(); ++bit) {
    bytes[bit / 8] ^= static_cast<std::uint8_t>(1u << bit % 8);
    ASSERT_THROW((void)load_tooth(bytes, "flipped"), Error) << "bit " << bit;
    bytes[bit / 8] ^= static_cast<std::uint8_t>(1u << bit % 8);
  }
}

TEST(ToothFile, LandmarksOfNoToothAreRefusedWhenTheyAreWrittenAndWhenTheyAreRead) {
  Tooth tooth = make_cube(0.5, "dentin", 0.1);
  const auto refused = [&](std::vector<NamedPoint> placed) {
    tooth.placed_landmarks = std::move(placed);
    return thrown_by([&] { (void)save_tooth(tooth); });
  };
  std::vector<NamedPoint> many;
  for (int i = 0; i < 65; ++i) many.push_back({"p" + std::to_string(i), {0, 0, 0}});
  EXPECT_TRUE(tells(refused(many), 64));
  EXPECT_TRUE(tells(refused({{std::string(33, 'a'), {}}}), 32));
  EXPECT_TRUE(tells(refused({{"", {}}}), 1));
  EXPECT_TRUE(tells(refused({{"a", {}}, {"a", {}}}), 2));
  EXPECT_TRUE(tells(refused({{"a", {0, 0, 1e300}}}), 1));
  // the same by hand: 0 and 65 landmarks behind the octree, and a sound checksum
  tooth.placed_landmarks = {{"a", {1, 2, 3}}};
  const Bytes sound = save_tooth(tooth);
  const auto with_count = [&](std::uint32_t count) {
    Bytes file = sound;
    file.resize(file.size() - sizeof(Sha256));
    std::memcpy(file.data() + file.size() - 4 - (4 + 1 + 24) - 4, &count, 4);  // no notes, one landmark
    const Sha256 sum = sha256(file);
    file.insert(file.end(), sum.begin(), sum.end());
    return file;
  };
  EXPECT_EQ(with_count(1), sound);
  for (const std::uint32_t count : {0U, 0xffffffffU, 2U}) EXPECT_TRUE(refusal_of(with_count(count))) << count;
}

TEST(ToothFile, ShippedMolarKeepsItsBytes) {
  const std::string path = testing_basics::data_path("teeth/lower_molar.cvt");
  const Tooth tooth = load_tooth_file(path);
  EXPECT_EQ(save_tooth(tooth), read_file(path));
  EXPECT_EQ(tooth_hash(tooth), "7fbc33df485f92a811e7dc1f713e70ae2f0fefcadd71d52e5198264d276fb000");
}

}  // namespace
}  // namespace cavum
