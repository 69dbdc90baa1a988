#include "grading/records/merkle.h"

#include <gtest/gtest.h>

#include <iostream>
#include <random>

#include "engine/base/bytes.h"
#include "engine/base/random.h"
#include "tests/engine/support/basics.h"

namespace cavum::records {
namespace {

/// The entries and roots that the Certificate Transparency project publishes as its reference.
const std::vector<Bytes> k_entries = {{},
                                      {0x00},
                                      {0x10},
                                      {0x20, 0x21},
                                      {0x30, 0x31},
                                      {0x40, 0x41, 0x42, 0x43},
                                      {0x50, 0x51, 0x52, 0x53, 0x54, 0x55, 0x56, 0x57},
                                      {0x60, 0x61, 0x62, 0x63, 0x64, 0x65, 0x66, 0x67, 0x68, 0x69,
                                       0x6a, 0x6b, 0x6c, 0x6d, 0x6e, 0x6f}};
const std::vector<std::string> k_roots = {
    "6e340b9cffb37a989ca544e6bb780a2c78901d3fb33738768511a30617afa01d",
    "fac54203e7cc696cf0dfcb42c92a1d9dbaf70ad9e621f4bd8d98662f00e3c125",
    "aeb6bcfe274b70a14fb067a5e5578264db0fa9b51af5e0ba159158f329e06e77",
    "d37ee418976dd95753c1c73862b9398fa2a2cf9b4ff0fdfe8b30cd95209614b7",
    "4e3bbb1f7b478dcfe71fb631631519a3bca12c9aefca1612bfce4c13a86264d4",
    "76e67dadbcdf1e10e1b74ddc608abd2f98dfb16fbce75277b5232a127f2087ef",
    "ddb89be403809e325750d3d263cd78929c2942b7942a34b77e122c9594a74c8c",
    "5dc9da79a70659a9ad559cb701ded9a2ab9d823aad2f4960cfe370eff4604328"};

std::vector<Sha256> drawn_leaves(std::size_t n, Random& random) {
  std::vector<Sha256> leaves(n);
  for (auto& l : leaves)
    for (auto& b : l) b = static_cast<std::uint8_t>(random.next());
  return leaves;
}

std::uint64_t new_seed() { return testing_basics::drawn_seed("Merkle"); }

TEST(Merkle, RootsAreThoseOfTheReference) {
  EXPECT_EQ(to_hex(merkle_root({})),
            "e3b0c44298fc1c149afbf4c8996fb92427ae41e4649b934ca495991b7852b855");
  GrowingRoot growing;
  EXPECT_EQ(growing.root(), merkle_root({}));
  std::vector<Sha256> leaves;
  for (std::size_t i = 0; i < k_entries.size(); ++i) {
    leaves.push_back(leaf_hash(k_entries[i]));
    EXPECT_EQ(to_hex(merkle_root(leaves)), k_roots[i]) << i + 1 << " entries";
    growing.add(leaves.back());
    EXPECT_EQ(to_hex(growing.root()), k_roots[i]) << i + 1 << " entries";
  }
}

TEST(Merkle, EveryEntryIsProvenAndNoOther) {
  Random random(new_seed());
  for (std::size_t n = 1; n <= 40; ++n) {
    const auto leaves = drawn_leaves(n, random);
    const Sha256 root = merkle_root(leaves);
    for (std::size_t i = 0; i < n; ++i) {
      auto proof = inclusion_proof(leaves, i);
      EXPECT_TRUE(is_included(leaves[i], i, n, proof, root)) << i << " of " << n;
      EXPECT_FALSE(is_included(leaves[i], (i + 1) % (n + 1), n, proof, root)) << i << " of " << n;
      const auto other = drawn_leaves(1, random)[0];
      EXPECT_FALSE(is_included(other, i, n, proof, root));
      EXPECT_FALSE(is_included(leaves[i], i, n, proof, other));
      proof.push_back(other);
      EXPECT_FALSE(is_included(leaves[i], i, n, proof, root)) << "one hash too many";
      proof.pop_back();
      if (proof.empty()) continue;
      proof[random.below(proof.size())][random.below(32)] ^= 1;
      EXPECT_FALSE(is_included(leaves[i], i, n, proof, root));
    }
  }
}

TEST(Merkle, EveryBeginningIsProvenAndNoOther) {
  Random random(new_seed());
  for (std::size_t n = 1; n <= 40; ++n) {
    const auto leaves = drawn_leaves(n, random);
    const Sha256 root = merkle_root(leaves);
    for (std::size_t m = 1; m <= n; ++m) {
      auto proof = consistency_proof(leaves, m);
      const Sha256 old_root = merkle_root(std::span(leaves).first(m));
      EXPECT_TRUE(is_consistent(m, old_root, n, root, proof)) << m << " of " << n;
      auto changed = leaves;
      changed[random.below(m)][0] ^= 1;
      EXPECT_FALSE(is_consistent(m, merkle_root(std::span(changed).first(m)), n, root, proof))
          << "another beginning, " << m << " of " << n;
      EXPECT_FALSE(is_consistent(m, old_root, n, merkle_root(changed), proof))
          << "another end, " << m << " of " << n;
      EXPECT_FALSE(is_consistent(n + 1, old_root, n, root, proof));
      proof.push_back(root);
      EXPECT_FALSE(is_consistent(m, old_root, n, root, proof)) << "one hash too many";
    }
  }
}

}  // namespace
}  // namespace cavum::records
