#include "grading/report.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>

#include "engine/base/text.h"
#include "scenarios/picture.h"

namespace cavum {
namespace {

std::string cell(const std::string& text, const char* kind = "") { return "<td" + std::string(kind) + ">" + text + "</td>"; }
std::string number_cell(const std::string& text) { return cell(text, " class='n'"); }

std::string unit_text(const std::string& unit) { return unit == "mm3" ? "mm&sup3;" : xml_text(unit); }

constexpr const char* k_style = R"(
body{font:14px/1.45 system-ui,sans-serif;color:#1a1a1a;max-width:1060px;margin:24px auto;padding:0 16px;background:#fff}
h1{font-size:22px;margin:0 0 2px}h2{font-size:16px;margin:22px 0 6px;border-bottom:1px solid #ccc;padding-bottom:3px}
.facts{color:#555;margin:0 0 14px}
.verdict{display:flex;gap:18px;align-items:center;border:2px solid;border-radius:6px;padding:10px 16px;margin:10px 0}
.verdict b{font-size:24px}.pass{border-color:#0072b2}.fail{border-color:#d55e00}.review{border-color:#8a6d00}
.regrade{background:#fff4d6;border:1px solid #8a6d00;border-radius:6px;padding:8px 16px}.verdict ul{margin:0;padding-left:18px}table{border-collapse:collapse;width:100%}
td,th{padding:4px 8px;border-bottom:1px solid #e3e3e3;text-align:left;vertical-align:top}th{font-weight:600;color:#444}
.n{text-align:right;font-variant-numeric:tabular-nums;white-space:nowrap}
.pictures{display:flex;flex-wrap:wrap;gap:12px;align-items:flex-end}.pictures svg{max-width:100%;height:auto;border:1px solid #ddd}
.two{display:grid;grid-template-columns:1fr 1fr;gap:26px}.small{color:#555;font-size:12.5px}
@media(max-width:760px){.two{grid-template-columns:1fr}}@media print{body{margin:0;font-size:11px}.pictures svg{max-width:32%}}
)";

/// Three sections through the middle of the target, moved to the place of a perforation when there is one.
std::array<std::string, 3> sections(const Result& r, const GradeInput& input) {
  const Vec3 low = input.zones.target_low_mm(), high = input.zones.target_high_mm();
  const Vec3 at = r.perforation.fault.perforated ? r.perforation.fault.first.site_mm : (low + high) * 0.5;
  const double across = low.z + 0.35 * (high.z - low.z);
  const auto draw = [&](View view, double at_mm, const char* name) {
    return section_svg(input.before, &input.after, input.zones,
                       {view, at_mm, 25, name + fixed(at_mm, 2) + " mm", input.scenario.accommodations.high_contrast});
  };
  return {draw(View::mesio_distal, at.y, "mesial-distal, y = "), draw(View::bucco_lingual, at.x, "buccal-lingual, x = "),
          draw(View::horizontal, across, "across, z = ")};
}

/// The number behind the first `key` of an SVG element, px.
double svg_px(const std::string& svg, const std::string& key) {
  double px = 0;
  const char* from = svg.data() + svg.find(key) + key.size();
  std::from_chars(from, svg.data() + svg.size(), px);
  return px;
}

std::string points_of(const std::optional<double>& points, const std::optional<double>& max) {
  return points ? fixed(*points, 1) + " / " + fixed(max.value_or(0), 1) : "&ndash;";
}

/// The sealed result and this one, criterion by criterion.
std::string regrade_html(const Comparison& c) {
  const auto because = [](const std::vector<std::string>& why) {
    std::string s;
    for (const auto& w : why) s += (s.empty() ? "" : "; ") + xml_text(w);
    return s;
  };
  std::string h =
      "<h2>Beside the sealed result</h2>\n<table><tr><th></th><th class='n'>Sealed</th><th class='n'>Regrade</th>"
      "<th class='n'>Change</th><th>What changed</th></tr>\n<tr>" +
      cell("<b>verdict</b>") + number_cell(xml_text(c.before.verdict)) + number_cell(xml_text(c.verdict)) + number_cell("") + cell(because(c.rules)) +
      "</tr>\n<tr>" + cell("<b>points</b>") + number_cell(points_of(c.before.points, c.before.max)) + number_cell(points_of(c.points, c.max)) +
      number_cell(signed_points(c.points - c.before.points)) + cell("") + "</tr>\n";
  for (const auto& d : c.criteria) {
    std::string why = because(d.why);
    if (d.old_value && d.new_value && fixed(*d.old_value, 3) != fixed(*d.new_value, 3))
      why += (why.empty() ? "" : "; ") + ("value " + fixed(*d.old_value, 3) + " &rarr; " + fixed(*d.new_value, 3) + " ") + unit_text(d.unit);
    h += "<tr>" + cell(xml_text(d.id)) + number_cell(points_of(d.old_points, d.old_max)) + number_cell(points_of(d.new_points, d.new_max)) +
         number_cell(signed_points(d.difference())) + cell(why) + "</tr>\n";
  }
  return h + "</table>\n";
}

}  // namespace

std::string sections_svg(const Result& r, const GradeInput& input) {
  constexpr double k_margin_px = 10, k_text_px = 30;
  const auto group = [](double x, double y, const std::string& content) {
    return "<g transform='translate(" + fixed(x, 0) + " " + fixed(y, 2) + ")'>" + content + "</g>\n";
  };
  const auto pictures = sections(r, input);
  const std::string legend = legend_svg(true, input.scenario.accommodations.high_contrast);
  double height = 0, x = k_margin_px;
  for (const auto& p : pictures) height = std::max(height, svg_px(p, "height='"));
  std::string body;
  for (const auto& p : pictures) {  // standing on one line
    body += group(x, k_text_px + height - svg_px(p, "height='"), p);
    x += std::ceil(svg_px(p, "width='")) + k_margin_px;
  }
  const double width = std::max(x, svg_px(legend, "width='") + 2 * k_margin_px), all = height + 2 * k_text_px + k_margin_px;
  return "<svg xmlns='http://www.w3.org/2000/svg' width='" + fixed(width, 0) + "' height='" + fixed(all, 0) + "' viewBox='0 0 " + fixed(width, 0) +
         " " + fixed(all, 0) + "' font-family='sans-serif'>\n<rect width='100%' height='100%' fill='#ffffff'/>\n<text x='10' y='20' font-size='15'>" +
         xml_text(r.scenario_title + ": " + fixed(r.volumes.target_removed_percent, 1) + " % of the target removed") + "</text>\n" + body +
         group(k_margin_px, all - k_text_px, legend) + "</svg>\n";
}

std::string report_html(const Result& r, const GradeInput& input, const ReportFacts& facts, const Comparison* regrade) {
  const auto zone = [&](Zone z) { return r.volumes.zone[static_cast<std::size_t>(z)].removed; };
  std::string h =
      "<!doctype html>\n<html lang='en'><head><meta charset='utf-8'><meta name='viewport' content='width=device-width,initial-scale=1'>\n<title>" +
      xml_text(r.scenario_title) + "</title>\n<style>" + k_style + "</style></head><body>\n";
  h += "<h1>" + xml_text(r.scenario_title) + "</h1>\n<p class='facts'>Candidate " + xml_text(facts.candidate) + " &middot; " +
       xml_text(facts.created) + " &middot; " + xml_text(r.tooth_name) + " &middot; " + xml_text(facts.device) + "</p>\n";
  if (regrade != nullptr) h += "<p class='regrade'><b>Regrade</b>: " + xml_text(regrade_text(*regrade)) + ".</p>\n";
  h += "<div class='verdict " + std::string(verdict_name(r.verdict)) + "'><div><b>" + verdict_name(r.verdict) + "</b><br>" + fixed(r.points, 1) +
       " of " + fixed(r.max_points, 1) + " points<br><small>&plusmn; " + fixed(r.points_bound, 1) +
       " if every figure were off by its whole bound</small></div><ul>";
  for (const auto& reason : r.verdict_reasons) h += "<li>" + xml_text(reason) + "</li>";
  h += "</ul></div>\n";
  if (regrade != nullptr) h += regrade_html(*regrade);

  h += "<h2>Removed against target</h2>\n<div class='pictures'>\n";
  for (const auto& section : sections(r, input)) h += section;
  h += "</div>\n" + legend_svg(true, input.scenario.accommodations.high_contrast);

  h += "<h2>Criteria</h2>\n<table><tr><th>Criterion</th><th class='n'>Value</th><th class='n'>Points</th><th>Why</th></tr>\n";
  for (const auto& c : r.criteria)
    h += "<tr>" + cell(xml_text(c.title)) +
         number_cell(c.value ? fixed(*c.value, 2) + (c.bound > 0 ? " &plusmn; " + fixed(c.bound, 2) : "") + " " + unit_text(c.unit) : "&ndash;") +
         number_cell(fixed(c.points, 1) + (c.points_bound > 0 ? " &plusmn; " + fixed(c.points_bound, 1) : "") + " / " + fixed(c.max, 1)) +
         cell(xml_text(c.reason)) + "</tr>\n";
  h += "</table>\n<div class='two'><div><h2>Volumes</h2>\n<table>";
  const auto volume = [&](const std::string& name, const Volume& v) {
    h += "<tr>" + cell(name) + number_cell(fixed(v.mm3, 2) + " &plusmn; " + fixed(v.bound_mm3, 2) + " mm&sup3;") + "</tr>\n";
  };
  volume("target", r.volumes.target);
  h += "<tr>" + cell("target removed") +
       number_cell(fixed(r.volumes.target_removed_percent, 1) + " &plusmn; " + fixed(r.volumes.target_removed_bound_percent, 1) + " %") + "</tr>\n";
  volume("target left standing", r.volumes.missed);
  volume("removed in all", r.volumes.removed);
  for (const Zone z : {Zone::leeway_sides, Zone::leeway_bottom, Zone::container_sides, Zone::container_bottom, Zone::protected_, Zone::none})
    volume("removed, " + std::string(zone_name(z)), zone(z));
  h += "<tr>" + cell("agreement (Dice)") + number_cell(fixed(r.volumes.dice, 3) + " &plusmn; " + fixed(r.volumes.dice_bound, 3)) +
       "</tr></table></div>\n<div><h2>Walls</h2>\n<table><tr><th>mm, + = overcut</th>"
       "<th class='n'>mean</th><th class='n'>p95</th><th class='n'>over</th><th class='n'>under</th></tr>\n";
  for (std::size_t w = 0; w < k_walls; ++w) {
    const WallMeasures& m = r.shape.wall[w];
    h += "<tr>" + cell(wall_name(static_cast<Wall>(w)));
    for (const auto& [v, bound] : {std::pair(m.mean_mm, m.mean_bound_mm), std::pair(m.p95_mm, m.p95_bound_mm),
                                   std::pair(m.max_over_mm, r.shape.bound_mm), std::pair(m.max_under_mm, r.shape.bound_mm)})
      h += number_cell(m.samples == 0 ? "&ndash;" : fixed(v, 2) + " &plusmn; " + fixed(bound, 2));
    h += "</tr>\n";
  }
  h += "</table>\n<h2>Cavity</h2><table>";
  const auto shape = [&](const char* name, const std::optional<double>& v, double target) {
    h += "<tr>" + cell(name) + number_cell(v ? fixed(*v, 2) + " &plusmn; " + fixed(r.shape.bound_mm, 2) + " mm" : "&ndash;") +
         number_cell("target " + fixed(target, 2) + " mm") + "</tr>\n";
  };
  shape("length", r.shape.length_mm, r.shape.target_length_mm);
  shape("width", r.shape.width_mm, r.shape.target_width_mm);
  shape("depth", r.shape.depth_mm, r.shape.target_depth_mm);
  h += "<tr>" + cell("wall taper") +
       number_cell(r.shape.taper_deg ? fixed(*r.shape.taper_deg, 1) + " &plusmn; " + fixed(r.shape.taper_bound_deg, 1) + "&deg;" : "&ndash;") +
       "<td></td></tr></table></div></div>\n";

  h += "<h2>Perforation</h2>\n<table><tr><th>Source</th><th>Kind</th><th class='n'>Time</th><th>Place, mm</th><th>What</th></tr>\n";
  const auto place = [](Vec3 p) { return fixed(p.x, 2) + ", " + fixed(p.y, 2) + ", " + fixed(p.z, 2); };
  for (const auto& e : r.perforation.events)
    h += "<tr>" + cell("force") + cell(e.fault ? "fault" : "aim") + number_cell(fixed(static_cast<double>(e.tick) * k_tick_s, 3) + " s") +
         cell(place(e.site_mm)) +
         cell(fixed(e.force_before_n, 2) + " N to " + fixed(e.force_after_n, 2) + " N; " +
              (e.confirmed ? "confirmed by the tissue" : "not confirmed by the tissue")) +
         "</tr>\n";
  for (const auto& [kind, t] : {std::pair{"fault", &r.perforation.fault}, std::pair{"aim", &r.perforation.aim}}) {
    if (t == &r.perforation.aim && !r.perforation.has_aims) continue;
    h += "<tr>" + cell("tissue") + cell(kind) + number_cell(t->perforated ? fixed(t->first.t_s(), 3) + " s" : "&ndash;") +
         cell(t->perforated ? place(t->first.site_mm) : "") +
         cell(t->perforated ? xml_text(t->tissue) + " touched, " + fixed(t->volume_mm3, 3) + " mm&sup3;" : "not touched") + "</tr>\n";
  }
  h += "</table>\n<h2>Work</h2>\n<p>Time " + fixed(r.motion.time_s, 1) + " s, handpiece turning " + fixed(r.motion.handpiece_time_s, 1) +
       " s, idle " + fixed(r.motion.idle_s, 1) + " s. Way of the tip " + fixed(r.motion.path_mm, 0) + " mm. Force " +
       fixed(r.motion.force_mean_n, 2) + " N on average while cutting, " + fixed(r.motion.force_peak_n, 2) + " N at most. Steps " +
       std::to_string(r.progress.steps_completed) + " of " + std::to_string(r.progress.steps) + " completed, " +
       std::to_string(r.progress.violations) + " violations; the exam ended: " + xml_text(r.progress.finish) + ".</p>\n";
  for (const auto& note : r.notes) h += "<p><b>Note:</b> " + xml_text(note) + "</p>\n";
  h += "<p class='small'>Session " + xml_text(facts.session_file) + ", tooth " + xml_text(facts.tooth_hash.substr(0, 16)) + ", leaf " +
       fixed(r.leaf_mm, 3) + " mm. Definitions: grading/README.md of Cavum " CAVUM_VERSION ".</p>\n</body></html>\n";
  return h;
}

}  // namespace cavum
