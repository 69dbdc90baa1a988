#include "engine/tooth/volume/tiff_bytes.h"

#include <fmt/core.h>

#include <vector>

#include "engine/base/error.h"
#include "engine/base/file_error.h"

namespace cavum {
namespace {

constexpr std::uint64_t k_max_pages = 20'000, k_max_pieces = 1U << 20;
constexpr std::uint64_t k_strip_offsets = 273, k_strip_bytes = 279, k_tile_offsets = 324,
                        k_tile_bytes = 325;

class Walk {
 public:
  Walk(std::span<const std::uint8_t> file, std::string where)
      : file_(file), where_(std::move(where)) {}

  void run() {
    if (file_.size() < 8) fail(FileError::truncated, msg("truncated: no TIFF is that short"));
    big_endian_ = file_[0] == 'M';
    const auto mark = number(2, 2);
    if ((file_[0] != 'I' && file_[0] != 'M') || file_[1] != file_[0] || (mark != 42 && mark != 43))
      fail(FileError::malformed, msg("is no TIFF"));
    wide_ = mark == 43;
    std::uint64_t page = wide_ ? number(8, 8) : number(4, 4);
    for (std::uint64_t pages = 0; page != 0; ++pages) {
      if (pages == k_max_pages) fail(FileError::damaged, msg("damaged: its pages have no end"));
      page = walk_page(page);
    }
  }

 private:
  [[noreturn]] void fail(FileError code, const Message& what) const {
    throw Error(code, Name{where_}, what, msg("use a complete copy"));
  }

  std::uint64_t number(std::uint64_t at, std::uint64_t bytes) const {
    if (at > file_.size() || bytes > file_.size() - at)
      fail(FileError::truncated,
           msg("truncated: it refers to byte {}, and has {}", at, file_.size()));
    std::uint64_t n = 0;
    for (std::uint64_t i = 0; i < bytes; ++i)
      n |= static_cast<std::uint64_t>(file_[at + (big_endian_ ? bytes - 1 - i : i)]) << (8 * i);
    return n;
  }

  struct Entry {
    std::uint64_t type = 0, count = 0, at = 0;
  };
  [[nodiscard]] std::vector<std::uint64_t> values(const Entry& e) const {
    const std::uint64_t bytes = e.type == 3 ? 2 : e.type == 4 ? 4 : e.type == 16 ? 8 : 0;
    if (bytes == 0 || e.count > k_max_pieces)
      fail(FileError::damaged, msg("damaged: a page has an impossible list of pieces"));
    const std::uint64_t room = wide_ ? 8 : 4,
                        from = bytes * e.count <= room ? e.at : number(e.at, room);
    std::vector<std::uint64_t> out;
    for (std::uint64_t i = 0; i < e.count; ++i) out.push_back(number(from + i * bytes, bytes));
    return out;
  }

  /// Where the next page begins, 0 behind the last.
  std::uint64_t walk_page(std::uint64_t at) const {
    const std::uint64_t head = wide_ ? 8 : 2, size = wide_ ? 20 : 12, entries = number(at, head);
    if (entries > 4096) fail(FileError::damaged, msg("damaged: a page has {} fields", entries));
    Entry offsets, counts;
    for (std::uint64_t i = 0; i < entries; ++i) {
      const std::uint64_t e = at + head + i * size, tag = number(e, 2);
      const Entry entry{number(e + 2, 2), number(e + 4, wide_ ? 8 : 4), e + (wide_ ? 12 : 8)};
      if (tag == k_strip_offsets || tag == k_tile_offsets) offsets = entry;
      if (tag == k_strip_bytes || tag == k_tile_bytes) counts = entry;
    }
    if (offsets.count == 0 || offsets.count != counts.count)
      fail(FileError::damaged, msg("damaged: a page does not say where its pixels are"));
    const auto where = values(offsets), bytes = values(counts);
    for (std::size_t i = 0; i < where.size(); ++i)
      if (where[i] > file_.size() || bytes[i] > file_.size() - where[i])
        fail(FileError::truncated,
             msg("truncated: pixels of a page end beyond its {} bytes", file_.size()));
    return number(at + head + entries * size, wide_ ? 8 : 4);
  }

  std::span<const std::uint8_t> file_;
  std::string where_;
  bool big_endian_ = false, wide_ = false;
};

}  // namespace

void check_tiff_bytes(std::span<const std::uint8_t> file, const std::string& where) {
  Walk(file, where).run();
}

}  // namespace cavum
