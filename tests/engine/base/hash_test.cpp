#include "engine/base/hash.h"

#include <gtest/gtest.h>

#include <string>

namespace cavum {
namespace {

TEST(Hash, Sha256MatchesThePublishedVectors) {  // FIPS 180-4 examples
  EXPECT_EQ(to_hex(sha256(std::string("abc"))),
            "ba7816bf8f01cfea414140de5dae2223b00361a396177a9cb410ff61f20015ad");
  EXPECT_EQ(to_hex(sha256(std::string())),
            "e3b0c44298fc1c149afbf4c8996fb92427ae41e4649b934ca495991b7852b855");
  EXPECT_EQ(to_hex(sha256(std::string("abcdbcdecdefdefgefghfghighijhijkijkljklmklmnlmnomnopnopq"))),
            "248d6a61d20638b8e5c026930c3e6039a33ce45964ff2167f6ecedd419db06c1");
}

TEST(Hash, FastHashSeesEveryBitAndTheSeed) {
  std::uint8_t data[64] = {};
  const auto plain = fast_hash(data, sizeof data, 1);
  EXPECT_EQ(plain, fast_hash(data, sizeof data, 1));
  EXPECT_NE(plain, fast_hash(data, sizeof data, 2));
  for (std::size_t bit = 0; bit < 512; ++bit) {
    data[bit / 8] = static_cast<std::uint8_t>(1u << bit % 8);
    EXPECT_NE(plain, fast_hash(data, sizeof data, 1)) << bit;
    data[bit / 8] = 0;
  }
}

}  // namespace
}  // namespace cavum
