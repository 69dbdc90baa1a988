#include <gtest/gtest.h>
#include <zstd.h>

#include <functional>

#include "engine/base/error.h"
#include "engine/base/file.h"
#include "engine/base/hash.h"
#include "engine/tooth/make/make_block.h"
#include "tests/engine/tooth/tooth_testing.h"

namespace cavum {
namespace {

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
  EXPECT_NE(testing_basics::error_of([&] { (void)load_tooth(save_tooth(tooth), "t.cvt"); }).find("name of tissue 1"), std::string::npos);
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

std::string refusal_of(const Bytes& file) {
  try {
    static_cast<void>(load_tooth(file, "t.cvt"));
  } catch (const Error& e) {
    return e.what();
  }
  return "";
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
  const Bytes uniform{0, 0};  // one uniform cube of air
  EXPECT_EQ(refusal_of(version_1_of(0.05, 512, uniform, 0)), "");
  for (const double leaf : {0.001, 10.0, -1.0})
    EXPECT_NE(refusal_of(version_1_of(leaf, 8, uniform, 0)).find("leaves have 0.005 to 2 mm"), std::string::npos) << leaf;
  EXPECT_NE(refusal_of(version_1_of(0.1, 1024, uniform, 0)).find("at most 60 mm"), std::string::npos);
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
  EXPECT_EQ(refusal_of(version_1_of(0.05, 256, shape, bricks)), "") << "2^18 are the most";
  node(6);  // and the root of a larger one
  Bytes larger{1};
  larger.insert(larger.end(), shape.begin(), shape.end());
  for (int i = 0; i < 6; ++i) larger.push_back(0), larger.push_back(0);
  EXPECT_NE(refusal_of(version_1_of(0.05, 512, larger, 2 * bricks)).find("more bricks than the limit of 262144"), std::string::npos);
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

TEST(ToothFile, ShippedMolarIsTheOneOfVersion1) {
  const std::string path = testing_basics::data_path("teeth/lower_molar.cvt");
  const Tooth tooth = load_tooth_file(path);
  EXPECT_EQ(save_tooth(tooth), read_file(path));
  EXPECT_EQ(tooth_hash(tooth), "17765dd9dd3ffd0b703ae3a193c0833a95329aa3c1121c0e2856ff723e78546a");
}

}  // namespace
}  // namespace cavum
