// A Merkle tree over the ledger's entries, as RFC 6962 section 2 defines it (SHA-256, leaves and
// nodes hashed apart): one hash stands for all entries in their order, a few hashes prove that one
// entry is among them, and a few prove that an earlier state is the beginning of a later one.
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "engine/base/hash.h"

namespace cavum::records {

/// SHA-256(0x00 || entry).
[[nodiscard]] Sha256 leaf_hash(std::span<const std::uint8_t> entry);
/// SHA-256(0x01 || left || right).
[[nodiscard]] Sha256 node_hash(const Sha256& left, const Sha256& right);

/// Root over leaf hashes, MTH(D[n]); of none SHA-256 of nothing.
[[nodiscard]] Sha256 merkle_root(std::span<const Sha256> leaves);

/// The same root of leaves that are added one after the other, for the price of one tree: complete
/// subtrees from the left, joined from the right.
class GrowingRoot {
 public:
  void add(const Sha256& leaf);
  [[nodiscard]] Sha256 root() const;
  [[nodiscard]] std::uint64_t size() const noexcept { return size_; }

 private:
  std::vector<Sha256> complete_;
  std::uint64_t size_ = 0;
};

/// Audit path of leaf `index` among `leaves`, PATH(m, D[n]), lowest first. `index` < leaves.size().
[[nodiscard]] std::vector<Sha256> inclusion_proof(std::span<const Sha256> leaves,
                                                  std::size_t index);
/// True when `proof` leads from leaf `index` of `size` to `root`.
[[nodiscard]] bool is_included(const Sha256& leaf, std::uint64_t index, std::uint64_t size,
                               std::span<const Sha256> proof, const Sha256& root);

/// Proof that the first `old_size` leaves are a beginning of all, PROOF(m, D[n]). 0 < `old_size` <=
/// leaves.size().
[[nodiscard]] std::vector<Sha256> consistency_proof(std::span<const Sha256> leaves,
                                                    std::size_t old_size);
/// True when `proof` shows that the tree of `new_size` leaves with `new_root` begins with that of
/// `old_size` and `old_root`.
[[nodiscard]] bool is_consistent(std::uint64_t old_size, const Sha256& old_root,
                                 std::uint64_t new_size, const Sha256& new_root,
                                 std::span<const Sha256> proof);

}  // namespace cavum::records
