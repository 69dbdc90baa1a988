// Writes one blind recording: a CSV and its rig.toml as docs/contracts.md has them, and, for the
// test only, what was hidden in it.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "tests/blind/effect.h"

namespace cavum::blind {

enum class Kind { single, pair, clean, outside, crosshead, fault };
[[nodiscard]] const char* kind_name(Kind kind);

/// What to hide. The same request writes the same bytes.
struct Request {
  Kind kind = Kind::clean;
  std::vector<std::string> names;  ///< mechanisms, outsider or fault
  double size = 0.0;               ///< of each effect beyond k and c, over the noise
  double quantum_mm = 0.0;         ///< of position
  std::uint64_t seed = 0;
};

/// What was hidden.
struct Hidden {
  Request request;
  double noise_n = 0.0;   ///< root mean square of the noise
  double effect_n = 0.0;  ///< root mean square beyond k and c of all that was hidden
  bool has_v = false, heavy_tails = false;
  bool reached = true;   ///< false: no amount of the effect gives the size on such a motion; the
                         ///< largest was taken
  std::string variable;  ///< outside: the right answers, separated by `|`
  std::vector<std::vector<Parameter>> truth;  ///< one list per name
};

/// `time_base metres clipped shuffled repeated`.
[[nodiscard]] const std::vector<std::string>& faults();

/// Two mechanisms that can be found at all, and not of one family: two lags in a row, or two
/// curvatures of k X, are one effect to any observer.
[[nodiscard]] std::vector<std::string> draw_pair(Draw& draw);

/// Writes `folder`/recording.csv and `folder`/rig.toml. \throws std::runtime_error where that is
/// impossible.
Hidden write_recording(const Request& request, const std::filesystem::path& folder);

}  // namespace cavum::blind
