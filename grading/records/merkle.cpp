#include "grading/records/merkle.h"

#include <algorithm>
#include <bit>
#include <stdexcept>

#include "engine/base/bytes.h"

namespace cavum::records {
namespace {

/// Largest power of two below n, n > 1.
std::size_t split_of(std::size_t n) { return std::bit_floor(n - 1); }

/// SUBPROOF(m, D[n], whole) of RFC 6962 section 2.1.2.
void subproof(std::span<const Sha256> leaves, std::size_t m, bool whole, std::vector<Sha256>& out) {
  if (m == leaves.size()) {
    if (!whole) out.push_back(merkle_root(leaves));
    return;
  }
  const std::size_t k = split_of(leaves.size());
  if (m <= k) {
    subproof(leaves.first(k), m, whole, out);
    out.push_back(merkle_root(leaves.subspan(k)));
  } else {
    subproof(leaves.subspan(k), m - k, false, out);
    out.push_back(merkle_root(leaves.first(k)));
  }
}

}  // namespace

Sha256 leaf_hash(std::span<const std::uint8_t> entry) {
  Bytes b{0x00};
  b.insert(b.end(), entry.begin(), entry.end());
  return sha256(b);
}

Sha256 node_hash(const Sha256& left, const Sha256& right) {
  Bytes b{0x01};
  b.insert(b.end(), left.begin(), left.end());
  b.insert(b.end(), right.begin(), right.end());
  return sha256(b);
}

Sha256 merkle_root(std::span<const Sha256> leaves) {
  if (leaves.empty()) return sha256(std::span<const std::uint8_t>());
  if (leaves.size() == 1) return leaves[0];
  const std::size_t k = split_of(leaves.size());
  return node_hash(merkle_root(leaves.first(k)), merkle_root(leaves.subspan(k)));
}

void GrowingRoot::add(const Sha256& leaf) {
  complete_.push_back(leaf);
  for (std::uint64_t n = ++size_; (n & 1) == 0; n >>= 1) {
    const Sha256 right = complete_.back();
    complete_.pop_back();
    complete_.back() = node_hash(complete_.back(), right);
  }
}

Sha256 GrowingRoot::root() const {
  if (complete_.empty()) return merkle_root({});
  Sha256 root = complete_.back();
  for (std::size_t i = complete_.size() - 1; i-- > 0;) root = node_hash(complete_[i], root);
  return root;
}

std::vector<Sha256> inclusion_proof(std::span<const Sha256> leaves, std::size_t index) {
  if (index >= leaves.size()) throw std::out_of_range("inclusion_proof: no such leaf");
  std::vector<Sha256> path;
  while (leaves.size() > 1) {
    const std::size_t k = split_of(leaves.size());
    path.push_back(merkle_root(index < k ? leaves.subspan(k) : leaves.first(k)));
    leaves = index < k ? leaves.first(k) : leaves.subspan(k);
    if (index >= k) index -= k;
  }
  std::reverse(path.begin(), path.end());
  return path;
}

bool is_included(const Sha256& leaf, std::uint64_t index, std::uint64_t size,
                 std::span<const Sha256> proof, const Sha256& root) {
  if (index >= size) return false;
  std::uint64_t node = index, last = size - 1;
  Sha256 hash = leaf;
  for (const Sha256& p : proof) {
    if (last == 0) return false;
    if ((node & 1) != 0 || node == last) {
      hash = node_hash(p, hash);
      while ((node & 1) == 0 && node != 0) node >>= 1, last >>= 1;
    } else {
      hash = node_hash(hash, p);
    }
    node >>= 1, last >>= 1;
  }
  return last == 0 && hash == root;
}

std::vector<Sha256> consistency_proof(std::span<const Sha256> leaves, std::size_t old_size) {
  if (old_size == 0 || old_size > leaves.size())
    throw std::out_of_range("consistency_proof: no such earlier tree");
  std::vector<Sha256> out;
  subproof(leaves, old_size, true, out);
  return out;
}

bool is_consistent(std::uint64_t old_size, const Sha256& old_root, std::uint64_t new_size,
                   const Sha256& new_root, std::span<const Sha256> proof) {
  if (old_size == 0 || old_size > new_size) return false;
  if (old_size == new_size) return proof.empty() && old_root == new_root;
  std::uint64_t node = old_size - 1, last = new_size - 1;
  while ((node & 1) != 0) node >>= 1, last >>= 1;
  std::size_t next = 0;
  Sha256 from_old = old_root, from_new = old_root;
  if (node != 0) {  // else the old tree is a complete subtree: its root is the start itself
    if (proof.empty()) return false;
    from_old = from_new = proof[next++];
  }
  for (; next < proof.size(); ++next) {
    if (last == 0) return false;
    if ((node & 1) != 0 || node == last) {
      from_old = node_hash(proof[next], from_old);
      from_new = node_hash(proof[next], from_new);
      while ((node & 1) == 0 && node != 0) node >>= 1, last >>= 1;
    } else {
      from_new = node_hash(from_new, proof[next]);
    }
    node >>= 1, last >>= 1;
  }
  return last == 0 && from_old == old_root && from_new == new_root;
}

}  // namespace cavum::records
