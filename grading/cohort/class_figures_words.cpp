// The figures of a class in JSON and in words.
#include <fmt/core.h>

#include <algorithm>

#include "engine/base/text.h"
#include "grading/cohort/class_figures.h"

namespace cavum::cohort {
namespace {

using nlohmann::json;

json optional(const std::optional<double>& v) { return v ? json(*v) : json(); }

}  // namespace

std::string few_words(const ClassFigures& figures, const std::string& figure) {
  for (const Few& few : figures.few)
    if (few.figure == figure)
      return fmt::format("few: {}{}, under {} it is a rough guess", few.n, few.n == 1 ? " candidate" : " candidates", few.enough);
  return "";
}

std::string marked_by_words(const std::vector<MarkedBy>& marked_by) {
  if (marked_by.size() < 2) return "";
  std::string all;
  for (const MarkedBy& b : marked_by)
    all += fmt::format("{}{} {} (pass mark {} %)", all.empty() ? "" : ", ", b.n,
                       b.entry == 0 ? std::string("as it was sat") : fmt::format("by the rubric of entry {}", b.entry), plain_number(b.pass_percent));
  return fmt::format("not all results were marked alike: {}{}", all,
                     one_pass_percent(marked_by) ? "" : "; there is no one pass mark, and no figure at it");
}

json to_json(const ClassFigures& f) {
  json criteria = json::array(), stations = json::array(), look = json::array(), walls = json::object(), few = json::array();
  for (const auto& w : f.walls) walls[w.wall] = {{"n", w.n}, {"mean_mm", w.mean_mm}, {"p95_mm", w.p95_mm}, {"max_over_mm", w.worst_mm}};
  for (const auto& c : f.criteria)
    criteria.push_back({{"id", c.id}, {"metric", c.metric}, {"difficulty", c.difficulty}, {"discrimination", optional(c.discrimination)}});
  for (const auto& one : f.few) few.push_back({{"figure", one.figure}, {"n", one.n}, {"enough", one.enough}});
  json marked = json::array();
  for (const auto& b : f.marked_by)
    marked.push_back({{"entry", b.entry == 0 ? json() : json(b.entry)}, {"n", b.n}, {"pass_percent", b.pass_percent}});
  for (const auto& s : f.stations) stations.push_back({{"key", s.key}, {"name", s.name}, {"n", s.n}, {"mean_points", s.mean}});
  for (const auto& t : f.to_look_at) look.push_back({{"session", t.session}, {"candidate", t.candidate}, {"why", t.why}});
  const Agreement& a = f.agreement;
  json agreement = {{"n", a.n},
                    {"judges", a.judges},
                    {"incomplete", a.incomplete},
                    {"weighted_kappa", optional(a.kappa)},
                    {"borderline_cut_points", optional(a.cut)}};
  agreement["icc"] = a.icc ? json{{"single_random", a.icc->single_random},
                                  {"single_fixed", a.icc->single_fixed},
                                  {"average_random", a.icc->average_random},
                                  {"average_fixed", a.icc->average_fixed}}
                           : json();
  agreement["limits"] = a.limits ? json{{"bias", a.limits->bias}, {"sd", a.limits->sd}, {"low", a.limits->low}, {"high", a.limits->high}} : json();
  return {{"exam", f.exam},
          {"n", f.n},
          {"simulated", f.simulated},
          {"verdicts", {{"pass", f.pass}, {"fail", f.fail}, {"review", f.review}}},
          {"points", {{"mean", f.mean}, {"sd", f.sd}, {"max", f.max_points}, {"pass", optional(f.pass_points)}}},
          {"marked_by", marked},
          {"criteria", criteria},
          {"alpha", optional(f.alpha)},
          {"standard_error_points", optional(f.sem)},
          {"walls", walls},
          {"stations", stations},
          {"station_effect",
           f.station_effect ? json{{"f", f.station_effect->f}, {"chance", f.station_effect->chance}, {"share", f.station_effect->share}} : json()},
          {"agreement", agreement},
          {"few", few},
          {"to_look_at", look}};
}

std::string to_text(const ClassFigures& f) {
  const auto number = [](const std::optional<double>& v, int digits) { return v ? fixed(*v, digits) : std::string("-"); };
  const auto padded = [](std::string s, std::size_t width) {
    s.resize(std::max(width, s.size() + 1), ' ');
    return s;
  };
  const auto few = [&f](const char* figure) {
    const std::string words = few_words(f, figure);
    return words.empty() ? std::string() : fmt::format(" ({})", words);
  };
  std::string s = f.exam + ": " + std::to_string(f.n) + (f.n == 1 ? " candidate" : " candidates") +
                  (f.simulated > 0 ? fmt::format(", {} of them simulated", f.simulated) : "") + "\n" + std::to_string(f.pass) + " pass, " +
                  std::to_string(f.review) + " review, " + std::to_string(f.fail) + " fail\npoints " + fixed(f.mean, 1) + " on average of " +
                  plain_number(f.max_points) + ", standard deviation " + fixed(f.sd, 1) +
                  (f.pass_points ? ", pass mark " + fixed(*f.pass_points, 1) : "") +
                  (f.marked_by.size() > 1 ? "\n" + marked_by_words(f.marked_by) : "") + "\nCronbach's alpha " + number(f.alpha, 2) +
                  ", standard error " + number(f.sem, 1) + " points" + few("alpha") + "\n\n" + padded("criterion", 28) +
                  "share of points  discrimination" + few("discrimination") + "\n";
  for (const auto& c : f.criteria) s += fmt::format("{}{}{}\n", padded(c.id, 28), padded(fixed(c.difficulty, 2), 17), number(c.discrimination, 2));
  if (!f.walls.empty()) s += fmt::format("\n{}mean   p95    largest of all\n", padded("wall, mm (+ = overcut)", 28));
  for (const auto& w : f.walls)
    s += fmt::format("{}{}{}{}\n", padded(w.wall, 28), padded(fixed(w.mean_mm, 2), 7), padded(fixed(w.p95_mm, 2), 7), fixed(w.worst_mm, 2));
  if (f.station_effect)
    s += fmt::format("\nstations {}: they hold {} % of the variance; as much by chance in a share of {} of shuffles\n", f.stations.size(),
                     fixed(100 * f.station_effect->share, 1), fixed(f.station_effect->chance, 3));
  if (f.stations.size() > 1)
    for (const auto& one : f.stations)
      s += fmt::format("  {}{} candidates, {} points on average\n", padded(one_line(one.name), 26), one.n, fixed(one.mean, 1));
  const Agreement& a = f.agreement;
  if (a.n > 0) {
    s += fmt::format("\nmarked by people too: {} candidates, {}{}\n", a.n, a.judges, a.judges == 1 ? " judge" : " judges");
    if (a.icc)
      s += fmt::format("ICC(2,1) {}, ICC(3,1) {}, the program counted as a judge{}\n", fixed(a.icc->single_random, 2), fixed(a.icc->single_fixed, 2),
                       few("icc"));
    if (a.limits)
      s += fmt::format("program less people {} points, {} to {}{}\n", fixed(a.limits->bias, 1), fixed(a.limits->low, 1), fixed(a.limits->high, 1),
                       few("limits"));
    if (f.pass_points) s += fmt::format("weighted kappa {}{}\n", number(a.kappa, 2), few("weighted_kappa"));
    if (a.cut) s += fmt::format("cut by borderline regression {} points{}\n", fixed(*a.cut, 1), few("borderline_cut"));
  }
  if (!f.to_look_at.empty()) s += "\nto look at\n";
  for (const auto& t : f.to_look_at)
    s += fmt::format("{}{}{}\n", padded(t.session > 0 ? fmt::format("  entry {}", t.session) : "  no entry", 14), padded(t.candidate, 18), t.why);
  return s;
}

}  // namespace cavum::cohort
