#include "grading/result/compare.h"

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

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
Message number(const std::optional<double>& v) { return v ? msg("{}", as_number(*v)) : msg("none"); }

/// One change: `what` is a word for what it was and is.
Message change(const Message& what, const Message& from, const Message& to) { return msg("{}: {} → {}", what, from, to); }

template <class All>
auto* find(All& list, const std::string& id) {
  const auto found = std::find_if(list.begin(), list.end(), [&](const auto& c) { return c.id == id; });
  return found == list.end() ? nullptr : &*found;
}

Message limits_text(const std::vector<double>& limits) {
  List list;
  for (const double limit : limits) list.items.push_back(msg("{}", as_number(limit)));
  return limits.empty() ? msg("none") : msg("{}", list);
}

void changes_of_spec(const scenarios::CriterionSpec& a, const scenarios::CriterionSpec& b, std::vector<Message>& why) {
  const auto figure = [&](const Message& what, const std::optional<double>& from, const std::optional<double>& to) {
    if (!same(from, to)) why.push_back(change(what, number(from), number(to)));
  };
  if (a.metric != b.metric) why.push_back(change(msg("metric"), Name{a.metric}, Name{b.metric}));
  figure(msg("full marks at"), a.full, b.full);
  figure(msg("no marks at"), a.zero, b.zero);
  figure(msg("points"), a.points, b.points);
  if (a.band_limits != b.band_limits) why.push_back(change(msg("limits of bands"), limits_text(a.band_limits), limits_text(b.band_limits)));
  figure(msg("critical above"), a.critical_above, b.critical_above);
  figure(msg("critical below"), a.critical_below, b.critical_below);
}

std::vector<Message> changes_of_rules(const scenarios::RubricSpec& a, const scenarios::RubricSpec& b) {
  std::vector<Message> rules;
  const auto rule = [&](const Message& what, const Message& from, const Message& to) {
    if (!(from == to)) rules.push_back(change(what, from, to));
  };
  const auto open_step = [](bool passes) { return passes ? msg("may pass") : msg("is reviewed"); };
  const auto within_bound = [](bool reviewed) { return reviewed ? msg("is reviewed") : msg("stands"); };
  const auto sum = [](bool compensatory) { return compensatory ? msg("compensatory") : msg("non-compensatory"); };
  const auto bands = [](const scenarios::RubricSpec& of) {
    List list;
    for (const auto& band : of.bands)
      list.items.push_back(band.most ? msg("{} (at most {})", Authored{band.name}, *band.most) : msg("{}", Authored{band.name}));
    return of.bands.empty() ? msg("none") : msg("{}", list);
  };
  rule(msg("pass mark"), msg("{}", as_percent(a.pass_percent, k_as_needed)), msg("{}", as_percent(b.pass_percent, k_as_needed)));
  rule(msg("an exam whose last step is open"), open_step(a.open_step_passes), open_step(b.open_step_passes));
  rule(msg("a verdict that bounds leave open"), within_bound(a.review_within_bound), within_bound(b.review_within_bound));
  rule(msg("borderline band"), msg("{}", as_percent(a.borderline_percent, k_as_needed)), msg("{}", as_percent(b.borderline_percent, k_as_needed)));
  rule(msg("rule"), sum(a.compensatory), sum(b.compensatory));
  rule(msg("bands"), bands(a), bands(b));
  return rules;
}

}  // namespace

