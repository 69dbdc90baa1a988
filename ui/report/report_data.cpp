#include "ui/report/report_data.h"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "engine/physics/bur/bur.h"
#include "engine/tooth/adjacent.h"
#include "scenarios/exam/runner.h"
#include "scenarios/review/picture.h"
#include "ui/language/language.h"
#include "ui/language/say.h"
#include "ui/report/figures/motion_track.h"
#include "ui/report/figures/packed_array.h"
#include "ui/report/figures/tooth_grid.h"
#include "ui/report/report_document.h"

namespace cavum::report {
namespace {

using nlohmann::json;

constexpr double k_silhouette_step_mm = 0.1, k_silhouette_mm = 12.0;

double rounded(double v, double unit) { return std::round(v / unit) * unit; }
json point(Vec3 p) { return {rounded(p.x, 1e-4), rounded(p.y, 1e-4), rounded(p.z, 1e-4)}; }
json cells(IVec3 v) { return {v.x, v.y, v.z}; }
json site(const std::optional<Vec3>& p) { return p ? point(*p) : json(); }

json grid_json(const ReportSource& s) {
  const ToothGrid g = make_tooth_grid(s.input.seen_before());
  const ChangedCells c = make_changed_cells(g, s.input);
  json grid = cells_json(g, c);
  if (!s.scan) {
    grid["first"] = packed_array(c.first);
    grid["last"] = packed_array(c.last);
  }
  return grid;
}

json motion_json(const ReportSource& s) {
  const MotionTrack m = make_motion_track(s.input);
  return {{"dt_s", m.step_s},
          {"n", m.size()},
          {"x_um", packed_array(m.x_um, true)},
          {"y_um", packed_array(m.y_um, true)},
          {"z_um", packed_array(m.z_um, true)},
          {"ax", packed_array(m.axis_x, true)},
          {"ay", packed_array(m.axis_y, true)},
          {"az", packed_array(m.axis_z, true)},
          {"force_cn", packed_array(m.force_cn)},
          {"depth_um", packed_array(m.depth_um, true)},
          {"rpm10", packed_array(m.rpm10, true)},
          {"tip_50um_s", packed_array(m.tip_50um_s)}};
}

/// Silhouettes of the burs that were mounted, from when.
json instruments_json(const ReportSource& s) {
  json list = json::array();
  int mounted = -1;
  for (std::size_t i = 0; i < s.input.inputs.size(); ++i) {
    const std::size_t bur = s.input.inputs[i].bur;
    if (static_cast<int>(bur) == mounted) continue;
    mounted = static_cast<int>(bur);
    if (bur >= s.facts.burs_toml.size()) continue;
    const Bur p = parse_bur(s.facts.burs_toml[bur], fmt::format("bur_{:03}.toml", bur));
    json profile = json::array({{0.0, 0.0}});
    for (const auto& at :
         p.profile.walk(k_silhouette_step_mm, std::min(k_silhouette_mm, p.profile.length_mm())))
      profile.push_back({rounded(at.at.z_mm, 1e-3), rounded(at.at.r_mm, 1e-3)});
    list.push_back({{"from_s", static_cast<double>(i) * k_tick_s},
                    {"name", tr("{}", Term{p.title})},
                    {"profile_mm", std::move(profile)}});
  }
  return list;
}

}  // namespace

json tissues_json(const Tooth& tooth, bool high_contrast) {
  std::size_t most = 0;
  for (const auto& t : tooth.tissues) most = std::max<std::size_t>(most, t.id);
  json list = json::array();
  for (std::size_t id = 0; id <= most; ++id)
    list.push_back(
        {{"name", id == k_air ? "air" : "unused"}, {"colour", "#ffffff"}, {"solid", false}});
  for (const auto& t : tooth.tissues)
    list[t.id] = {{"name", t.name},
                  {"words", tr(tissue_words(t.name))},
                  {"colour", scenarios::tissue_colour(t.id, high_contrast)},
                  {"solid", t.solid},
                  {"pulp", known_tissue(t.name).kind == TissueKind::pulp},
                  {"beside", is_adjacent(t.name)}};
  return list;
}

json cells_json(const ToothGrid& g, const ChangedCells& c) {
  return {{"cell_mm", g.cell_mm},
          {"origin_mm", point(g.origin_mm)},
          {"size", cells(g.size)},
          {"before", packed_array(shares_of(g.solid, g.cell_leaves()))},
          {"tissue", packed_array(g.tissue)},
          {"box", {{"low", cells(c.low)}, {"size", cells(c.size)}}},
          {"after", packed_array(shares_of(c.solid, g.cell_leaves()))},
          {"distance", packed_array(c.distance)}};
}

void add_words(json& data) {
  if (language() == "en") return;
  json words = json::object();
  for (const auto& m : page_messages()) words[m] = tr("{}", Term{m});
  for (int group = 0; group <= static_cast<int>(EventGroup::gap); ++group)
    words[name_of(static_cast<EventGroup>(group))] = tr(word_of(static_cast<EventGroup>(group)));
  data["words"] = std::move(words);
  data["decimal_sign"] = std::string(1, decimal_sign());
}

namespace {

/// When each step was completed, in their order.
json steps_json(const ReportSource& s) {
  json list = json::array();
  for (const auto& e : s.input.events)
    if (e.as<StepCompleted>() != nullptr) list.push_back(static_cast<double>(e.tick) * k_tick_s);
  return list;
}

/// The other session without what both have in common.
json compared_json(const ComparedReport& beside, const json& own) {
  json other = report_data(beside.source);
  for (const char* same :
       {"schema", "kind", "title", "high_contrast", "tissues", "scale_mm", "words", "decimal_sign"})
    other.erase(same);
  for (const char* same : {"before", "tissue"})
    if (other["grid"][same] == own["grid"][same]) other["grid"].erase(same);
  other["name"] = beside.name;
  return other;
}

}  // namespace

json report_data(const ReportSource& s) {
  json data = {{"schema", 1},
               {"kind", s.scan ? "scan" : "session"},
               {"title", report_title(s)},
               {"high_contrast", s.input.scenario.accommodations.high_contrast},
               {"tissues",
                tissues_json(s.input.seen_before(), s.input.scenario.accommodations.high_contrast)},
               {"grid", grid_json(s)},
               {"scale_mm", k_colours_end_mm}};
  if (s.scan) {
    add_words(data);
    return data;
  }
  json events = json::array(), moments = json::array();
  for (const auto& e : s.events)
    events.push_back({{"t_s", e.t_s},
                      {"kind", name_of(e.kind)},
                      {"text", tr(e.text)},
                      {"site_mm", site(e.site_mm)}});
  for (const auto& w : s.lost)
    for (const auto& m : w.items) {
      if (m.tick < 0) continue;
      moments.push_back(
          {{"criterion", tr("{}", Authored{w.criterion.title})},
           {"t_s", static_cast<double>(m.tick) * k_tick_s},
           {"to_t_s", static_cast<double>(std::max(m.tick, m.end_tick)) * k_tick_s},
           {"site_mm", site(m.site_mm)},
           {"what", tr(m.what())},
           {"points_lost", m.points_lost ? json(rounded(*m.points_lost, 1e-3)) : json()}});
    }
  data["duration_s"] = static_cast<double>(s.input.records.size()) * k_tick_s;
  data["motion"] = motion_json(s);
  data["instruments"] = instruments_json(s);
  data["events"] = std::move(events);
  data["moments"] = std::move(moments);
  data["steps_s"] = steps_json(s);
  if (s.beside) data["beside"] = compared_json(*s.beside, data);
  add_words(data);
  return data;
}

}  // namespace cavum::report
