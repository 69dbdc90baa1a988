// The figures of a class in JSON and in words.
#include "grading/cohort/class_figures.h"

namespace cavum::cohort {
namespace {

using nlohmann::json;

json optional(const std::optional<double>& v) { return v ? json(*v) : json(); }

}  // namespace

Message few_words(const ClassFigures& figures, const std::string& figure) {
  for (const Few& few : figures.few)
    if (few.figure == figure)
      return msgn("few: {} candidate, under {} it is a rough guess",
                  "few: {} candidates, under {} it is a rough guess",
                  static_cast<std::int64_t>(few.n), few.n, few.enough);
  return {};
}

Message marked_by_words(const std::vector<MarkedBy>& marked_by) {
  if (marked_by.size() < 2) return {};
  List all;
  for (const MarkedBy& b : marked_by) {
    const Number pass = as_percent(b.pass_percent, k_as_needed);
    all.items.push_back(
        b.entry == 0 ? msg("{} as it was sat (pass mark {})", b.n, pass)
                     : msg("{} by the rubric of entry {} (pass mark {})", b.n, b.entry, pass));
  }
  return one_pass_percent(marked_by)
             ? msg("not all results were marked alike: {}", all)
             : msg("not all results were marked alike: {}; there is no one pass mark, and no figure at it",
                   all);
}

json to_json(const ClassFigures& f) {
  json criteria = json::array(), stations = json::array(), look = json::array(),
       walls = json::object(), few = json::array();
  for (const auto& w : f.walls)
    walls[w.wall] = {
        {"n", w.n}, {"mean_mm", w.mean_mm}, {"p95_mm", w.p95_mm}, {"max_over_mm", w.worst_mm}};
  for (const auto& c : f.criteria)
    criteria.push_back({{"id", c.id},
                        {"metric", c.metric},
                        {"difficulty", c.difficulty},
                        {"discrimination", optional(c.discrimination)}});
  for (const auto& one : f.few)
    few.push_back({{"figure", one.figure}, {"n", one.n}, {"enough", one.enough}});
  json marked = json::array();
  for (const auto& b : f.marked_by)
    marked.push_back({{"entry", b.entry == 0 ? json() : json(b.entry)},
                      {"n", b.n},
                      {"pass_percent", b.pass_percent}});
  for (const auto& s : f.stations)
    stations.push_back({{"key", s.key}, {"name", s.name}, {"n", s.n}, {"mean_points", s.mean}});
  for (const auto& t : f.to_look_at)
    look.push_back(
        {{"session", t.session}, {"candidate", t.candidate}, {"why", english_text(t.why)}});
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
  agreement["limits"] = a.limits ? json{{"bias", a.limits->bias},
                                        {"sd", a.limits->sd},
                                        {"low", a.limits->low},
                                        {"high", a.limits->high}}
                                 : json();
  return {
      {"exam", f.exam},
      {"n", f.n},
      {"simulated", f.simulated},
      {"verdicts", {{"pass", f.pass}, {"fail", f.fail}, {"review", f.review}}},
      {"points",
       {{"mean", f.mean}, {"sd", f.sd}, {"max", f.max_points}, {"pass", optional(f.pass_points)}}},
      {"marked_by", marked},
      {"criteria", criteria},
      {"alpha", optional(f.alpha)},
      {"standard_error_points", optional(f.sem)},
      {"walls", walls},
      {"stations", stations},
      {"station_effect", f.station_effect ? json{{"f", f.station_effect->f},
                                                 {"chance", f.station_effect->chance},
                                                 {"share", f.station_effect->share}}
                                          : json()},
      {"agreement", agreement},
      {"few", few},
      {"to_look_at", look}};
}

Lines to_text(const ClassFigures& f) {
  const auto number = [](const std::optional<double>& v, int digits) {
    return v ? msg("{}", as_number(*v, digits)) : msg("-");
  };
  Lines out;
  /// A line, and below it that its figure is from few.
  const auto add = [&](Message line, const char* figure) {
    out.add(std::move(line));
    if (const Message few = few_words(f, figure); !few.empty()) out.add(few, 2);
  };
  const auto n = static_cast<std::int64_t>(f.n);
  out.add(f.simulated > 0
              ? msgn("{}: {} candidate, {} of them simulated",
                     "{}: {} candidates, {} of them simulated", n, f.exam, f.n, f.simulated)
              : msgn("{}: {} candidate", "{}: {} candidates", n, f.exam, f.n));
  out.add(msg("{} pass, {} review, {} fail", f.pass, f.review, f.fail));
  out.add(msg("points {} on average of {}, standard deviation {}", as_points(f.mean),
              as_number(f.max_points), as_points(f.sd)));
  if (f.pass_points) out.add(msg("pass mark {}", as_points(*f.pass_points)));
  if (f.marked_by.size() > 1) out.add(marked_by_words(f.marked_by));
  add(msg("Cronbach's alpha {}, standard error {} points", number(f.alpha, 2), number(f.sem, 1)),
      "alpha");
  out.gap();
  out.row({msg("criterion"), msg("share of points"), msg("discrimination")});
  for (const auto& c : f.criteria)
    out.row({Name{c.id}, msg("{}", as_number(c.difficulty, 2)), number(c.discrimination, 2)});
  if (const Message few = few_words(f, "discrimination"); !few.empty()) out.add(few, 2);
  if (!f.walls.empty()) {
    out.gap();
    out.row({msg("wall (+ = overcut)"), msg("mean"), msg("p95"), msg("largest of all")});
  }
  for (const auto& w : f.walls)
    out.row({msg("{}", Term{w.wall}), msg("{}", as_mm(w.mean_mm)), msg("{}", as_mm(w.p95_mm)),
             msg("{}", as_mm(w.worst_mm))});
  if (f.station_effect) {
    out.gap();
    out.add(msg(
        "stations {}: they hold {} of the variance; as much by chance in a share of {} of shuffles",
        f.stations.size(), as_percent(100 * f.station_effect->share, 1),
        as_number(f.station_effect->chance, 3)));
  }
  if (f.stations.size() > 1)
    for (const auto& one : f.stations)
      out.row({Name{one.name},
               msgn("{} candidate", "{} candidates", static_cast<std::int64_t>(one.n), one.n),
               msg("{} points on average", as_points(one.mean))},
              2);
  const Agreement& a = f.agreement;
  if (a.n > 0) {
    out.gap();
    out.add(msg("marked by people too: {}, {}",
                msgn("{} candidate", "{} candidates", static_cast<std::int64_t>(a.n), a.n),
                msgn("{} judge", "{} judges", static_cast<std::int64_t>(a.judges), a.judges)));
    if (a.icc)
      add(msg("ICC(2,1) {}, ICC(3,1) {}, the program counted as a judge",
              as_number(a.icc->single_random, 2), as_number(a.icc->single_fixed, 2)),
          "icc");
    if (a.limits)
      add(msg("program less people {} points, {} to {}", as_points(a.limits->bias),
              as_points(a.limits->low), as_points(a.limits->high)),
          "limits");
    if (f.pass_points) add(msg("weighted kappa {}", number(a.kappa, 2)), "weighted_kappa");
    if (a.cut)
      add(msg("cut by borderline regression {} points", as_points(*a.cut)), "borderline_cut");
  }
  if (!f.to_look_at.empty()) {
    out.gap();
    out.add(msg("to look at"));
  }
  for (const auto& t : f.to_look_at)
    out.row(
        {t.session > 0 ? msg("entry {}", t.session) : msg("no entry"), Name{t.candidate}, t.why},
        2);
  return out;
}

}  // namespace cavum::cohort