std::optional<OldResult> read_old_result(const std::string& json_text) {
  const Json j = Json::parse(json_text, nullptr, false);
  const auto number_of = [](const Json& from, const char* name) {
    return from.contains(name) && from[name].is_number() ? from[name].get<double>() : 0.0;
  };
  if (!j.is_object() || !j.contains("verdict") || !j["verdict"].is_string() || !j.contains("score") || !j["score"].is_object()) return {};
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

Comparison compare(const OldResult& sealed, const Result& again, const scenarios::RubricSpec& old_rubric, const Result& now,
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
      d.why.push_back(msg("new criterion"));
    } else {
      d.old_points = o->points;
      d.old_max = o->max;
      d.old_value = o->value;
      const scenarios::CriterionSpec* was = find(old_rubric.criteria, n.id);
      const scenarios::CriterionSpec* is = find(new_rubric.criteria, n.id);
      if (was != nullptr && is != nullptr) changes_of_spec(*was, *is, d.why);
      if (a != nullptr && a->metric == n.metric && !same(a->value, n.value)) d.why.push_back(msg("measured against the new scenario"));
      if (a != nullptr && (!same(a->value, o->value) || !same(a->points, o->points))) {
        c.tampered = true;
        d.why.push_back(msg("the sealed figure is not what grading gives: tampered with, or of another program"));
      }
      if (a != nullptr && !same(a->work_share, n.work_share)) d.why.push_back(msg("another share of the work counts as done"));
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
    d.why.push_back(msg("no longer a criterion"));
    c.criteria.push_back(std::move(d));
  }
  return c;
}

bool Comparison::differs() const { return verdict != before.verdict || !same(points, before.points) || !same(max, before.max); }

Message regrade_text(const Comparison& c) {
  const auto result = [](const std::string& verdict, double points, double max) {
    return msg("{}, {} of {} points", Term{verdict}, as_points(points), as_points(max));
  };
  const Message now = result(c.verdict, c.points, c.max), sealed = result(c.before.verdict, c.before.points, c.before.max);
  return c.tampered ? msg("{} (marked by: {}); the exam was sealed as {}, which is not what grading gives: the result was tampered "
                          "with, or its station's program was, or is another one",
                          now, c.by, sealed)
                    : msg("{} (marked by: {}); the exam was sealed as {}", now, c.by, sealed);
}

Json to_json(const Comparison& c) {
  const auto optional = [&](const std::optional<double>& v) { return v ? Json(rounded(*v)) : Json(nullptr); };
  const auto texts = [](const std::vector<Message>& messages) {
    Json all = Json::array();
    for (const Message& m : messages) all.push_back(english_text(m));
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
                    {"changed", texts(d.why)}});
  return {{"by", english_text(c.by)},
          {"old", {{"verdict", c.before.verdict}, {"points", rounded(c.before.points)}, {"max", rounded(c.before.max)}}},
          {"new", {{"verdict", c.verdict}, {"points", rounded(c.points)}, {"max", rounded(c.max)}}},
          {"criteria", list},
          {"rules", texts(c.rules)},
          {"tampered", c.tampered}};
}

Lines to_text(const Comparison& c) {
  const auto points = [&](const std::optional<double>& p, const std::optional<double>& max) {
    return p ? msg("{} / {}", as_points(*p), as_points(max.value_or(0))) : msg("-");
  };
  const auto all_of = [](std::vector<Message> list) { return msg("{}", List{std::move(list), true}); };
  Lines out;
  out.row({Message(), msg("old"), msg("new"), msg("change"), msg("what changed")});
  out.row({msg("verdict"), msg("{}", Term{c.before.verdict}), msg("{}", Term{c.verdict}), {}, all_of(c.rules)});
  out.row({msg("points"), points(c.before.points, c.before.max), points(c.points, c.max), msg("{}", signed_points(c.points - c.before.points)), {}});
  for (const auto& d : c.criteria) {
    std::vector<Message> why = d.why;
    if (!same(d.old_value, d.new_value) && d.old_value && d.new_value) {
      const Unit unit = unit_of(d.unit);
      why.push_back(change(msg("value"), msg("{}", as_unit(*d.old_value, unit, 3)), msg("{}", as_unit(*d.new_value, unit, 3))));
    }
    out.row({Name{d.id}, points(d.old_points, d.old_max), points(d.new_points, d.new_max), msg("{}", signed_points(d.difference())), all_of(why)});
  }
  return out;
}

}  // namespace cavum::grading
