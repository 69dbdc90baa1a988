// Measured data against the simulation: what it gets wrong, why, and what fixing it gains. How:
// docs/explain.md.
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>
#include <vector>

#include "engine/base/lines.h"
#include "engine/lab/explain/inference/search.h"
#include "engine/lab/explain/recording/faults.h"

namespace cavum::explain {

struct Interval {
  double value = 0, low = 0, high = 0;  ///< 95 %
};

/// Another mechanism in the place of a cause, refitted beside the others.
struct RivalFit {
  std::string mechanism;
  double behind_chi2 =
      0;  ///< how much worse it fits, each parameter counted; negative where it fits better
};

struct Cause {
  Term term;
  std::vector<std::string> aliases;  ///< other mechanisms that fit these data as well
  std::vector<RivalFit> rivals;      ///< best first; those that were worth a refit
  std::vector<std::pair<std::string, Interval>> parameters;
  double p_value = 1;
  double effect_n = 0;    ///< root mean square of its force
  Series force_n;         ///< what it adds, [rows]
  Interval gain_percent;  ///< of the error on sessions not seen, by it alone beside the others
  std::vector<double> by_fold_percent;  ///< the same of each session (or stretch) left out
  double probability = 0;               ///< that it is a true cause, 0 to 1
  double set_probability = 0;           ///< that it or one of its aliases is
};

struct Unexplained {
  std::string variable;
  Message form;
  double effect_n = 0;
};

struct NotTestable {
  std::string mechanism;
  Message reason;
};

struct Gain {
  double base_rmse_n = 0, extended_rmse_n = 0;  ///< on sessions that the fit had not seen
  double noise_floor_n = 0;
  Interval percent;                     ///< 100 (1 − extended/base)
  double share_percent = 0;             ///< of what lies between base and noise floor
  std::vector<double> by_fold_percent;  ///< of each session (or stretch) left out
};

enum class Verdict : std::uint8_t { clean, named, alias, unexplained, not_testable, data_fault };
/// As JSON has it.
[[nodiscard]] const char* verdict_name(Verdict verdict) noexcept;
[[nodiscard]] Message word_of(Verdict verdict);

struct Explanation {
  Verdict verdict = Verdict::clean;
  std::vector<Cause> causes;
  std::optional<Unexplained> unexplained;
  std::vector<NotTestable> not_testable;
  std::vector<DataFault> data_faults;
  Facts notes;
  Gain gain;
  Base base;  ///< fitted with the causes
  Interval k, c;
  Noise noise;
  double position_error_n =
      0;  ///< rms of the force that the errors of position and speed may make by k and c, N
  SessionSpread spread{};  ///< what sessions differ by, beside the causes
  Fact next_experiment;
  std::vector<Structure> structures;           ///< of the residual that is left
  std::vector<Candidate> candidates;           ///< of the first look, for the report
  std::shared_ptr<const Recording> recording;  ///< as it was explained; the views refer to it
  std::optional<View> before, after;  ///< base alone, and with the causes; none for data faults
};

struct ExplainOptions {
  std::uint64_t seed = 1;
  std::size_t surrogates =
      199;  ///< for each step of the search; 0 = a plain rule instead of the null, for comparison
  int max_causes = 5;
  const Series* fixed_n = nullptr;       ///< forces of a loaded model, [rows]
  std::function<void(double)> progress;  ///< 0..1
};

/// What is to be done first.
[[nodiscard]] Fact correct_recording(const std::vector<DataFault>& faults);

[[nodiscard]] Explanation explain(const Recording& recording, const ExplainOptions& options = {});

/// The names of docs/contracts.md (JSON).
[[nodiscard]] nlohmann::json to_json(const Explanation& explanation);
[[nodiscard]] Lines to_text(const Explanation& explanation);
// The parts of it, which a page shows beside its pictures.
[[nodiscard]] Message in_words(const Explanation& explanation);
[[nodiscard]] Message unexplained_words(const Unexplained& unexplained);
[[nodiscard]] Message heading_of(const Cause& cause);
[[nodiscard]] Lines to_text(const Cause& cause);
[[nodiscard]] Lines gain_words(const Explanation& explanation);
/// What is left out together, one after the other: the name of a session, of the first and the last
/// of several, or "part 1".
[[nodiscard]] std::vector<Message> fold_names(const Explanation& explanation);
/// A sentence about what is left when the recording is clean and the simulation still misses by
/// half as much again as the noise: errors of the position may make as much. Else empty.
[[nodiscard]] Message left_over_words(const Explanation& explanation);

}  // namespace cavum::explain
