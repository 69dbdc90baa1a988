#include "grading/result/compare.h"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "engine/base/kept.h"
#include "engine/base/text.h"
#include "grading/result/result_json.h"

namespace cavum::grading {
namespace {

using Json = nlohmann::ordered_json;

constexpr double k_same = 1e-6;  // results are written to a millionth

bool same(const std::optional<double>& a, const std::optional<double>& b) {
  return a.has_value() == b.has_value() && (!a || std::fabs(*a - *b) <= k_same);
}
std::string number(const std::optional<double>& v) { return v ? plain_number(*v) : "none"; }

template <class List>
auto* find(List& list, const std::string& id) {
  const auto found = std::find_if(list.begin(), list.end(), [&](const auto& c) { return c.id == id; });
  return found == list.end() ? nullptr : &*found;
}

void changes_of_spec(const scenarios::CriterionSpec& a, const scenarios::CriterionSpec& b, std::vector<std::string>& why) {
  const auto say = [&](const char* what, const std::string& from, const std::string& to) {
    why.push_back(fmt::format("{} {} -> {}", what, from, to));
  };
  if (a.metric != b.metric) say("metric", a.metric, b.metric);
  if (!same(a.full, b.full)) say("full marks at", number(a.full), number(b.full));
  if (!same(a.zero, b.zero)) say("no marks at", number(a.zero), number(b.zero));
  if (!same(a.points, b.points)) say("points", number(a.points), number(b.points));
  const auto list = [](const std::vector<double>& limits) {
    std::string text;
    for (const double limit : limits) text += (text.empty() ? "" : ", ") + plain_number(limit);
    return limits.empty() ? std::string("none") : text;
  };
  if (a.band_limits != b.band_limits) say("limits of bands", list(a.band_limits), list(b.band_limits));
  if (!same(a.critical_above, b.critical_above)) say("critical above", number(a.critical_above), number(b.critical_above));
  if (!same(a.critical_below, b.critical_below)) say("critical below", number(a.critical_below), number(b.critical_below));
}

}  // namespace

std::optional<OldResult> read_old_result(const std::string& json_text) {
  const Json j = Json::parse(json_text, nullptr, false);
  const auto number_of = [](const Json& from, const char* name) {
    return from.contains(name) && from[name].is_number() ? from[name].get<double>() : 0.0;
  };
  if (!j.is_object() || !j.contains("verdict") || !j["verdict"].is_string() || !j.contains("score") || !j["score"].is_object()) return {};
  OldResult r;
  constexpr double k_most_versions = 1e6;
  if (const double version = number_of(j, "grading_version"); version >= 0 && version < k_most_versions)
    r.grading_version = static_cast<int>(version);
  r.verdict = one_line(j["verdict"].get<std::string>());
  r.points = number_of(j["score"], "points");
  r.max = number_of(j["score"], "max");
  if (j.contains("criteria") && j["criteria"].is_array())
    for (const auto& c : j["criteria"]) {
      if (!c.is_object() || !c.contains("id") || !c["id"].is_string()) continue;
      OldCriterion o;
      o.id = one_line(c["id"].get<std::string>());
      if (c.contains("value") && c["value"].is_number()) o.value = c["value"].get<double>();
      o.points = number_of(c, "points");
      o.max = number_of(c, "max");
      r.criteria.push_back(std::move(o));
    }
  return r;
}

std::string signed_points(double difference) {
  const std::string text = fixed(difference, 1);
  return text == "-0.0" || text[0] != '-' ? "+" + fixed(std::fabs(difference), 1) : text;
}

Comparison compare(const OldResult& sealed, const Result& again, const scenarios::RubricSpec& old_rubric, const Result& now,
                   const scenarios::RubricSpec& new_rubric) {
  Comparison c;
  c.before = sealed;
  c.verdict = verdict_name(now.verdict);
  c.points = now.points;
  c.max = now.max_points;
  const auto rule = [&](const char* what, const std::string& from, const std::string& to) {
    if (from != to) c.rules.push_back(fmt::format("{} {} -> {}", what, from, to));
  };
  rule("pass mark, %", plain_number(old_rubric.pass_percent), plain_number(new_rubric.pass_percent));
  rule("an exam whose last step is open", old_rubric.open_step_passes ? "may pass" : "is reviewed",
       new_rubric.open_step_passes ? "may pass" : "is reviewed");
  rule("a verdict that bounds leave open", old_rubric.review_within_bound ? "is reviewed" : "stands",
       new_rubric.review_within_bound ? "is reviewed" : "stands");
  rule("borderline band, %", plain_number(old_rubric.borderline_percent), plain_number(new_rubric.borderline_percent));
  rule("rule", old_rubric.compensatory ? "compensatory" : "non-compensatory", new_rubric.compensatory ? "compensatory" : "non-compensatory");
  const auto bands = [](const scenarios::RubricSpec& of) {
    std::string text;
    for (const auto& b : of.bands) text += (text.empty() ? "" : ", ") + b.name + (b.most ? fmt::format(" (at most {})", *b.most) : "");
    return of.bands.empty() ? std::string("none") : text;
  };
  rule("bands", bands(old_rubric), bands(new_rubric));
  const bool same_version = sealed.grading_version == k_grading_version;
  c.tampered = same_version && (sealed.verdict != verdict_name(again.verdict) || !same(sealed.points, again.points));
  for (const auto& n : now.criteria) {
    CriterionChange d;
    d.id = n.id;
    d.unit = n.unit;
    d.new_points = n.points;
    d.new_max = n.max;
    d.new_value = n.value;
    const OldCriterion* o = find(sealed.criteria, n.id);
    const CriterionResult* a = find(again.criteria, n.id);
    if (o == nullptr) {
      d.why.emplace_back("new criterion");
    } else {
      d.old_points = o->points;
      d.old_max = o->max;
      d.old_value = o->value;
      const scenarios::CriterionSpec* was = find(old_rubric.criteria, n.id);
      const scenarios::CriterionSpec* is = find(new_rubric.criteria, n.id);
      if (was != nullptr && is != nullptr) changes_of_spec(*was, *is, d.why);
      if (a != nullptr && a->metric == n.metric && !same(a->value, n.value)) d.why.emplace_back("measured against the new scenario");
      if (a != nullptr && (!same(a->value, o->value) || !same(a->points, o->points))) {
        c.tampered = c.tampered || same_version;
        d.why.emplace_back(same_version                ? "the sealed figure is not what this version of grading, which it names, gives: tampered with"
                           : !same(a->value, o->value) ? "this version of the program measures otherwise"
                                                       : "this version of the program marks otherwise");
      }
      if (a != nullptr && !same(a->work_share, n.work_share)) d.why.emplace_back("another share of the work counts as done");
    }
    c.criteria.push_back(std::move(d));
  }
  for (const auto& o : sealed.criteria) {
    if (find(now.criteria, o.id) != nullptr) continue;
    CriterionChange d;
    d.id = o.id;
    d.old_points = o.points;
    d.old_max = o.max;
    d.old_value = o.value;
    d.why.emplace_back("no longer a criterion");
    c.criteria.push_back(std::move(d));
  }
  return c;
}

bool Comparison::differs() const { return verdict != before.verdict || !same(points, before.points) || !same(max, before.max); }

std::string regrade_text(const Comparison& c) {
  const auto score = [](double points, double max) { return fmt::format("{} of {} points", fixed(points, 1), fixed(max, 1)); };
  return fmt::format(
      "marked anew by {}: {}, {}; the exam was sealed as {}, {}{}", c.by, c.verdict, score(c.points, c.max), c.before.verdict,
      score(c.before.points, c.before.max),
      c.tampered ? ", which is not what its version of grading gives: the result was tampered with, or its station's program was" : "");
}

Json to_json(const Comparison& c) {
  const auto optional = [&](const std::optional<double>& v) { return v ? Json(rounded(*v)) : Json(nullptr); };
  Json list = Json::array();
  for (const auto& d : c.criteria)
    list.push_back({{"id", d.id},
                    {"old_points", optional(d.old_points)},
                    {"old_max", optional(d.old_max)},
                    {"old_value", optional(d.old_value)},
                    {"new_points", optional(d.new_points)},
                    {"new_max", optional(d.new_max)},
                    {"new_value", optional(d.new_value)},
                    {"unit", d.unit},
                    {"difference", rounded(d.difference())},
                    {"changed", d.why}});
  return {{"by", c.by},
          {"old", {{"verdict", c.before.verdict}, {"points", rounded(c.before.points)}, {"max", rounded(c.before.max)}}},
          {"new", {{"verdict", c.verdict}, {"points", rounded(c.points)}, {"max", rounded(c.max)}}},
          {"criteria", list},
          {"rules", c.rules},
          {"tampered", c.tampered}};
}

std::string to_text(const Comparison& c) {
  const auto cell = [](std::string s, std::size_t width) {
    s.resize(std::max(width, s.size() + 1), ' ');
    return s;
  };
  const auto points = [&](const std::optional<double>& p, const std::optional<double>& max) {
    return p ? fmt::format("{} / {}", fixed(*p, 1), fixed(*max, 1)) : "-";
  };
  std::string s = fmt::format("{}{}{}{}what changed\n", cell("", 20), cell("old", 16), cell("new", 16), cell("change", 10));
  s += fmt::format("  {}{}{}{}", cell("verdict", 18), cell(c.before.verdict, 16), cell(c.verdict, 16), cell("", 10));
  for (std::size_t i = 0; i < c.rules.size(); ++i) s += (i > 0 ? "; " : "") + c.rules[i];
  s += fmt::format("\n  {}{}{}{}\n", cell("points", 18), cell(points(c.before.points, c.before.max), 16), cell(points(c.points, c.max), 16),
                   cell(signed_points(c.points - c.before.points), 10));
  for (const auto& d : c.criteria) {
    s += fmt::format("  {}{}{}{}", kept(cell(d.id, 18)), cell(points(d.old_points, d.old_max), 16), cell(points(d.new_points, d.new_max), 16),
                     cell(signed_points(d.difference()), 10));
    for (std::size_t i = 0; i < d.why.size(); ++i) s += (i > 0 ? "; " : "") + d.why[i];
    if (!same(d.old_value, d.new_value) && d.old_value && d.new_value)
      s += fmt::format("{}value {} -> {}{}", d.why.empty() ? "" : "; ", fixed(*d.old_value, 3), fixed(*d.new_value, 3),
                       d.unit.empty() ? "" : " " + d.unit);
    s += "\n";
  }
  return s;
}

}  // namespace cavum::grading
