// A computer's disk in memory, which forgets on a power cut what nobody synced: bytes since the
// last fsync of their file are then there in part, by sectors, drawn at random; names since the
// last fsync of their folder up to a drawn one. Renaming and making a name are each one step.
#pragma once

#include <array>
#include <cstdint>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "engine/base/random.h"

namespace cavum::simulation {

struct Node;
using NodePtr = std::shared_ptr<Node>;

/// A range of bytes that one process has locked (POSIX locks are a process's, not a descriptor's).
struct ByteLock {
  int process = 0;
  bool exclusive = false;
  std::int64_t first = 0, last = 0;  ///< both in it
};

/// A file or folder. What a process sees is `bytes` and `names`; what a power cut leaves is
/// `synced…` and some of `unsynced…`.
struct Node {
  std::uint64_t number = 0;
  std::uint32_t mode = 0;  ///< S_IFDIR or S_IFREG, and permissions
  [[nodiscard]] bool is_folder() const;

  std::string bytes, synced_bytes;
  struct Write {
    std::int64_t at = 0;  ///< -1: the file was cut or lengthened to `size`
    std::string what;
    std::int64_t size = 0;
  };
  std::vector<Write> unsynced_writes;
  std::unique_ptr<std::array<char, 1 << 19>>
      shared;  ///< once it is mapped into memory: its bytes lie here, at one address
  std::size_t shared_size = 0;
  std::int64_t promised = 0;  ///< bytes up to here have room, were the disk full

  std::map<std::string, NodePtr> names, synced_names;
  std::vector<std::map<std::string, NodePtr>>
      unsynced_names;  ///< the folder after each change since its last sync

  std::vector<ByteLock> locks;
  int whole_lock_holder = 0;  ///< descriptor with flock(LOCK_EX); 0: nobody

  [[nodiscard]] std::int64_t size() const;
  [[nodiscard]] std::string read(std::int64_t at, std::int64_t n) const;
  void write(std::int64_t at, const std::string& what);
  void resize(std::int64_t size);
  void sync();
  void names_changed() { unsynced_names.push_back(names); }
};

class Disk {
 public:
  Disk();
  /// The same files, synced or not, apart from this one's.
  [[nodiscard]] Disk copy() const;
  [[nodiscard]] NodePtr root() const { return root_; }
  /// Null when there is none. `path` begins at the disk's root.
  [[nodiscard]] NodePtr find(const std::string& path) const;
  [[nodiscard]] NodePtr make(std::uint32_t mode);
  /// Everything as a power cut leaves it.
  void lose_power(Random& random);
  /// Everything that is there is synced.
  void settle();

 private:
  NodePtr root_;
  std::uint64_t last_number_ =
      1'000'000'000'000;  // no number of a real file, which /proc/locks would name
};

}  // namespace cavum::simulation
