#include "grading/result/result_json.h"

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "engine/base/json_fields.h"
#include "engine/base/json_struct.h"
#include "engine/base/message_json.h"
#include "grading/result/loss.h"
#include "grading/result/mark.h"
#include "grading/result/measure_marking.h"

namespace cavum::grading {

double rounded(double v) { return std::round(v * 1e6) / 1e6 + 0.0; }

namespace {

using Json = nlohmann::ordered_json;

Json optional(const std::optional<double>& v) { return v ? Json(rounded(*v)) : Json(nullptr); }
Json point(Vec3 p) { return Json::array({rounded(p.x), rounded(p.y), rounded(p.z)}); }
Json time_of(const Trace& t) { return !t.timed() ? Json(nullptr) : Json(rounded(t.t_s())); }
Json place_of(const Trace& t) { return t.tick < 0 ? Json(nullptr) : point(t.site_mm); }
Json tick_of(const Trace& t) { return !t.timed() ? Json(nullptr) : Json(t.tick); }

Json drop_json(const std::optional<ForceDrop>& d) {
  if (!d) return nullptr;
  return {{"missing_n", rounded(d->missing_n)},
          {"share_percent", rounded(100.0 * d->share)},
          {"from_tick", d->from_tick < 0 ? Json(nullptr) : Json(d->from_tick)},
          {"to_tick", d->to_tick < 0 ? Json(nullptr) : Json(d->to_tick)},
          {"felt_tick", d->felt() ? Json(d->felt_tick) : Json(nullptr)},
          {"cut_on_s", rounded(d->cut_on_s)},
          {"severity", k_drop_severities[static_cast<std::size_t>(d->severity())]}};
}

Json truth_json(const PerforationTruth& t) {
  return {{"perforated", t.perforated},
          {"first_t_s", time_of(t.first)},
          {"first_tick", tick_of(t.first)},
          {"site_mm", place_of(t.first)},
          {"tissue", t.perforated ? Json(t.tissue) : Json(nullptr)},
          {"area_mm2", rounded(t.area_mm2)},
          {"area_bound_mm2", rounded(t.area_bound_mm2)},
          {"volume_mm3", rounded(t.volume_mm3)},
          {"bound_mm3", rounded(t.bound_mm3)},
          {"outside_mm3", rounded(t.outside_mm3)},
          {"drop", drop_json(t.drop)}};
}

Json wall_json(const WallMeasures& w, const ShapeMeasures& shape) {
  Json figures = Json::object(), bounds = Json::object();
  for (const scenarios::WallFigure f : scenarios::k_wall_figures) {
    figures[scenarios::wall_figure_name(f)] =
        w.samples == 0 ? Json(nullptr) : Json(rounded(wall_figure(w, f)));
    bounds[scenarios::wall_figure_name(f)] =
        w.samples == 0 ? Json(nullptr) : Json(rounded(wall_bound_mm(shape, w, f)));
  }
  figures["bounds"] = bounds;
  figures["samples"] = w.samples;
  figures["max_over_site_mm"] = place_of(w.worst_over);
  figures["max_over_tick"] = tick_of(w.worst_over);
  figures["max_under_site_mm"] = w.max_under_mm > 0 ? point(w.worst_under.site_mm) : Json(nullptr);
  figures["max_under_tick"] = tick_of(w.worst_under);
  return figures;
}

/// Puts the measures whose place is directly in one of these objects there, in the order of the
/// table. Counts are not among them.
void put_values(Json& j, const Result& r, std::initializer_list<const char*> objects) {
  for (const auto& m : scenarios::measures()) {
    if (m.family != nullptr || marking_of(m).whole) continue;
    const std::string at = json_location(m);
    for (const std::string object : objects)
      if (!at.empty() && at.substr(0, at.rfind('/') + 1) == object)
        j[Json::json_pointer(at)] = optional(metric_value(r, m.name).value);
  }
}
/// The same of bounds.
void put_bounds(Json& j, const Result& r, const std::string& object) {
  for (const auto& m : scenarios::measures()) {
    if (m.family != nullptr) continue;
    const std::string at = bound_json_location(m);
    if (!at.empty() && at.substr(0, at.rfind('/') + 1) == object)
      j[Json::json_pointer(at)] = rounded(metric_value(r, m.name).bound);
  }
}

Json score_json(const Result& r) {
  Json j = {{"points", rounded(r.points)},
            {"max", rounded(r.max_points)},
            {"bound", rounded(r.points_bound)},
            {"rule", r.compensatory ? "compensatory" : "non-compensatory"},
            {"pass_percent", r.pass_percent},
            {"borderline_percent", r.borderline_percent}};
  if (r.bands.empty()) return j;
  j["bands"] = Json::array();
  for (const auto& b : r.bands)
    j["bands"].push_back({{"name", b.name},
                          {"criteria", b.criteria},
                          {"most", b.most ? Json(*b.most) : Json(nullptr)}});
  return j;
}

Json json_of(const Findings& findings) {
  Json all = Json::array();
  for (const Finding& f : findings) all.push_back(to_json(f));
  return all;
}

Json criterion_json(const Result& r, const CriterionResult& c) {
  Json j = {{"id", c.id},
            {"title", c.title},
            {"metric", c.metric},
            {"value", optional(c.value)},
            {"unit", c.unit},
            {"bound", rounded(c.bound)},
            {"points", rounded(c.points)},
            {"max", rounded(c.max)},
            {"points_bound", rounded(c.points_bound)},
            {"critical_failed", c.critical_failed},
            {"facts", json_of(c.facts)},
            {"first_tick", tick_of(c.first)},
            {"first_t_s", time_of(c.first)}};
  if (c.band) j["band"] = r.bands[*c.band].name;
  if (c.work_share < 1) j["work_share"] = rounded(c.work_share);
  if (!c.judged) j["judged"] = false;
  return j;
}

void put_volumes(Json& j, const Result& r) {
  Json tissues = Json::object(), bounds = Json::object();
  for (const auto& t : r.tissues) {
    if (r.not_shown && r.not_shown->tissue[t.id]) continue;
    tissues[t.name] = rounded(r.volumes.tissue[t.id].mm3);
    bounds[t.name] = rounded(r.volumes.tissue[t.id].bound_mm3);
  }
  j["volumes"] = {{"target_mm3", rounded(r.volumes.target.mm3)}};
  put_values(j, r, {"/volumes/"});
  put_values(j, r, {"/volumes/overcut/"});
  j["volumes"]["tissue_mm3"] = tissues;
  j["volumes"]["bounds"] = {{"target_mm3", rounded(r.volumes.target.bound_mm3)}};
  put_bounds(j, r, "/volumes/bounds/");
  j["volumes"]["bounds"]["tissue_mm3"] = bounds;
}

void put_shape(Json& j, const Result& r) {
  j["walls"] = Json::object();
  for (std::size_t w = 0; w < scenarios::k_walls; ++w)
    j["walls"][scenarios::wall_name(static_cast<scenarios::Wall>(w))] =
        wall_json(r.shape.wall[w], r.shape);
  put_values(j, r, {"/shape/"});
  j["shape"].update({{"target_length_mm", rounded(r.shape.target_length_mm)},
                     {"target_width_mm", rounded(r.shape.target_width_mm)},
                     {"target_depth_mm", rounded(r.shape.target_depth_mm)},
                     {"bound_mm", rounded(r.shape.bound_mm)},
                     {"taper_bound_deg", rounded(r.shape.taper_bound_deg)}});
}

/// Only where the task opens something.
void put_access(Json& j, const Result& r) {
  if (!r.access.overhang) return;
  put_values(j, r, {"/access/"});
  j["access"]["target_taper_deg"] = optional(r.access.target_taper_deg);
  put_bounds(j, r, "/access/bounds/");
  j["access"]["bounds"]["target_taper_deg"] = rounded(r.access.target_taper_bound_deg);
}

/// Only where it is asked for: a session graded before this was known grades to the same text.
void put_pulp(Json& j, const Result& r) {
  const auto asks = [](const CriterionResult& c) {
    return json_location(scenarios::known_measure(c.metric)).starts_with("/pulp/");
  };
  if (std::none_of(r.criteria.begin(), r.criteria.end(), asks)) return;
  put_values(j, r, {"/pulp/"});
  j["pulp"].update({{"thinnest_site_mm", place_of(r.over_pulp.thinnest)},
                    {"thinnest_tick", tick_of(r.over_pulp.thinnest)}});
  put_bounds(j, r, "/pulp/bounds/");
}

/// Only where something stands beside the tooth.
void put_adjacent(Json& j, const Result& r) {
  if (!r.beside.neighbours && !r.beside.gum) return;
  put_values(j, r, {"/beside/"});
  j["beside"].update({{"neighbours", r.beside.neighbours},
                      {"gum", r.beside.gum},
                      {"deepest_site_mm", place_of(r.beside.deepest)},
                      {"deepest_tick", tick_of(r.beside.deepest)}});
  put_bounds(j, r, "/beside/bounds/");
}

Json perforation_json(const PerforationMeasures& p) {
  Json events = Json::array();
  for (const auto& e : p.events)
    events.push_back({{"t_s", rounded(static_cast<double>(e.tick) * k_tick_s)},
                      {"tick", e.tick},
                      {"seen_t_s", rounded(static_cast<double>(e.seen_tick) * k_tick_s)},
                      {"site_mm", point(e.site_mm)},
                      {"force_before_n", rounded(e.force_before_n)},
                      {"force_after_n", rounded(e.force_after_n)},
                      {"probability", rounded(e.probability)},
                      {"advance_mm", rounded(e.advance_mm)},
                      {"kind", e.fault ? "fault" : "aim"},
                      {"confirmed", e.confirmed}});
  return {{"detected", p.detected()},
          {"events", events},
          {"truth", truth_json(p.fault)},
          {"aim", truth_json(p.aim)},
          {"agree", p.agree()}};
}

Json pauses_json(const Result& r) {
  Json list = Json::array();
  std::int64_t sum = 0;
  for (const auto& p : r.pauses) {
    list.push_back({{"from_tick", p.begin}, {"to_tick", p.end}});
    if (p.by_office) list.back()["by_office"] = true;
    sum += p.end - p.begin;
  }
  return {
      {"count", r.pauses.size()}, {"ticks", sum}, {"refused", r.pauses_refused}, {"list", list}};
}

/// Only where there is something to say: a session graded before these were known grades to the
/// same text.
void restore(Json& j, const Result& r) {
  const auto& a = r.accommodations;
  if (a != scenarios::Accommodations{}) {
    j["accommodations"] = {{"extra_time_percent", a.extra_time_percent},
                           {"extra_time_s", a.extra_time_s},
                           {"left_handed", a.left_handed},
                           {"high_contrast", a.high_contrast}};
    j["time_limit_s"] = rounded(static_cast<double>(r.limit_ticks) * k_tick_s);
  }
  if (!r.pauses.empty() || r.pauses_refused > 0) j["pauses"] = pauses_json(r);
  if (r.motion.lost_s > 0) j["lost_time_s"] = rounded(r.motion.lost_s);
  if (r.motion.late_ticks > 0) j["late_removed_mm3"] = rounded(r.motion.late_removed_mm3);
  if (r.late_work.ticks > 0)
    j["late_work"] = {{"ticks", r.late_work.ticks}, {"pedal_ticks", r.late_work.pedal_ticks}};
}

}  // namespace

Json to_json(const Result& r) {
  Json j;
  j["scenario"] = {{"id", r.scenario_id}, {"title", r.scenario_title}};
  j["tooth"] = r.tooth_name;
  j["leaf_mm"] = r.leaf_mm;
  j["verdict"] = verdict_name(r.verdict);
  j["verdict_reasons"] = json_of(r.verdict_reasons);
  j["score"] = score_json(r);
  if (r.not_shown) j["score"]["not_judged_points"] = rounded(r.unjudged_points);
  j["criteria"] = Json::array();
  for (const auto& c : r.criteria) j["criteria"].push_back(criterion_json(r, c));
  put_volumes(j, r);
  put_shape(j, r);
  put_access(j, r);
  put_pulp(j, r);
  put_adjacent(j, r);
  j["perforation"] = perforation_json(r.perforation);
  put_values(j, r, {"/", "/force/"});
  j["steps"] = {{"count", r.progress.steps},
                {"completed", r.progress.steps_completed},
                {"failed", r.progress.steps_failed}};
  j["violations"] = r.progress.violations;
  j["finish"] = r.not_shown ? "scan" : finish_name(r.progress.finish);
  j["extra_time_percent"] = r.accommodations.extra_time_percent;
  j["late_ticks"] = r.motion.late_ticks + r.late_work.ticks;
  j["grading_version"] = k_grading_version;
  put_bounds(j, r, "/bounds/");
  j["bounds"]["force_n"] = rounded(r.motion.force_bound_n);  // of the mean and of the largest
  restore(j, r);
  j["notes"] = json_of(r.notes);
  return j;
}

Verdict verdict_in(const nlohmann::json& result) {
  return json_value_of<Verdict>(member_of(result, "verdict"), {msg("the result's verdict"), {}});
}

Json with_words(Json result) {
  const auto put = [](Json& findings) {
    List all{{}, true};
    for (Json& f : findings) {
      all.items.push_back(finding_in(f).message());
      f["text"] = all.items.back();
    }
    return all;
  };
  put(result["verdict_reasons"]);
  put(result["notes"]);
  for (Json& c : result["criteria"]) {
    c["reason"] = msg("{}", put(c["facts"]));
    for (const char* of_first : {"kind", "values"}) c[of_first] = c["facts"].at(0).at(of_first);
  }
  return result;
}

namespace {

void add_verdict(Lines& out, const Result& r) {
  out.add(msg("{} ({})", Authored{r.scenario_title}, Authored{r.tooth_name}));
  out.add(msg("verdict: {}, {} of {} points (± {} if every figure were off by its whole bound)",
              word_of(r.verdict), as_points(r.points), as_points(r.max_points),
              as_points(r.points_bound)));
  for (const Finding& reason : r.verdict_reasons) out.add(reason.message(), 2);
}

void add_criteria(Lines& out, const Result& r) {
  out.gap();
  for (const auto& c : r.criteria) {
    const Number most = as_points(c.max);
    out.row({Name{c.id}, c.judged ? msg("{} / {}", as_points(c.points), most) : msg("- / {}", most),
             c.judged ? msg("± {}", as_points(c.points_bound)) : Message(), c.reason()},
            2);
  }
}

void add_volumes(Lines& out, const Result& r) {
  const auto volume = [&](const Message& name, const BoundedVolume& v) {
    out.row({name, msg("{}", as_mm3(v.mm3, 2, v.bound_mm3))}, 2);
  };
  out.gap();
  out.add(msg("volumes"));
  volume(msg("target"), r.volumes.target);
  out.row({msg("target removed"), msg("{}", as_percent(r.volumes.target_removed_percent, 1,
                                                       r.volumes.target_removed_bound_percent))},
          2);
  volume(msg("missed"), r.volumes.missed);
  volume(msg("removed"), r.volumes.removed);
  const auto zone = [&](scenarios::Zone z) {
    return r.volumes.zone[static_cast<std::size_t>(z)].alone();
  };
  for (const scenarios::Zone z :
       {scenarios::Zone::leeway_sides, scenarios::Zone::leeway_bottom,
        scenarios::Zone::container_sides, scenarios::Zone::container_bottom})
    volume(msg("{}", Term{scenarios::zone_name(z)}), zone(z));
  volume(msg("outside"), r.volumes.outside());
  volume(msg("outside, protected"), zone(scenarios::Zone::protected_));
  out.row({msg("dice"), msg("{}", Number{r.volumes.dice, Unit::none, 3, r.volumes.dice_bound})}, 2);
}

void add_walls(Lines& out, const Result& r) {
  out.gap();
  out.add(msg("walls (+ = overcut; over and under ± {})", as_mm(r.shape.bound_mm, 2)));
  out.row({Message(), msg("mean"), msg("p95"), msg("over"), msg("under")}, 2);
  for (std::size_t w = 0; w < scenarios::k_walls; ++w) {
    const WallMeasures& m = r.shape.wall[w];
    const Message name = msg("{}", scenarios::wall_text(w, r.shape.facing));
    if (m.samples == 0)
      out.row({name, msg("not cut"), {}, {}, {}}, 2);
    else
      out.row({name, msg("{}", as_mm(m.mean_mm, 2, m.mean_bound_mm)),
               msg("{}", as_mm(m.p95_mm, 2, m.p95_bound_mm)), msg("{}", as_mm(m.max_over_mm, 2)),
               msg("{}", as_mm(m.max_under_mm, 2))},
              2);
  }
}

void add_cavity(Lines& out, const Result& r) {
  out.gap();
  out.add(msg("cavity"));
  const auto shape = [&](const Message& name, const std::optional<double>& v, double bound,
                         Unit unit) {
    out.row({name, v ? msg("{}", Number{*v, unit, 2, bound}) : msg("not cut")}, 2);
  };
  shape(msg("length"), r.shape.length_mm, r.shape.bound_mm, Unit::mm);
  shape(msg("width"), r.shape.width_mm, r.shape.bound_mm, Unit::mm);
  shape(msg("depth"), r.shape.depth_mm, r.shape.bound_mm, Unit::mm);
  shape(msg("wall taper"), r.shape.taper_deg, r.shape.taper_bound_deg, Unit::deg);
}

void add_truth(Lines& out, const Message& kind, const PerforationTruth& t) {
  const Term tissue{t.tissue};
  const Number area = as_mm2(t.area_mm2, 3, t.area_bound_mm2),
               volume = as_mm3(t.volume_mm3, 3, t.bound_mm3);
  if (!t.perforated)
    out.add(msg("tissue: {} not opened", kind), 2);
  else if (t.first.timed())
    out.add(msg("tissue: {}, {} opened first at {}, {} of its wall lie open, {} removed", kind,
                tissue, as_s(t.first.t_s(), 3), area, volume),
            2);
  else
    out.add(msg("tissue: {}, {} opened, {} of its wall lie open, {} removed", kind, tissue, area,
                volume),
            2);
  if (t.outside_mm3 > 0)
    out.add(
        msg("{} removed from outside the tooth, which is no perforation", as_mm3(t.outside_mm3, 3)),
        2);
  if (t.drop) out.add(msg("drop: {}, {}", kind, drop_text(*t.drop)), 2);
}

void add_perforation(Lines& out, const Result& r) {
  out.gap();
  out.add(msg("perforation"));
  if (r.perforation.events.empty() && r.perforation.force_known)
    out.add(msg("no breakthrough seen in the force"), 2);
  for (const auto& e : r.perforation.events) {
    const Message kind = e.fault ? msg("fault") : msg("aim");
    const Number t = as_s(static_cast<double>(e.tick) * k_tick_s, 3),
                 before = as_n(e.force_before_n, 2), after = as_n(e.force_after_n, 2);
    out.add(
        e.confirmed
            ? msg("force: {} at {}, {} to {}, confirmed by the tissue", kind, t, before, after)
            : msg("force: {} at {}, {} to {}, not confirmed by the tissue", kind, t, before, after),
        2);
  }
  add_truth(out, msg("fault"), r.perforation.fault);
  if (r.perforation.has_aims) add_truth(out, msg("aim"), r.perforation.aim);
  if (r.perforation.aim_unseen())
    out.add(msg("the breakthrough into the aim was not seen in the force, which costs nothing"), 2);
}

void add_motion(Lines& out, const Result& r) {
  if (r.not_shown) return;
  const MotionMeasures& m = r.motion;
  out.gap();
  out.add(msg("time {} (handpiece {}, idle {}), way {}, force {} mean, {} peak", as_s(m.time_s, 1),
              as_s(m.handpiece_time_s, 1), as_s(m.idle_s, 1), as_mm(m.path_mm, 0),
              as_n(m.force_mean_n, 2), as_n(m.force_peak_n, 2)));
  out.add(msg("steps {} of {}, violations {}, ended: {}", r.progress.steps_completed,
              r.progress.steps, r.progress.violations, Term{finish_name(r.progress.finish)}));
}

}  // namespace

Lines to_text(const Result& r) {
  Lines out;
  for (auto* add :
       {add_verdict, add_criteria, add_volumes, add_walls, add_cavity, add_perforation, add_motion})
    add(out, r);
  for (const Finding& note : r.notes) out.add(msg("note: {}", note.message()));
  return out;
}

}  // namespace cavum::grading
