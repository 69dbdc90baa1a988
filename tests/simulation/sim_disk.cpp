#include "tests/simulation/sim_disk.h"

#include <sys/stat.h>

#include <algorithm>
#include <cstring>
#include <functional>
#include <sstream>
#include <stdexcept>

namespace cavum::simulation {
namespace {

constexpr std::int64_t k_sector = 512;

void put(std::string& bytes, std::int64_t at, const char* from, std::int64_t n) {
  if (static_cast<std::int64_t>(bytes.size()) < at + n)
    bytes.resize(static_cast<std::size_t>(at + n));
  bytes.replace(static_cast<std::size_t>(at), static_cast<std::size_t>(n), from,
                static_cast<std::size_t>(n));
}

void apply(std::string& bytes, const Node::Write& w) {
  if (w.at < 0)
    bytes.resize(static_cast<std::size_t>(w.size));
  else
    put(bytes, w.at, w.what.data(), static_cast<std::int64_t>(w.what.size()));
}

/// Each write whole, not at all, or by sectors.
void apply_in_part(std::string& bytes, const Node::Write& w, Random& random) {
  const auto how = random.below(3);
  if (how == 0) return;
  if (how == 1 || w.at < 0) return apply(bytes, w);
  const auto n = static_cast<std::int64_t>(w.what.size());
  for (std::int64_t done = 0; done < n;) {
    const std::int64_t piece = std::min(n - done, k_sector - (w.at + done) % k_sector);
    if (random.below(2) == 0) put(bytes, w.at + done, w.what.data() + done, piece);
    done += piece;
  }
}

}  // namespace

bool Node::is_folder() const { return S_ISDIR(mode); }

std::int64_t Node::size() const {
  return static_cast<std::int64_t>(shared ? shared_size : bytes.size());
}

std::string Node::read(std::int64_t at, std::int64_t n) const {
  const std::int64_t there = std::clamp<std::int64_t>(size() - at, 0, n);
  return there == 0 ? std::string()
                    : std::string((shared ? shared->data() : bytes.data()) + at,
                                  static_cast<std::size_t>(there));
}

void Node::write(std::int64_t at, const std::string& what) {
  if (shared) {
    if (static_cast<std::size_t>(at) + what.size() > shared->size())
      throw std::length_error("a mapped file grew beyond the simulation's memory");
    std::memcpy(shared->data() + at, what.data(), what.size());
    shared_size = std::max(shared_size, static_cast<std::size_t>(at) + what.size());
    return;
  }
  put(bytes, at, what.data(), static_cast<std::int64_t>(what.size()));
  unsynced_writes.push_back({at, what, 0});
}

void Node::resize(std::int64_t size) {
  if (shared) {
    if (static_cast<std::size_t>(size) > shared->size())
      throw std::length_error("a mapped file grew beyond the simulation's memory");
    if (static_cast<std::size_t>(size) < shared_size)
      std::memset(shared->data() + size, 0, shared_size - static_cast<std::size_t>(size));
    shared_size = static_cast<std::size_t>(size);
    return;
  }
  bytes.resize(static_cast<std::size_t>(size));
  unsynced_writes.push_back({-1, "", size});
}

void Node::sync() {
  for (const Write& w : unsynced_writes) apply(synced_bytes, w);
  unsynced_writes.clear();
  synced_names = names;
  unsynced_names.clear();
}

Disk::Disk() : root_(make(S_IFDIR | 0700)) {}

Disk Disk::copy() const {
  std::map<const Node*, NodePtr> known;
  const std::function<NodePtr(const NodePtr&)> again = [&](const NodePtr& from) {
    NodePtr& to = known[from.get()];
    if (to) return to;
    to = std::make_shared<Node>();
    NodePtr made = to;  // `to` may move
    made->number = from->number;
    made->mode = from->mode;
    made->bytes = from->read(0, from->size());
    made->synced_bytes = from->synced_bytes;
    made->unsynced_writes = from->unsynced_writes;
    for (const auto& [name, node] : from->names) made->names[name] = again(node);
    for (const auto& [name, node] : from->synced_names) made->synced_names[name] = again(node);
    for (const auto& step : from->unsynced_names) {
      made->unsynced_names.emplace_back();
      for (const auto& [name, node] : step) made->unsynced_names.back()[name] = again(node);
    }
    return made;
  };
  Disk out;
  out.root_ = again(root_);
  out.last_number_ = last_number_;
  return out;
}

NodePtr Disk::find(const std::string& path) const {
  NodePtr at = root_;
  std::istringstream parts(path);
  for (std::string part; std::getline(parts, part, '/');) {
    if (part.empty() || part == ".") continue;
    if (!at->is_folder()) return nullptr;
    const auto next = at->names.find(part);
    if (next == at->names.end()) return nullptr;
    at = next->second;
  }
  return at;
}

NodePtr Disk::make(std::uint32_t mode) {
  auto node = std::make_shared<Node>();
  node->number = ++last_number_;
  node->mode = mode;
  return node;
}

void Disk::lose_power(Random& random) {
  const std::function<void(Node&)> lose = [&](Node& n) {
    if (n.shared) {
      n.shared.reset();
      n.shared_size = 0;
    }
    for (const auto& w : n.unsynced_writes) apply_in_part(n.synced_bytes, w, random);
    n.unsynced_writes.clear();
    n.bytes = n.synced_bytes;
    if (const auto kept = random.below(n.unsynced_names.size() + 1); kept > 0)
      n.synced_names = n.unsynced_names[kept - 1];
    n.unsynced_names.clear();
    n.names = n.synced_names;
    n.locks.clear();
    n.whole_lock_holder = 0;
    for (const auto& [name, child] : n.names) lose(*child);
  };
  lose(*root_);
}

void Disk::settle() {
  const std::function<void(Node&)> settle_node = [&](Node& n) {
    n.unsynced_writes.clear();
    n.synced_bytes = n.bytes;
    n.sync();
    for (const auto& [name, child] : n.names) settle_node(*child);
  };
  settle_node(*root_);
}

}  // namespace cavum::simulation
