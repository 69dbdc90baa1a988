// What moved the stylus in an exam: a device in a hand, or something else. The station that begins
// a recording says so in what it signs, and again whenever it takes the recording up; every chunk's
// hash covers what was said before it. Only a device can be a candidate's hand.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "engine/base/message.h"

namespace cavum {

/// Facts of `meta`.
inline constexpr char k_source_fact[] = "source", k_source_name_fact[] = "source_name",
                      k_source_serial_fact[] = "source_serial";

enum class SourceKind : std::uint8_t {
  unnamed,             ///< the recording does not say
  device,              ///< a stylus in a hand
  pointer,             ///< mouse and keyboard
  practice,            ///< any of them while nothing counts
  simulated_operator,  ///< `operator`
  motion_file,         ///< poses from a file
  program              ///< a program that uses the library and says no more
};
/// As recordings and ledgers write them.
inline constexpr std::array<const char*, 7> k_source_kinds{
    "", "device", "pointer", "practice", "operator", "motion_file", "program"};
[[nodiscard]] inline std::string text_of(SourceKind kind) {
  return k_source_kinds[static_cast<std::size_t>(kind)];
}
[[nodiscard]] std::optional<SourceKind> source_kind_of(const std::string& text);
/// For people.
[[nodiscard]] Message in_words(SourceKind kind);

struct MotionSource {
  SourceKind kind = SourceKind::program;
  std::string name = {};    ///< id of the stylus, or name of the operator, file or program
  std::string serial = {};  ///< of the device; empty when it tells none

  [[nodiscard]] bool is_hand() const { return kind == SourceKind::device; }
  friend bool operator==(const MotionSource&, const MotionSource&) = default;
};
/// "stylus falcon"
[[nodiscard]] Message in_words(const MotionSource& source);
/// Further facts by key.
using Notes = std::vector<std::pair<std::string, std::string>>;

/// What gives the input of an exam that is taken up again.
struct ResumedBy {
  std::optional<MotionSource> source;  ///< none: nothing does, it is closed as it stands
  bool ticket_remembered =
      true;  ///< false: the station has no memory of having begun the exam of its ticket
  Notes notes = {};
};

/// Where a recording was begun or taken up, and what moved the stylus from there on.
struct SourceFrom {
  std::int64_t tick = 0;
  MotionSource source;
};
class SessionReader;
/// The source that the beginning names, and that of each gap after which something was recorded; a
/// gap that names none gives one without kind.
[[nodiscard]] std::vector<SourceFrom> sources_of(const SessionReader& session);

}  // namespace cavum
