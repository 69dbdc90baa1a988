// The explanation as JSON and as words.
#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "engine/lab/explain/inference/explain.h"
#include "engine/lab/explain/inference/probability.h"

namespace cavum::explain {
namespace {

using nlohmann::json;

const Mechanism& mechanism_of(const Cause& c) { return mechanism_at(c.term.mechanism); }

json to_json(const Interval& i) { return {{"value", i.value}, {"low", i.low}, {"high", i.high}}; }

json own_gain(const Explanation& e, const Cause& c) {
  json out = to_json(c.gain_percent);
  out["by_session"] = json::array();
  const std::vector<Message> names = fold_names(e);
  for (std::size_t f = 0; f < names.size() && f < c.by_fold_percent.size(); ++f)
    out["by_session"].push_back({{"session", names[f]}, {"percent", c.by_fold_percent[f]}});
  return out;
}

struct VerdictWords {
  const char* name;
  Message word, sentence;
};

const VerdictWords& words_of(Verdict v) {
  static const VerdictWords k_words[] = {
      {"clean", msg("clean"),
       msg("Nothing that these data can show is missing from the simulation.")},
      {"named", msg("named"), msg("The simulation lacks what is named below.")},
      {"alias", msg("alias"),
       msg("Something is missing, but these data cannot tell which of several mechanisms it is.")},
      {"unexplained", msg("unexplained"),
       msg("The force depends on something that no mechanism here describes.")},
      {"not_testable", msg("not testable"),
       msg("These data cannot show anything either way: every mechanism that matters can hide behind k and c.")},
      {"data_fault", msg("data fault"),
       msg("The recording cannot be trusted, so nothing was explained.")}};
  return k_words[static_cast<std::size_t>(v)];
}

}  // namespace

const char* verdict_name(Verdict v) noexcept { return words_of(v).name; }
Message word_of(Verdict v) { return words_of(v).word; }

Fact correct_recording(const std::vector<DataFault>& faults) {
  const DataFault& first = faults.at(0);
  return Fact("correct_recording", {"what"}, msg("correct the recording: {}", first.what))
      .with("fault", Name{std::string(name_in(first.kind))});
}

Message in_words(const Explanation& e) {
  if (e.unexplained && e.verdict == Verdict::alias)
    return msg(
        "Something is missing, but these data cannot tell which of several mechanisms it is; and something about {} stays unexplained.",
        e.unexplained->variable);
  if (e.unexplained && e.verdict == Verdict::named)
    return msg(
        "The simulation lacks what is named below, and something about {} stays unexplained.",
        e.unexplained->variable);
  return words_of(e.verdict).sentence;
}

Message unexplained_words(const Unexplained& u) {
  return msg("unexplained: the force depends on {} ({}), {} rms.", u.variable, u.form,
             as_n(u.effect_n, 4));
}

json to_json(const Explanation& e) {
  json j;
  j["verdict"] = verdict_name(e.verdict);
  j["causes"] = json::array();
  for (const auto& c : e.causes) {
    json parameters = json::object();
    for (const auto& [name, interval] : c.parameters) parameters[name] = to_json(interval);
    json rivals = json::array();
    for (const auto& r : c.rivals)
      rivals.push_back({{"mechanism", r.mechanism}, {"behind_chi2", r.behind_chi2}});
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
  if (e.unexplained)
    j["unexplained"] = {{"variable", e.unexplained->variable},
                        {"effect_n", e.unexplained->effect_n},
                        {"form", e.unexplained->form}};
  j["not_testable"] = json::array();
  for (const auto& n : e.not_testable) j["not_testable"].push_back(n.mechanism);
  j["data_faults"] = e.data_faults;
  j["base"] = {{"heldout_rmse_n", e.gain.base_rmse_n},
               {"k_n_per_mm", e.base.k_n_per_mm},
               {"c_n_s_per_mm", e.base.c_n_s_per_mm}};
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

std::vector<Message> fold_names(const Explanation& e) {
  std::vector<Message> out;
  if (!e.before) return out;
  const auto& sessions = e.recording->sessions;
  for (const auto& [begin, end] : e.before->folds) {
    if (sessions.size() == 1) {
      out.push_back(msg("part {}", out.size() + 1));
      continue;
    }
    const auto at = [&](Eigen::Index row) {
      return std::find_if(sessions.begin(), sessions.end(),
                          [&](const auto& s) { return row < s.end; })
          ->name;
    };
    const std::string first = at(begin), last = at(end - 1);
    out.push_back(first == last ? Message(Name{first}) : msg("{} to {}", first, last));
  }
  return out;
}

Message left_over_words(const Explanation& e) {
  constexpr double k_more_than_noise = 1.5;
  if (e.verdict != Verdict::clean || e.gain.base_rmse_n < k_more_than_noise * e.gain.noise_floor_n)
    return {};
  return msg(
      "The simulation misses by {} rms where the noise of the force is {}: as much as the errors of the position may make ({}).",
      as_n(e.gain.base_rmse_n, 4), as_n(e.gain.noise_floor_n, 4), as_n(e.position_error_n, 4));
}

Message heading_of(const Cause& c) {
  return msg("cause: {} ({}), {} rms, p = {}", mechanism_of(c).name,
             cavum::Term{mechanism_of(c).words}, as_n(c.effect_n, 4),
             as_number(c.p_value, c.p_value < 0.001 ? k_as_needed : 3));
}

Lines to_text(const Cause& c) {
  Lines out;
  out.add(msg("force {}", cavum::Term{mechanism_of(c).equation}));
  const Number sure = as_percent(100.0 * c.probability);
  out.add(c.aliases.empty()
              ? msg("{}: {}", probability_words(c.probability), sure)
              : msg("{}: {}; that it is this or one that fits as well: {}",
                    probability_words(c.probability), sure, as_percent(100.0 * c.set_probability)));
  const Interval& gain = c.gain_percent;
  out.add(msg("alone it lowers the error on sessions not seen by {} ({} to {})",
              as_percent(gain.value, 1), as_number(gain.low, 1), as_number(gain.high, 1)));
  for (const auto& [name, i] : c.parameters)
    out.row({Name{name}, msg("{}", as_number(i.value)),
             msg("95 %: {} to {}", as_number(i.low), as_number(i.high))});
  List same{{}, true};
  for (const std::string& a : c.aliases)
    same.items.push_back(msg("{} ({})", a, cavum::Term{mechanism_at(known_mechanism(a)).words}));
  if (!c.aliases.empty()) out.add(msg("fits as well: {}", same));
  return out;
}

Lines gain_words(const Explanation& e) {
  Lines out;
  out.add(msg("k = {} ({} to {}), c = {} N s/mm ({} to {})",
              as_unit(e.base.k_n_per_mm, cavum::Unit::n_per_mm), as_number(e.k.low),
              as_number(e.k.high), as_number(e.base.c_n_s_per_mm), as_number(e.c.low),
              as_number(e.c.high)));
  out.add(msg("on sessions not seen: base {}, extended {} rms; noise floor {}",
              as_n(e.gain.base_rmse_n, 4), as_n(e.gain.extended_rmse_n, 4),
              as_n(e.gain.noise_floor_n, 4)));
  out.add(msg("gain {} ({} to {}), {} of what could be explained",
              as_percent(e.gain.percent.value, 1), as_number(e.gain.percent.low, 1),
              as_number(e.gain.percent.high, 1), as_percent(e.gain.share_percent)));
  return out;
}

Lines to_text(const Explanation& e) {
  Lines out;
  out.add(msg("verdict: {}. {}", word_of(e.verdict), in_words(e)));
  for (const auto& f : e.data_faults) out.add(msg("fault: {}", f.what));
  if (e.verdict == Verdict::data_fault) return out;
  for (const auto& c : e.causes) {
    out.gap();
    out.add(heading_of(c));
    out.append(to_text(c), 2);
  }
  if (e.unexplained) out.add(unexplained_words(*e.unexplained));
  if (Message left = left_over_words(e); !left.empty()) out.add(std::move(left));
  out.gap();
  out.append(gain_words(e));
  if (!e.not_testable.empty()) {
    List names;
    for (const auto& n : e.not_testable) names.items.emplace_back(Name{n.mechanism});
    out.add(msg("not testable with these data: {}", names));
  }
  out.add(msg("next experiment: {}", e.next_experiment.what()));
  for (const auto& n : e.notes) out.add(msg("note: {}", n.what()));
  return out;
}

}  // namespace cavum::explain
