// The explanation as JSON and as words.
#include <fmt/core.h>

#include <algorithm>
#include <cmath>

#include "engine/base/print.h"
#include "engine/explain/inference/explain.h"
#include "engine/explain/inference/probability.h"

namespace cavum::explain {
namespace {

using nlohmann::json;

const Mechanism& mechanism_of(const Cause& c) { return mechanism_at(c.term.mechanism); }

json to_json(const Interval& i) { return {{"value", i.value}, {"low", i.low}, {"high", i.high}}; }

json own_gain(const Explanation& e, const Cause& c) {
  json out = to_json(c.gain_percent);
  out["by_session"] = json::array();
  const std::vector<std::string> names = fold_names(e);
  for (std::size_t f = 0; f < names.size() && f < c.by_fold_percent.size(); ++f)
    out["by_session"].push_back({{"session", names[f]}, {"percent", c.by_fold_percent[f]}});
  return out;
}

std::string in_words(const Explanation& e) {
  if (e.verdict == "clean") return "nothing that these data can show is missing from the simulation";
  if (e.verdict == "not_testable") return "these data cannot show anything either way: every mechanism that matters can hide behind k and c";
  if (e.verdict == "data_fault") return "the recording cannot be trusted, so nothing was explained";
  if (e.verdict == "unexplained") return "the force depends on something that no mechanism here describes";
  const std::string more = e.unexplained ? fmt::format(", and that is not all: something about {} stays unexplained", e.unexplained->variable) : "";
  if (e.verdict == "alias") return "something is missing, but these data cannot tell which of several mechanisms it is" + more;
  return "the simulation lacks what is named below" + more;
}

}  // namespace

json to_json(const Explanation& e) {
  json j;
  j["verdict"] = e.verdict;
  j["causes"] = json::array();
  for (const auto& c : e.causes) {
    json parameters = json::object();
    for (const auto& [name, interval] : c.parameters) parameters[name] = to_json(interval);
    json rivals = json::array();
    for (const auto& r : c.rivals) rivals.push_back({{"mechanism", r.mechanism}, {"behind_chi2", r.behind_chi2}});
    j["causes"].push_back({{"mechanism", mechanism_of(c).name},
                           {"aliases", c.aliases},
                           {"parameters", parameters},
                           {"p_value", c.p_value},
                           {"effect_n", c.effect_n},
                           {"probability", c.probability},
                           {"set_probability", c.set_probability},
                           {"gain", own_gain(e, c)},
                           {"rivals", rivals}});
  }
  j["unexplained"] = nullptr;
  if (e.unexplained) j["unexplained"] = {{"variable", e.unexplained->variable}, {"effect_n", e.unexplained->effect_n}, {"form", e.unexplained->form}};
  j["not_testable"] = json::array();
  for (const auto& n : e.not_testable) j["not_testable"].push_back(n.mechanism);
  j["data_faults"] = e.data_faults;
  j["base"] = {{"heldout_rmse_n", e.gain.base_rmse_n}, {"k_n_per_mm", e.base.k_n_per_mm}, {"c_n_s_per_mm", e.base.c_n_s_per_mm}};
  j["extended"] = {{"heldout_rmse_n", e.gain.extended_rmse_n}};
  j["noise_floor_n"] = e.gain.noise_floor_n;
  j["gain"] = {{"percent", e.gain.percent.value},
               {"low", e.gain.percent.low},
               {"high", e.gain.percent.high},
               {"share_of_explainable_percent", e.gain.share_percent}};
  j["next_experiment"] = e.next_experiment;
  j["notes"] = e.notes;
  return j;
}

std::vector<std::string> fold_names(const Explanation& e) {
  std::vector<std::string> out;
  if (!e.before) return out;
  const auto& sessions = e.recording->sessions;
  for (const auto& [begin, end] : e.before->folds) {
    if (sessions.size() == 1) {
      out.push_back(fmt::format("part {}", out.size() + 1));
      continue;
    }
    const auto at = [&](Eigen::Index row) {
      return std::find_if(sessions.begin(), sessions.end(), [&](const auto& s) { return row < s.end; })->name;
    };
    const std::string first = at(begin), last = at(end - 1);
    out.push_back(first == last ? first : fmt::format("{} to {}", first, last));
  }
  return out;
}

std::string left_over_words(const Explanation& e) {
  constexpr double k_more_than_noise = 1.5;
  if (e.verdict != "clean" || e.gain.base_rmse_n < k_more_than_noise * e.gain.noise_floor_n) return "";
  return printed(
      "The simulation misses by %.4f N rms where the noise of the force is %.4f N: as much as the errors of the position may make (%.4f N).",
      e.gain.base_rmse_n, e.gain.noise_floor_n, e.position_error_n);
}

std::string to_text(const Explanation& e) {
  std::string out = fmt::format("verdict: {}. {}.\n", e.verdict, in_words(e));
  for (const auto& f : e.data_faults) out += wrapped("fault: " + f);
  if (e.verdict == "data_fault") return out;
  for (const auto& c : e.causes) {
    const Mechanism& m = mechanism_of(c);
    out += printed("\ncause: %s (%s), %.4f N rms, p = %.2g\n", m.name, m.words, c.effect_n, c.p_value);
    out += printed("  force %s\n", m.equation);
    out += printed("  %s: %.0f %%", probability_words(c.probability), 100.0 * c.probability);
    if (!c.aliases.empty()) out += printed("; that it is this or one that fits as well: %.0f %%", 100.0 * c.set_probability);
    out += "\n";
    out += printed("  alone it lowers the error on sessions not seen by %.1f %% (%.1f to %.1f)\n", c.gain_percent.value, c.gain_percent.low,
                   c.gain_percent.high);
    for (const auto& [name, i] : c.parameters) out += printed("  %-20s %12.5g   95 %%: %.5g to %.5g\n", name.c_str(), i.value, i.low, i.high);
    if (!c.aliases.empty()) {
      out += "  fits as well:";
      for (const auto& a : c.aliases) out += " " + a;
      out += "\n";
    }
  }
  if (e.unexplained)
    out += wrapped(printed("unexplained: the force depends on %s (%s), %.4f N rms.", e.unexplained->variable.c_str(), e.unexplained->form.c_str(),
                           e.unexplained->effect_n));
  if (const std::string left = left_over_words(e); !left.empty()) out += wrapped(left);
  out += printed("\nk = %.5g N/mm (%.5g to %.5g), c = %.5g N s/mm (%.5g to %.5g)\n", e.base.k_n_per_mm, e.k.low, e.k.high, e.base.c_n_s_per_mm,
                 e.c.low, e.c.high);
  out += printed("on sessions not seen: base %.4f N, extended %.4f N rms; noise floor %.4f N\n", e.gain.base_rmse_n, e.gain.extended_rmse_n,
                 e.gain.noise_floor_n);
  out += printed("gain %.1f %% (%.1f to %.1f), %.0f %% of what could be explained\n", e.gain.percent.value, e.gain.percent.low, e.gain.percent.high,
                 e.gain.share_percent);
  if (!e.not_testable.empty()) {
    std::string list = "not testable with these data:";
    for (const auto& n : e.not_testable) list += " " + n.mechanism;
    out += wrapped(list);
  }
  out += wrapped("next experiment: " + e.next_experiment);
  for (const auto& n : e.notes) out += wrapped("note: " + n);
  return out;
}

}  // namespace cavum::explain
