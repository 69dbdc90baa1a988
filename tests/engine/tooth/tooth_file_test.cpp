#include <gtest/gtest.h>

#include <cstring>
#include <functional>
#include <nlohmann/json.hpp>

#include "engine/base/error.h"
#include "engine/base/file.h"
#include "engine/base/hash.h"
#include "engine/tooth/make/make_block.h"
#include "tests/engine/tooth/tooth_testing.h"

namespace cavum {
namespace {

using testing_tooth::layered_block;

using namespace testing_basics;

TEST(ToothFile, SavesTheSameBytesAfterLoading) {
  const Tooth tooth = layered_block();
  const Bytes once = save_tooth(tooth);
  const Tooth again = load_tooth(once, "memory");
  EXPECT_EQ(save_tooth(again), once);
  EXPECT_EQ(tooth_hash(again), tooth_hash(tooth));
  EXPECT_EQ(again.name, tooth.name);
  EXPECT_EQ(again.tissues, tooth.tissues);
  EXPECT_EQ(again.octree.to_grid().distance, tooth.octree.to_grid().distance);
}

Bytes cube_with_a_landmark() {
  Tooth tooth = make_cube(0.5, "dentin", 0.1);
  tooth.placed_landmarks = {{"apex_1", {0.1, 0.2, 1.0}}};
  return save_tooth(tooth);
}

template <std::size_t... i>
ToothSource one_of_each(std::index_sequence<i...>) {
  return {ToothEntry(std::in_place_index<i>)...};
}

TEST(ToothFile, WhichToothItIsAndWhatItWasMadeFromAreKept) {
  Tooth tooth = make_cube(0.5, "dentin", 0.1);
  tooth.kind = ToothKind(from_fdi(36, "x"));
  tooth.source = one_of_each(std::make_index_sequence<std::variant_size_v<ToothEntry>>());
  tooth.source.push_back(MadeByFormula{ToothDesign::premolar, UINT64_MAX, 0.05, 1.0});
  tooth.source.push_back(ImportedVolume{
      "ct.mhd", GrayReading{.dentin_from = 900.5, .peaks = GrayPeaks{1, 2, 3, 4}}, {}, 0.1, {}, 0});
  const Tooth again = load_tooth(save_tooth(tooth), "t.cvt");
  EXPECT_EQ(again.kind, tooth.kind);
  ASSERT_EQ(again.source.size(), tooth.source.size());
  for (std::size_t i = 0; i < tooth.source.size(); ++i)
    EXPECT_EQ(encode(again.source[i]), encode(tooth.source[i])) << i;
  tooth.kind.jaw = Jaw::upper;
  EXPECT_THROW(static_cast<void>(load_tooth(save_tooth(tooth), "t.cvt")), Error)
      << "36 is a lower tooth";
}

TEST(ToothFile, EveryTruncationIsAnError) {
  const Bytes bytes = cube_with_a_landmark();
  for (std::size_t n = 0; n < bytes.size(); ++n)
    ASSERT_THROW((void)load_tooth(std::span(bytes).first(n), "short"), Error) << n << " bytes";
}

TEST(ToothFile, NamesThatCannotBeShownAreMadeReadableOrRefused) {
  Tooth tooth = make_cube(0.5, "enamel", 0.1);
  tooth.name = "z\xe4hne\n";
  EXPECT_EQ(load_tooth(save_tooth(tooth), "t.cvt").name, "z?hne ");
  tooth.tissues[0].name = "ena\xffmel";
  EXPECT_TRUE(tells(thrown_by([&] { (void)load_tooth(save_tooth(tooth), "t.cvt"); }), 1))
      << "the tissue";
}

TEST(ToothFile, EveryFlippedBitIsAnError) {
  Bytes bytes = cube_with_a_landmark();
  for (std::size_t bit = 0; bit < 8 * bytes.size(); ++bit) {
    bytes[bit / 8] ^= static_cast<std::uint8_t>(1u << bit % 8);
    ASSERT_THROW((void)load_tooth(bytes, "flipped"), Error) << "bit " << bit;
    bytes[bit / 8] ^= static_cast<std::uint8_t>(1u << bit % 8);
  }
}

std::optional<Error> refusal_of(const Bytes& file) {
  return thrown_by([&] { static_cast<void>(load_tooth(file, "t.cvt")); });
}

/// An octree as Octree::write would have written it.
std::optional<Error> refusal_of_octree(double leaf_mm, int edge, const Bytes& shape,
                                       std::size_t bricks) {
  ByteWriter octree;
  octree.put(leaf_mm);
  for (int i = 0; i < 3; ++i) octree.put(0.0);
  for (int i = 0; i < 3; ++i) octree.put(static_cast<std::int32_t>(edge));
  for (const Bytes& part : {shape, Bytes(bricks * 64), Bytes()}) {
    octree.put(static_cast<std::uint64_t>(part.size()));
    octree.put_bytes(part);
  }
  ByteReader in(octree.bytes(), "tooth");
  return thrown_by([&] { (void)Octree::read(in, {}); });
}

TEST(ToothFile, LeavesAndBoxesOfNoToothAreRefusedWithTheLimitNamed) {
  constexpr int k_max_leaves = Octree::k_max_edge_leaves;
  const Bytes uniform{0, 0};  // one uniform cube of air
  EXPECT_FALSE(refusal_of_octree(0.05, 512, uniform, 0));
  for (const double leaf : {0.001, 10.0, -1.0})
    EXPECT_TRUE(tells(refusal_of_octree(leaf, 8, uniform, 0), k_max_leaves)) << leaf;
  EXPECT_TRUE(tells(refusal_of_octree(0.1, 1024, uniform, 0), k_max_leaves));
}

TEST(ToothFile, PlacedLandmarksAreKeptAndCountInTheHash) {
  Tooth tooth = layered_block();
  const Bytes plain = save_tooth(tooth);
  const std::string hash = tooth_hash(tooth);
  tooth.placed_landmarks = {{"central_pit", {0.1, 0.2, 1.0}}, {"cusp_1", {-1, 2, 3}}};
  const Bytes placed = save_tooth(tooth);
  const Tooth again = load_tooth(placed, "t.cvt");
  EXPECT_EQ(again.placed_landmarks, tooth.placed_landmarks);
  EXPECT_EQ(save_tooth(again), placed);
  EXPECT_NE(tooth_hash(tooth), hash);
  EXPECT_EQ(tooth_hash(again), tooth_hash(tooth));
  tooth.placed_landmarks[0].at_mm.z = 1.5;
  EXPECT_NE(tooth_hash(tooth), tooth_hash(again));
  tooth.placed_landmarks.clear();
  EXPECT_EQ(save_tooth(tooth), plain);
  EXPECT_EQ(tooth_hash(tooth), hash);
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
    std::memcpy(file.data() + file.size() - 4 - (4 + 1 + 24) - 4, &count,
                4);  // no notes, one landmark
    const Sha256 sum = sha256(file);
    file.insert(file.end(), sum.begin(), sum.end());
    return file;
  };
  EXPECT_EQ(with_count(1), sound);
  for (const std::uint32_t count : {0U, 0xffffffffU, 2U})
    EXPECT_TRUE(refusal_of(with_count(count))) << count;
}

TEST(ToothFile, ShippedMolarKeepsItsBytes) {
  const std::string path = testing_basics::data_path("teeth/lower_molar.cvt");
  const Tooth tooth = load_tooth_file(path);
  EXPECT_EQ(save_tooth(tooth), read_file(path));
  EXPECT_EQ(tooth_hash(tooth), "7fbc33df485f92a811e7dc1f713e70ae2f0fefcadd71d52e5198264d276fb000");
}

}  // namespace
}  // namespace cavum
