#include "ui/cohort_page.h"

#include <algorithm>
#include <cmath>

#include "engine/base/text.h"
#include "scenarios/picture.h"
#include "ui/chart_svg.h"

namespace cavum {
namespace {

using cohort::ClassFigures;

constexpr int k_bins = 20;

std::string number(const std::optional<double>& v, int digits) { return v ? fixed(*v, digits) : "–"; }

/// Points of the class in twentieths of the whole, and the cut.
std::string distribution(const ClassFigures& f) {
  std::vector<double> count(k_bins, 0.0);
  for (const double p : f.points) count[static_cast<std::size_t>(std::clamp(static_cast<int>(p / f.max_points * k_bins), 0, k_bins - 1))] += 1;
  Chart c;
  c.x_label = "points";
  c.y_label = "candidates";
  ChartSeries steps;
  steps.colour = "#0072b2";
  for (int i = 0; i < k_bins; ++i) {
    steps.points.push_back({f.max_points * i / k_bins, count[static_cast<std::size_t>(i)]});
    steps.points.push_back({f.max_points * (i + 1) / k_bins, count[static_cast<std::size_t>(i)]});
  }
  c.series = {steps};
  c.x_range = {0, f.max_points};
  c.y_range = {0, 1.15 * std::max(1.0, *std::max_element(count.begin(), count.end()))};
  c.marks = {{f.pass_points, true, "pass mark"}};
  if (f.agreement.cut) c.marks.push_back({*f.agreement.cut, true, "borderline regression"});
  c.width_px = 760;
  c.height_px = 300;
  return svg_page(760, 300, chart_group(c, 0, 0));
}

std::string criteria_rows(const ClassFigures& f) {
  std::string out;
  for (const auto& c : f.criteria) {
    const std::string remark = c.difficulty > 0.95                           ? "nearly everybody has all of it: it tells candidates apart little"
                               : c.difficulty < 0.2                          ? "hardly anybody has it: is the task clear, the limit right?"
                               : c.discrimination && *c.discrimination < 0.1 ? "goes its own way: who does well elsewhere does not here"
                                                                             : "";
    out += "<tr><td>" + xml_text(c.id) + "</td><td>" + xml_text(c.metric) +
           "</td><td class=n><span class=bar style='width:" + fixed(80 * c.difficulty, 0) + "px'></span> " + fixed(c.difficulty, 2) +
           "</td><td class=n>" + number(c.discrimination, 2) + "</td><td>" + remark + "</td></tr>\n";
  }
  return out;
}

std::string stations(const ClassFigures& f) {
  std::string out = "<h2>Stations</h2>\n";
  if (f.stations.size() < 2) return out + "<p>All sat at one station.</p>\n";
  out += "<table><tr><th>station (public key)<th>candidates<th>mean points</tr>\n";
  for (const auto& s : f.stations)
    out += "<tr><td><code>" + xml_text(s.key.substr(0, 16)) + "…</code></td><td class=n>" + std::to_string(s.n) + "</td><td class=n>" +
           fixed(s.mean, 1) + "</td></tr>\n";
  out += "</table>\n";
  if (f.station_effect)
    out += "<p>F = " + fixed(f.station_effect->f, 2) + "; stations hold " + fixed(100 * f.station_effect->share, 1) +
           " % of the variance, and shuffled candidates give as much in a share of " + fixed(f.station_effect->chance, 3) + " of 9,999 shuffles. " +
           (f.station_effect->chance < 0.01
                ? "<b>One station may grade harder: compare its stylus by <code>cavum devices --test</code>, and who sat there.</b>"
                : "No station stands out.") +
           "</p>\n";
  return out;
}

std::string agreement(const ClassFigures& f) {
  const auto& a = f.agreement;
  if (a.n == 0) return "<h2>Agreement with people</h2>\n<p>No marks of people were given (<code>--marks</code>).</p>\n";
  std::string out = "<h2>Agreement with people</h2>\n<p>" + std::to_string(a.n) + " candidates marked by " + std::to_string(a.judges - 1) +
                    " judges.</p>\n<table>\n";
  const auto row = [&](const std::string& what, const std::string& value, const std::string& means) {
    out += "<tr><td>" + what + "</td><td class=n>" + value + "</td><td>" + means + "</td></tr>\n";
  };
  if (a.icc) {
    row("ICC(2,1)", fixed(a.icc->single_random, 2), "agreement of one judge, the program among them, with any other");
    row("ICC(3,1)", fixed(a.icc->single_fixed, 2), "the same when a judge may be harder than another throughout");
    row("ICC(3,k)", fixed(a.icc->average_fixed, 2), "consistency of all judges' mean");
  }
  if (a.limits)
    row("program less people", fixed(a.limits->bias, 1) + " (" + fixed(a.limits->low, 1) + " to " + fixed(a.limits->high, 1) + ")",
        "points: mean, and limits within which about 95 % lie (Bland and Altman)");
  row("weighted kappa", number(a.kappa, 2), "fail, borderline, pass; quadratic weights");
  if (a.cut)
    row("cut by borderline regression", fixed(*a.cut, 1),
        "points at the rating that means borderline; the rubric's pass mark is " + fixed(f.pass_points, 1));
  return out + "</table>\n";
}

/// Middle of the leaves that most of the class cut or left wrongly, weighted by how many did; the target's where nobody did.
Vec3 hottest_mm(const cohort::ClassTooth& t) {
  const IVec3 low = t.map->low(), size = t.map->size();
  Vec3 sum;
  double all = 0;
  for (int z = 0; z < size.z; ++z)
    for (int y = 0; y < size.y; ++y)
      for (int x = 0; x < size.x; ++x) {
        const IVec3 leaf = low + IVec3{x, y, z};
        const double heat = std::max(0.0, t.map->percent(leaf));
        sum = sum + t.zones.centre_mm(leaf) * (heat * heat);
        all += heat * heat;
      }
  return all > 0 ? sum * (1 / all) : (t.zones.target_low_mm() + t.zones.target_high_mm()) * 0.5;
}

std::string places(const ClassFigures& f, const cohort::ClassTooth& t) {
  std::string out = "<h2>Where on the tooth</h2>\n<p>" + std::to_string(t.map->sessions()) +
                    " cavities laid over each other. Orange: how many of the class removed a place outside target and leeway; blue: how many left a "
                    "place inside the target. The sections run through the middle of what was cut too much.</p>\n<div class=pictures>\n";
  for (const auto& picture : class_pictures(t)) out += picture;
  out += "</div>\n" + heat_legend_svg();
  if (t.left_out > 0)
    out += "<p>" + std::to_string(t.left_out) + " sat it with another text, tooth or leaf size than most; they are not in these pictures.</p>\n";
  for (const auto& finding : t.findings) out += "<p><b>Not in these pictures:</b> " + xml_text(finding) + "</p>\n";
  if (f.walls.empty()) return out;
  out += "<table><tr><th>wall<th>cut by<th>mean, mm<th>95th percentile, mm<th>largest of all, mm</tr>\n";
  for (const auto& w : f.walls)
    out += "<tr><td>" + w.wall + "</td><td class=n>" + std::to_string(w.n) + "</td><td class=n>" + fixed(w.mean_mm, 2) + "</td><td class=n>" +
           fixed(w.p95_mm, 2) + "</td><td class=n>" + fixed(w.worst_mm, 2) + "</td></tr>\n";
  return out + "</table>\n<p><small>Signed distance of the cut surface from the target's wall, + = overcut, averaged over the class.</small></p>\n";
}

}  // namespace

std::vector<std::string> class_pictures(const cohort::ClassTooth& t) {
  const Vec3 at = hottest_mm(t);
  const auto draw = [&](View view, double at_mm, const std::string& title) {
    PictureSpec spec{view, at_mm, 30, title};
    spec.heat_percent = [&](IVec3 leaf) { return t.map->percent(leaf); };
    return section_svg(t.tooth, nullptr, t.zones, spec);
  };
  return {draw(View::occlusal, 0, "from above"), draw(View::mesio_distal, at.y, "mesial-distal, y = " + fixed(at.y, 2) + " mm"),
          draw(View::bucco_lingual, at.x, "buccal-lingual, x = " + fixed(at.x, 2) + " mm"),
          draw(View::horizontal, at.z, "across, z = " + fixed(at.z, 2) + " mm")};
}

std::string class_html(const ClassFigures& f, const cohort::ClassTooth& tooth) {
  std::string out =
      "<!DOCTYPE html>\n<html lang=\"en\"><head><meta charset=\"utf-8\"><meta name=\"viewport\" content=\"width=device-width\"><title>" +
      xml_text(f.exam) +
      ": the class</title><style>body{font:16px/1.5 sans-serif;color:#222;max-width:56em;margin:2em auto;padding:0 "
      "1em}h1{margin-bottom:0}table{border-collapse:collapse;margin:.6em 0}"
      "th,td{text-align:left;vertical-align:top;padding:.25em .9em .25em 0;border-bottom:1px solid #ccc}.n{text-align:right;white-space:nowrap}"
      ".bar{display:inline-block;height:.7em;background:#0072b2}.key{display:flex;gap:2.5em;flex-wrap:wrap;margin:1em 0}.key "
      "b{font-size:1.7em;display:block}svg{max-width:100%;height:auto}.pictures{display:flex;flex-wrap:wrap;gap:1em;align-items:flex-end}"
      "small{color:#555}</style></head><body>\n<h1>" +
      xml_text(f.exam) + "</h1>\n<p>" + std::to_string(f.n) + " candidates; the last attempt of each counts, sessions filed with findings do not." +
      (f.simulated > 0 ? " <b>" + std::to_string(f.simulated) + " were sat by simulated operators.</b>" : "") + "</p>\n<div class=key>";
  const auto key = [&](const std::string& value, const std::string& what) { out += "<span><b>" + value + "</b>" + what + "</span>"; };
  key(fixed(f.mean, 1), "mean of " + plain_number(f.max_points) + " points");
  key(fixed(f.sd, 1), "standard deviation");
  key(std::to_string(f.pass) + " / " + std::to_string(f.review) + " / " + std::to_string(f.fail), "pass / review / fail");
  key(number(f.alpha, 2), "Cronbach's alpha");
  key(number(f.sem, 1), "standard error, points");
  out += "</div>\n" + distribution(f) + "\n" + places(f, tooth) +
         "<h2>Criteria</h2>\n<table><tr><th>criterion<th>measure<th>share of points<th>discrimination<th></tr>\n" + criteria_rows(f) +
         "</table>\n<p><small>Share of points: 0 hard, 1 easy. Discrimination: correlation with the sum of the other criteria. Alpha = k/(k−1)·(1 − "
         "Σ variances of criteria / variance of the sum), "
         "Cronbach 1951; it takes criteria for parts of one skill, and a rubric of few and different ones has a low one without being unfair. "
         "Standard error: s·√(1 − alpha).</small></p>\n" +
         stations(f) + agreement(f) + "<h2>To look at</h2>\n";
  if (f.to_look_at.empty()) return out + "<p>Nothing stands out.</p>\n</body></html>\n";
  out += "<table><tr><th>entry<th>candidate<th>why</tr>\n";
  for (const auto& t : f.to_look_at)
    out += "<tr><td class=n>" + std::to_string(t.session) + "</td><td>" + xml_text(t.candidate) + "</td><td>" + xml_text(t.why) + "</td></tr>\n";
  return out + "</table>\n</body></html>\n";
}

}  // namespace cavum
