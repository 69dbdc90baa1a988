// The figures of a class in JSON and in words.
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
      return "few: " + std::to_string(few.n) + (few.n == 1 ? " candidate" : " candidates") + ", under " + std::to_string(few.enough) +
             " it is a rough guess";
  return "";
}

json to_json(const ClassFigures& f) {
  json criteria = json::array(), stations = json::array(), look = json::array(), walls = json::object(), few = json::array();
  for (const auto& w : f.walls) walls[w.wall] = {{"n", w.n}, {"mean_mm", w.mean_mm}, {"p95_mm", w.p95_mm}, {"max_over_mm", w.worst_mm}};
  for (const auto& c : f.criteria)
    criteria.push_back({{"id", c.id}, {"metric", c.metric}, {"difficulty", c.difficulty}, {"discrimination", optional(c.discrimination)}});
  for (const auto& one : f.few) few.push_back({{"figure", one.figure}, {"n", one.n}, {"enough", one.enough}});
  for (const auto& s : f.stations) stations.push_back({{"key", s.key}, {"n", s.n}, {"mean_points", s.mean}});
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
          {"points", {{"mean", f.mean}, {"sd", f.sd}, {"max", f.max_points}, {"pass", f.pass_points}}},
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
    return words.empty() ? std::string() : " (" + words + ")";
  };
  std::string s = f.exam + ": " + std::to_string(f.n) + (f.n == 1 ? " candidate" : " candidates") +
                  (f.simulated > 0 ? ", " + std::to_string(f.simulated) + " of them simulated" : "") + "\n" + std::to_string(f.pass) + " pass, " +
                  std::to_string(f.review) + " review, " + std::to_string(f.fail) + " fail\npoints " + fixed(f.mean, 1) + " on average of " +
                  plain_number(f.max_points) + ", standard deviation " + fixed(f.sd, 1) + ", pass mark " + fixed(f.pass_points, 1) +
                  "\nCronbach's alpha " + number(f.alpha, 2) + ", standard error " + number(f.sem, 1) + " points" + few("alpha") + "\n\n" +
                  padded("criterion", 28) + "share of points  discrimination" + few("discrimination") + "\n";
  for (const auto& c : f.criteria) s += padded(c.id, 28) + padded(fixed(c.difficulty, 2), 17) + number(c.discrimination, 2) + "\n";
  if (!f.walls.empty()) s += "\n" + padded("wall, mm (+ = overcut)", 28) + "mean   p95    largest of all\n";
  for (const auto& w : f.walls)
    s += padded(w.wall, 28) + padded(fixed(w.mean_mm, 2), 7) + padded(fixed(w.p95_mm, 2), 7) + fixed(w.worst_mm, 2) + "\n";
  if (f.station_effect)
    s += "\nstations " + std::to_string(f.stations.size()) + ": they hold " + fixed(100 * f.station_effect->share, 1) +
         " % of the variance; as much by chance in a share of " + fixed(f.station_effect->chance, 3) + " of shuffles\n";
  const Agreement& a = f.agreement;
  if (a.n > 0) {
    s +=
        "\nmarked by people too: " + std::to_string(a.n) + " candidates, " + std::to_string(a.judges) + (a.judges == 1 ? " judge" : " judges") + "\n";
    if (a.icc)
      s += "ICC(2,1) " + fixed(a.icc->single_random, 2) + ", ICC(3,1) " + fixed(a.icc->single_fixed, 2) + ", the program counted as a judge" +
           few("icc") + "\n";
    if (a.limits)
      s += "program less people " + fixed(a.limits->bias, 1) + " points, " + fixed(a.limits->low, 1) + " to " + fixed(a.limits->high, 1) +
           few("limits") + "\n";
    s += "weighted kappa " + number(a.kappa, 2) + few("weighted_kappa") + "\n";
    if (a.cut) s += "cut by borderline regression " + fixed(*a.cut, 1) + " points" + few("borderline_cut") + "\n";
  }
  if (!f.to_look_at.empty()) s += "\nto look at\n";
  for (const auto& t : f.to_look_at)
    s += padded(t.session > 0 ? "  entry " + std::to_string(t.session) : "  no entry", 14) + padded(t.candidate, 18) + t.why + "\n";
  return s;
}

}  // namespace cavum::cohort
