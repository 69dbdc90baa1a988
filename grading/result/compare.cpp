#include "grading/result/compare.h"

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "engine/base/message_json.h"
#include "engine/base/text.h"
#include "grading/result/loss.h"
#include "grading/result/result_json.h"

namespace cavum::grading {
namespace {

using Json = nlohmann::ordered_json;

constexpr double k_same = 1e-6;  // results are written to a millionth

bool same(const std::optional<double>& a, const std::optional<double>& b) {
  return a.has_value() == b.has_value() && (!a || std::fabs(*a - *b) <= k_same);
}
Value number(const std::optional<double>& v) {
  return v ? Value(as_number(*v)) : Value(Term{noop("none")});
}

struct ChangeRow {
  ChangeKind kind;
  const char *name, *english;
};
constexpr ChangeRow k_changes[] = {
    {ChangeKind::metric, "metric", noop("metric")},
    {ChangeKind::full, "full", noop("full marks at")},
    {ChangeKind::zero, "zero", noop("no marks at")},
    {ChangeKind::points, "points", noop("points")},
    {ChangeKind::band_limits, "band_limits", noop("limits of bands")},
    {ChangeKind::critical_above, "critical_above", noop("critical above")},
    {ChangeKind::critical_below, "critical_below", noop("critical below")},
    {ChangeKind::value, "value", noop("value")},
    {ChangeKind::added, "added", noop("new criterion")},
    {ChangeKind::dropped, "dropped", noop("no longer a criterion")},
    {ChangeKind::other_scenario, "other_scenario", noop("measured against the new scenario")},
    {ChangeKind::sealed_otherwise, "sealed_otherwise",
     noop("the sealed figure is not what grading gives: tampered with, or of another program")},
    {ChangeKind::work_share, "work_share", noop("another share of the work counts as done")},
    {ChangeKind::pass_percent, "pass_percent", noop("pass mark")},
    {ChangeKind::open_step, "open_step", noop("an exam whose last step is open")},
    {ChangeKind::within_bound, "within_bound", noop("a verdict that bounds leave open")},
    {ChangeKind::borderline_percent, "borderline_percent", noop("borderline band")},
    {ChangeKind::rule, "rule", noop("rule")},
    {ChangeKind::bands, "bands", noop("bands")},
};
static_assert([] {
  for (std::size_t i = 0; i < std::size(k_changes); ++i)
    if (k_changes[i].kind != static_cast<ChangeKind>(i)) return false;
  return std::size(k_changes) == static_cast<std::size_t>(ChangeKind::bands) + 1;
}());
const ChangeRow& row_of(ChangeKind kind) { return k_changes[static_cast<std::size_t>(kind)]; }

template <class All>
auto* find(All& list, const std::string& id) {
  const auto found =
      std::find_if(list.begin(), list.end(), [&](const auto& c) { return c.id == id; });
  return found == list.end() ? nullptr : &*found;
}

Value limits_value(const std::vector<double>& limits) {
  List list;
  for (const double limit : limits) list.items.push_back(msg("{}", as_number(limit)));
  return limits.empty() ? number({}) : Value(list);
}

void changes_of_spec(const scenarios::CriterionSpec& a, const scenarios::CriterionSpec& b,
                     Changes& why) {
  using enum ChangeKind;
  const auto figure = [&](ChangeKind kind, const std::optional<double>& from,
                          const std::optional<double>& to) {
    if (!same(from, to)) why.push_back({kind, number(from), number(to)});
  };
  if (a.metric != b.metric) why.push_back({metric, Name{a.metric}, Name{b.metric}});
  figure(full, a.full, b.full);
  figure(zero, a.zero, b.zero);
  figure(points, a.points, b.points);
  if (a.band_limits != b.band_limits)
    why.push_back({band_limits, limits_value(a.band_limits), limits_value(b.band_limits)});
  figure(critical_above, a.critical_above, b.critical_above);
  figure(critical_below, a.critical_below, b.critical_below);
}

Changes changes_of_rules(const scenarios::RubricSpec& a, const scenarios::RubricSpec& b) {
  using enum ChangeKind;
  Changes rules;
  const auto change = [&](ChangeKind kind, const Value& from, const Value& to) {
    if (!(from == to)) rules.push_back({kind, from, to});
  };
  const auto open = [](bool passes) {
    return Term{passes ? noop("may pass") : noop("is reviewed")};
  };
  const auto in_bound = [](bool reviewed) {
    return Term{reviewed ? noop("is reviewed") : noop("stands")};
  };
  const auto sum = [](bool compensatory) {
    return Term{compensatory ? noop("compensatory") : noop("non-compensatory")};
  };
  const auto bands_of = [](const scenarios::RubricSpec& of) {
    List list;
    for (const auto& band : of.bands)
      list.items.push_back(band.most ? msg("{} (at most {})", Authored{band.name}, *band.most)
                                     : msg("{}", Authored{band.name}));
    return of.bands.empty() ? number({}) : Value(list);
  };
  change(pass_percent, as_percent(a.pass_percent, k_as_needed),
         as_percent(b.pass_percent, k_as_needed));
  change(open_step, open(a.open_step_passes), open(b.open_step_passes));
  change(within_bound, in_bound(a.review_within_bound), in_bound(b.review_within_bound));
  change(borderline_percent, as_percent(a.borderline_percent, k_as_needed),
         as_percent(b.borderline_percent, k_as_needed));
  change(rule, sum(a.compensatory), sum(b.compensatory));
  change(bands, bands_of(a), bands_of(b));
  return rules;
}

}  // namespace

std::optional<OldResult> read_old_result(const std::string& json_text) {
  const Json j = Json::parse(json_text, nullptr, false);
  const auto number_of = [](const Json& from, const char* name) {
    return from.contains(name) && from[name].is_number() ? from[name].get<double>() : 0.0;
  };
  if (!j.is_object() || !j.contains("verdict") || !j["verdict"].is_string() ||
      !j.contains("score") || !j["score"].is_object())
    return {};
  OldResult r;
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

Number signed_points(double difference) {
  constexpr double k_shown = 0.05;
  return {std::fabs(difference) < k_shown ? 0.0 : difference, Unit::none, 1, 0.0, true};
}

Comparison compare(const OldResult& sealed, const Result& again,
                   const scenarios::RubricSpec& old_rubric, const Result& now,
                   const scenarios::RubricSpec& new_rubric) {
  Comparison c;
  c.before = sealed;
  c.verdict = verdict_name(now.verdict);
  c.points = now.points;
  c.max = now.max_points;
  c.rules = changes_of_rules(old_rubric, new_rubric);
  c.tampered = sealed.verdict != verdict_name(again.verdict) || !same(sealed.points, again.points);
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
      d.why.push_back({ChangeKind::added});
    } else {
      d.old_points = o->points;
      d.old_max = o->max;
      d.old_value = o->value;
      const scenarios::CriterionSpec* was = find(old_rubric.criteria, n.id);
      const scenarios::CriterionSpec* is = find(new_rubric.criteria, n.id);
      if (was != nullptr && is != nullptr) changes_of_spec(*was, *is, d.why);
      if (a != nullptr && a->metric == n.metric && !same(a->value, n.value))
        d.why.push_back({ChangeKind::other_scenario});
      if (a != nullptr && (!same(a->value, o->value) || !same(a->points, o->points))) {
        c.tampered = true;
        d.why.push_back({ChangeKind::sealed_otherwise});
      }
      if (constexpr double k_shown = 5e-4;
          o->value && n.value && std::fabs(*o->value - *n.value) >= k_shown)
        d.why.push_back({ChangeKind::value,
                         as_unit(*o->value, unit_of(n.unit).value_or(Unit::none), 3),
                         as_unit(*n.value, unit_of(n.unit).value_or(Unit::none), 3)});
      if (a != nullptr && !same(a->work_share, n.work_share))
        d.why.push_back({ChangeKind::work_share});
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
    d.why.push_back({ChangeKind::dropped});
    c.criteria.push_back(std::move(d));
  }
  return c;
}

Message Change::message() const {
  const Term name{row_of(kind).english};
  return from ? msg("{}: {} → {}", name, *from, *to) : msg("{}", name);
}

Message all_of(const Changes& changes) {
  List list{{}, true};
  for (const Change& c : changes) list.items.push_back(c.message());
  return msg("{}", list);
}

bool Comparison::differs() const {
  return verdict != before.verdict || !same(points, before.points) || !same(max, before.max);
}

Message regrade_text(const Comparison& c) {
  const auto result = [](const std::string& verdict, double points, double max) {
    return msg("{}, {} of {} points", Term{verdict}, as_points(points), as_points(max));
  };
  const Message now = result(c.verdict, c.points, c.max),
                sealed = result(c.before.verdict, c.before.points, c.before.max);
  const Message by = c.entry ? msg("what the ledger keeps with entry {}", *c.entry)
                     : !c.rubric.empty() && !c.scenario.empty()
                         ? msg("the rubric {} and the scenario {}", c.rubric, c.scenario)
                     : !c.rubric.empty()   ? msg("the rubric {}", c.rubric)
                     : !c.scenario.empty() ? msg("the scenario {}", c.scenario)
                                           : msg("this version of the program");
  return c.tampered
             ? msg("{} (marked by: {}); the exam was sealed as {}, which is not what grading gives: the result was tampered "
                   "with, or its station's program was, or is another one",
                   now, by, sealed)
             : msg("{} (marked by: {}); the exam was sealed as {}", now, by, sealed);
}

Json to_json(const Comparison& c) {
  const auto optional = [&](const std::optional<double>& v) {
    return v ? Json(rounded(*v)) : Json(nullptr);
  };
  const auto json_of = [](const Changes& changes) {
    Json all = Json::array();
    for (const Change& change : changes) {
      Json& one = all.emplace_back(Json{{"kind", row_of(change.kind).name}});
      if (change.from) one["from"] = encode(*change.from), one["to"] = encode(*change.to);
      one["text"] = change.message();
    }
    return all;
  };
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
                    {"changed", json_of(d.why)}});
  return {{"by",
           {{"rubric", c.rubric},
            {"scenario", c.scenario},
            {"entry", c.entry ? Json(*c.entry) : Json(nullptr)}}},
          {"old",
           {{"verdict", c.before.verdict},
            {"points", rounded(c.before.points)},
            {"max", rounded(c.before.max)}}},
          {"new", {{"verdict", c.verdict}, {"points", rounded(c.points)}, {"max", rounded(c.max)}}},
          {"criteria", list},
          {"rules", json_of(c.rules)},
          {"tampered", c.tampered}};
}

Lines to_text(const Comparison& c) {
  const auto points = [&](const std::optional<double>& p, const std::optional<double>& max) {
    return p ? msg("{} / {}", as_points(*p), as_points(max.value_or(0))) : msg("-");
  };
  Lines out;
  out.row({Message(), msg("old"), msg("new"), msg("change"), msg("what changed")});
  out.row({msg("verdict"),
           msg("{}", Term{c.before.verdict}),
           msg("{}", Term{c.verdict}),
           {},
           all_of(c.rules)});
  out.row({msg("points"),
           points(c.before.points, c.before.max),
           points(c.points, c.max),
           msg("{}", signed_points(c.points - c.before.points)),
           {}});
  for (const auto& d : c.criteria) {
    out.row({Name{d.id}, points(d.old_points, d.old_max), points(d.new_points, d.new_max),
             msg("{}", signed_points(d.difference())), all_of(d.why)});
  }
  return out;
}

}  // namespace cavum::grading
