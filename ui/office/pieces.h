// Exams that come in pieces: a station on a poor network goes on where its line broke, instead of
// beginning again. What has come lies on disk, apart for each station; a piece is taken only at the
// place where the last one ended, and the whole is an exam only when its hash is the one that was
// named.
#pragma once

#include <cstdint>
#include <functional>
#include <map>
#include <mutex>
#include <string>
#include <string_view>
#include <utility>

namespace cavum::office {

inline constexpr std::uint64_t k_largest_piece = 1U << 20,
                               k_smallest_piece =
                                   64U << 10;  ///< bytes; the last one of an exam may be smaller
inline constexpr std::uint64_t k_largest_session = 256U << 20;
inline constexpr std::int64_t k_life_of_pieces_s = 86'400;  ///< after the last piece

struct PiecesLimits {
  std::size_t of_a_station =
      4;  ///< exams at once; a further one takes the place of the one that has waited longest
  std::uint64_t all_bytes = 8ULL << 30;  ///< of all stations together, as they are announced
};

class Pieces {
 public:
  struct Have {
    std::uint64_t have = 0, of = 0;  ///< bytes; of = 0: nothing has come
    bool taken = false;              ///< the piece was the next one
    bool whole = false;              ///< it was the last one, and the exam was handed on
  };
  /// Gets the file of an exam that is whole and has its hash; moves it away.
  using Whole = std::function<void(const std::string& path, const std::string& sha256,
                                   const std::string& station)>;
  /// Goes on with what lies in `folder`. `now_s`: seconds since 1970.
  Pieces(std::string folder, Whole whole, std::function<std::int64_t()> now_s,
         const PiecesLimits& limits = {});

  /// How much of an exam this station has sent.
  [[nodiscard]] Have have(const std::string& station, const std::string& sha256);
  /// Takes `bytes` as those from `at` on, of `of` in all. Nothing is taken when that is not where
  /// the last piece ended, or the exam was announced with another size: what there is is said.
  /// Throws Error when a size is out of its limits, or the whole has another hash: it is begun anew
  /// then.
  Have add(const std::string& station, const std::string& sha256, std::uint64_t at,
           std::uint64_t of, std::string_view bytes);

 private:
  using Key = std::pair<std::string, std::string>;  // station, hash
  struct Upload {
    std::uint64_t have = 0, of = 0;
    std::int64_t last_s = 0;
    bool checked = false;  // its hash is being made
  };
  [[nodiscard]] std::string path_of(const Key& key, std::uint64_t of) const;
  void begin(const Key& key, std::uint64_t of);
  void remove(const Key& key);
  void remove_old();
  [[nodiscard]] bool is_whole(const std::string& path, const std::string& sha256) const;

  std::string folder_;
  Whole whole_;
  std::function<std::int64_t()> now_s_;
  PiecesLimits limits_;
  std::mutex lock_;
  std::map<Key, Upload> uploads_;
};

}  // namespace cavum::office
