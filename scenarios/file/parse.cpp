#include "scenarios/file/parse.h"

#include <fmt/core.h>

#include <algorithm>
#include <cstdlib>
#include <filesystem>

#include "engine/base/error.h"
#include "engine/base/file.h"
#include "engine/base/shipped.h"
#include "engine/base/text.h"
#include "engine/base/toml_limits.h"
#include "scenarios/file/bodies.h"
#include "scenarios/file/checked_toml.h"
#include "scenarios/file/measures.h"
#include "scenarios/file/parse_languages.h"
#include "scenarios/file/parse_steps.h"
#include "scenarios/file/parse_zones.h"
#include "scenarios/file/surface_files.h"

namespace cavum::scenarios {
namespace {

void check_measure(CheckedTable& t, const std::string& metric) {
  if (metric.empty() || find_measure(metric)) return;
  const Message what = msg("there is no measure '{}'", metric);
  const std::string of_tissue = metric + "_mm3";
  if (find_measure(of_tissue) && metric != "touched_")
    return t.problem("metric", what, msg("did you mean '{}'?", of_tissue),
                     Mistake::unknown_measure);
  std::vector<std::string> names;
  for (const auto& m : measures()) names.push_back(m.name);
  t.problem("metric", what, suggestion(metric, names), Mistake::unknown_measure);
}

std::optional<double> number_if_there(CheckedTable& t, const char* key) {
  const double value = t.number(key, -1e9, 1e9, 0);
  return t.has(key) ? std::optional(value) : std::nullopt;
}

CriterionSpec read_criterion(const toml::table& table, const std::string& at, Places& places,
                             ProblemList& problems) {
  CheckedTable t(table, "[[rubric.criteria]]", problems);
  CriterionSpec c;
  c.id = read_id(t, "");
  c.title = t.text("title", c.id);
  c.metric = t.text("metric", "", true);
  check_measure(t, c.metric);
  for (const char* key : {"metric", "full", "zero", "points", "critical_above", "critical_below"})
    t.note(places, key, fmt::format("{}/{}", at, key));
  const auto place_of = [&](const char* key) {
    const auto found = places.find(fmt::format("{}/{}", at, key));
    return found != places.end() ? found->second
                                 : Place{static_cast<int>(table.source().begin.line),
                                         static_cast<int>(table.source().begin.column)};
  };
  c.metric_at = place_of("metric");
  c.zero_at = place_of("zero");
  const auto problems_before = problems.size();
  c.full = t.number("full", -1e9, 1e9, 1, true);
  c.zero = t.number("zero", -1e9, 1e9, 0, true);
  if (problems.size() == problems_before && c.full == c.zero)
    t.problem("zero", msg("'full' and 'zero' are the same value"),
              msg("points run linearly from one to the other: make them differ"),
              Mistake::contradictory);
  c.points = t.number("points", 0, 1000, 1, true);
  c.critical_above = number_if_there(t, "critical_above");
  c.critical_below = number_if_there(t, "critical_below");
  c.band_limits = t.numbers("bands", -1e9, 1e9);
  t.note(places, "bands", fmt::format("{}/bands", at));
  const double worse = c.zero > c.full ? 1 : -1;
  for (std::size_t i = 0; i < c.band_limits.size(); ++i)
    if (worse * (c.band_limits[i] - (i == 0 ? c.full : c.band_limits[i - 1])) <=
        (i == 0 ? -1e-12 : 0)) {
      t.problem("bands",
                msg("the limit {} does not lie beyond {}", as_number(c.band_limits[i]),
                    as_number(i == 0 ? c.full : c.band_limits[i - 1])),
                msg("list where the bands end, best first: from 'full' towards 'zero'"),
                Mistake::contradictory);
      break;
    }
  c.shares_with = t.texts("shares_with");
  t.finish();
  return c;
}

/// The bands of a rubric, best first.
std::vector<BandSpec> read_bands(CheckedTable& t, ProblemList& problems) {
  constexpr std::size_t k_max_bands = 6;
  std::vector<BandSpec> bands;
  for (const auto* table : t.tables("bands")) {
    CheckedTable b(*table, "[[rubric.bands]]", problems);
    BandSpec band;
    band.name = b.text("name", "", true);
    const int most = b.whole("most", 0, 100, 0);
    if (b.has("most")) band.most = most;
    if (bands.empty() && band.most)
      b.problem("most", msg("the best band has a 'most'"),
                msg("take it out: nobody fails for what is good"), Mistake::contradictory);
    for (const auto& other : bands)
      if (other.name == band.name)
        b.problem("name", msg("two bands are called '{}'", band.name),
                  msg("give each its own name"), Mistake::duplicate);
    b.finish();
    bands.push_back(std::move(band));
  }
  if (bands.empty()) return bands;
  if (bands.size() < 2 || bands.size() > k_max_bands)
    t.problem("bands", msg("there are {} bands", bands.size()),
              msg("write 2 to {}, best first", k_max_bands), Mistake::out_of_range);
  if (std::none_of(bands.begin(), bands.end(),
                   [](const BandSpec& b) { return b.most.has_value(); }))
    t.problem("bands", msg("the bands fail nobody"),
              msg("say how many criteria may lie in a band: most = 0 for the worst"),
              Mistake::contradictory);
  return bands;
}

void check_band_limits(const RubricSpec& r, ProblemList& problems) {
  bool any = false;
  for (const auto& c : r.criteria) {
    any = any || !c.band_limits.empty();
    if (!c.band_limits.empty() && c.band_limits.size() + 1 != r.bands.size())
      problems.add(c.metric_at,
                   msg("'{}' has {} limits of bands, and the rubric {} bands", c.id,
                       c.band_limits.size(), r.bands.size()),
                   r.bands.empty() ? msg("list the bands under [[rubric.bands]]")
                                   : msg("write {}: the last band has no end", r.bands.size() - 1),
                   Mistake::contradictory);
  }
  if (!any && !r.bands.empty() && !r.criteria.empty())
    problems.add(
        r.criteria[0].metric_at, msg("the rubric has bands, and no criterion has limits of them"),
        msg("give criteria bands = [...], or take [[rubric.bands]] out"), Mistake::contradictory);
}

/// Each id under `shares_with` is that of another criterion.
void check_shares(const RubricSpec& r, ProblemList& problems) {
  for (const auto& c : r.criteria)
    for (const auto& id : c.shares_with) {
      std::vector<std::string> others;
      for (const auto& other : r.criteria)
        if (other.id != c.id) others.push_back(other.id);
      if (std::find(others.begin(), others.end(), id) == others.end())
        problems.add(c.metric_at,
                     msg("'{}' shares with '{}', which is no other criterion", c.id, id),
                     suggestion(id, others), Mistake::unknown_criterion);
    }
}

RubricSpec read_rubric(const toml::table& table, const Where& name, Places& places,
                       ProblemList& problems) {
  CheckedTable t(table, name, problems);
  RubricSpec r;
  r.compensatory = t.word("rule", {"compensatory", "non-compensatory"}, 0, true) == 0;
  r.pass_percent = t.number("pass_percent", 0, 100, 60, true);
  r.borderline_percent = t.number("borderline_percent", 0, 50, 0);
  r.open_step_passes = t.truth("open_step_passes", false);
  r.review_within_bound = t.truth("review_within_bound", false);
  r.bands = read_bands(t, problems);
  double sum = 0;
  for (const auto* c : t.tables("criteria", true)) {
    r.criteria.push_back(
        read_criterion(*c, fmt::format("rubric/criteria/{}", r.criteria.size()), places, problems));
    sum += r.criteria.back().points;
    for (std::size_t i = 0; i + 1 < r.criteria.size(); ++i)
      if (r.criteria[i].id == r.criteria.back().id && !r.criteria[i].id.empty())
        problems.add(c->source(), msg("two criteria are called '{}'", r.criteria[i].id),
                     msg("give each its own id"), Mistake::duplicate);
  }
  check_shares(r, problems);
  check_band_limits(r, problems);
  if (!r.criteria.empty() && !(sum > 0))
    t.problem("criteria", msg("no criterion gives any points"),
              msg("give at least one some points"), Mistake::missing);
  t.finish();
  return r;
}

PauseSpec read_pauses(const toml::table& table, ProblemList& problems) {
  CheckedTable t(table, "[pauses]", problems);
  PauseSpec p;
  p.count = t.whole("count", 0, 20, 0, true);
  p.longest_s = t.number("longest_s", 0.001, 3600, 60, true);
  p.button = t.whole("button", 1, 2, 2);
  t.finish();
  return p;
}

CarelessSpec read_careless(const toml::table& table, const Scenario& scenario,
                           ProblemList& problems) {
  CheckedTable t(table, "[careless]", problems);
  CarelessSpec c;
  c.fails_by = t.text("fails_by", "", true);
  c.sides_mm = t.number("sides_mm", -3, 0.9, 0);
  c.bottom_mm = t.number("bottom_mm", -3, 3, 0);
  c.opening_percent = t.number("opening_percent", 10, 100, 100);
  c.perforates = t.truth("perforates", false);
  std::vector<std::string> ids;
  for (const auto& criterion : scenario.rubric.criteria) ids.push_back(criterion.id);
  if (!c.fails_by.empty() && std::find(ids.begin(), ids.end(), c.fails_by) == ids.end())
    t.problem("fails_by", msg("the rubric has no criterion '{}'", c.fails_by),
              suggestion(c.fails_by, ids), Mistake::unknown_criterion);
  if (c.perforates && scenario.perforation.faults.empty())
    t.problem(
        "perforates", msg("'perforates' is true, and no tissue is a fault"),
        msg("list what is broken into under faults of [perforation], or leave 'perforates' out"),
        Mistake::contradictory);
  if (c == CarelessSpec{.fails_by = c.fails_by})
    t.problem("fails_by", msg("nothing is done carelessly"),
              msg("set sides_mm, bottom_mm, opening_percent or perforates"),
              Mistake::contradictory);
  t.finish();
  return c;
}

GaugeSpec read_gauges(CheckedTable& scenario) {
  GaugeSpec gauges;
  const std::vector<std::string> known{"speed", "force", "depth"};
  const auto names = scenario.texts("gauges");
  for (std::size_t i = 0; i < names.size(); ++i) {
    if (std::find(known.begin(), known.end(), names[i]) == known.end())
      scenario.problem_in("gauges", i, msg("there is no gauge '{}'", names[i]),
                          suggestion(names[i], known), Mistake::unknown_gauge);
    gauges.speed |= names[i] == "speed";
    gauges.force |= names[i] == "force";
    gauges.depth |= names[i] == "depth";
  }
  return gauges;
}

std::vector<std::string> read_burs(CheckedTable& scenario) {
  std::vector<std::string> burs = scenario.texts("burs", true);
  for (std::size_t i = 0; i < burs.size(); ++i)
    if (burs[i].find_first_not_of("abcdefghijklmnopqrstuvwxyz0123456789.-_") != std::string::npos ||
        burs[i].empty())
      scenario.problem_in("burs", i, msg("'{}' is no name of a bur", burs[i]),
                          msg("use names of data/burs, such as round-1.0"), Mistake::bad_name);
    else if (std::find(burs.begin(), burs.begin() + static_cast<std::ptrdiff_t>(i), burs[i]) !=
             burs.begin() + static_cast<std::ptrdiff_t>(i))
      scenario.problem_in("burs", i, msg("'{}' is listed twice", burs[i]),
                          msg("list each bur once"), Mistake::duplicate);
  if (burs.size() > k_max_tray) {
    scenario.problem("burs", msg("'burs' has {} items", burs.size()),
                     msg("list at most {}", k_max_tray), Mistake::too_large);
    burs.resize(k_max_tray);
  }
  return burs;
}

PerforationSpec read_perforation(const toml::table& table, std::map<std::string, Place>& places,
                                 ProblemList& problems) {
  CheckedTable t(table, "[perforation]", problems);
  PerforationSpec p;
  for (const auto& [key, list] : {std::pair("aims", &p.aims), std::pair("faults", &p.faults)}) {
    *list = t.texts(key);
    t.note(places, key, fmt::format("perforation/{}", key));
    for (std::size_t i = 0; i < list->size(); ++i)
      if (!good_id((*list)[i]))
        t.problem_in(key, i, msg("'{}' is no name of a tissue", (*list)[i]),
                     msg("use names such as pulp or periodontium"), Mistake::bad_name);
  }
  for (const auto& aim : p.aims)
    if (std::find(p.faults.begin(), p.faults.end(), aim) != p.faults.end())
      t.problem("faults", msg("'{}' is both an aim and a fault", aim),
                msg("keep it in one of the two lists"), Mistake::contradictory);
  t.finish();
  return p;
}

Scenario read_table(const toml::table& table, const std::string& path, ProblemList& problems) {
  CheckedTable t(table, msg("the scenario"), problems);
  Scenario s;
  s.path = path;
  s.id = read_id(t, "");
  s.title = t.text("title", "", true);
  s.description = t.text("description", "");
  s.tooth_file = t.text("tooth", "", true);
  s.burs = read_burs(t);
  s.max_rpm = t.number("max_rpm", 1000, 500000, 200000, true);
  s.time_limit_s = t.number("time_limit_s", 0.001, 36000, 600, true);
  s.force_limit_n = t.number("force_limit_n", 0, 100, 0);
  s.gauges = read_gauges(t);
  s.hold_results = t.truth("hold_results", false);
  if (const auto* a = t.table("accommodations")) {
    CheckedTable at(*a, "[accommodations]", problems);
    s.accommodations.extra_time_percent = at.number("extra_time_percent", 0, 400, 0);
    s.accommodations.extra_time_s = at.number("extra_time_s", 0, 36000, 0);
    s.accommodations.left_handed = at.truth("left_handed", false);
    s.accommodations.high_contrast = at.truth("high_contrast", false);
    at.finish();
  }
  if (const auto* p = t.table("pauses")) s.pauses = read_pauses(*p, problems);
  for (const char* key : {"tooth", "burs", "time_limit_s", "zones", "rubric"})
    t.note(s.places, key, key);
  s.steps = read_steps(t, s.places, problems);
  check_pause_button(s, problems);
  if (const auto* z = t.table("zones", true)) s.zones = read_zones(*z, s.places, problems);
  if (const auto* p = t.table("perforation", true))
    s.perforation = read_perforation(*p, s.places, problems);
  if (const auto* r = t.table("rubric", true))
    s.rubric = read_rubric(*r, "[rubric]", s.places, problems);
  s.rubric.path = path;
  if (const auto* c = t.table("careless")) s.careless = read_careless(*c, s, problems);
  s.languages = read_languages(t, s, problems);
  t.finish();
  return s;
}

/// Whether bytes that are no UTF-8 stand in that line.
bool is_other_encoding(const std::string& text, std::size_t line) {
  std::size_t from = 0;
  for (std::size_t n = 1; n < line && from != std::string::npos; ++n)
    if ((from = text.find('\n', from)) != std::string::npos) ++from;
  if (from == std::string::npos) return false;
  const std::string bytes = text.substr(from, text.find('\n', from) - from),
                    safe = one_line(bytes);  // each such byte is a '?' there
  return std::count(bytes.begin(), bytes.end(), '?') != std::count(safe.begin(), safe.end(), '?');
}

/// Parses the TOML itself; a file that is no TOML has exactly one problem.
bool read_toml(const std::string& text, const std::string& path, toml::table& table,
               ProblemList& problems) {
  if (text.starts_with("\xff\xfe") || text.starts_with("\xfe\xff") ||
      text.find('\0') != std::string::npos) {
    const bool wide = text.starts_with("\xff\xfe") || text.starts_with("\xfe\xff");
    problems.add(
        Place{1, 1},
        wide ? msg("this is a text in UTF-16") : msg("this is no text: it holds zero bytes"),
        wide ? msg("save it as UTF-8") : msg("give a scenario or rubric, a text file (TOML)"),
        Mistake::not_toml);
    return false;
  }
  if (const auto beyond = beyond_toml_limits(text)) {
    problems.add(Place{static_cast<int>(beyond->line), 1}, beyond->what, beyond->what_to_do,
                 Mistake::too_large);
    return false;
  }
  try {
    table = toml::parse(text, path);
    return true;
  } catch (const toml::parse_error& e) {
    if (is_other_encoding(text, e.source().begin.line))
      problems.add(e.source(), msg("a letter here is not in UTF-8, as in a text saved as Latin-1"),
                   msg("save the file as UTF-8"), Mistake::not_toml);
    else
      problems.add(e.source(), msg("this is not TOML ({})", e.description()),
                   msg("correct the line"), Mistake::not_toml);
    return false;
  }
}

Message summary(const std::vector<Problem>& list) {
  const auto more = list.size() - 1;
  return more == 0 ? list[0].what_to_do : msg("{} (and {} more)", list[0].what_to_do, more);
}

void throw_first(const std::vector<Problem>& problems) {
  if (problems.empty()) return;
  const auto more = problems.size() - 1;
  const Problem& p = problems[0];
  throw Error(
      p.mistake, p.where, p.what,
      more == 0 ? p.what_to_do
                : msg("{} (and {} more: `cavum scenario check` names every mistake of a scenario)",
                      p.what_to_do, more));
}

}  // namespace

ProblemsError::ProblemsError(std::vector<Problem> list)
    : Error(list.at(0).mistake, list[0].where, list[0].what, summary(list)),
      problems_(std::move(list)) {}

void require_none(std::vector<Problem> problems) {
  if (!problems.empty()) throw ProblemsError(std::move(problems));
}

ReadScenario read_scenario(const std::string& text, const std::string& path) {
  ProblemList problems(path);
  toml::table table;
  ReadScenario read;
  if (read_toml(text, path, table, problems)) read.scenario = read_table(table, path, problems);
  read.problems = problems.take();
  return read;
}

Scenario parse_scenario(const std::string& text, const std::string& path) {
  ReadScenario read = read_scenario(text, path);
  throw_first(read.problems);
  return std::move(read.scenario);
}

Scenario load_scenario(const std::string& path) {
  Scenario s = parse_scenario(read_text_file(path), path);
  SurfaceFiles files;
  throw_first(read_surfaces(s, files));
  return s;
}

RubricSpec parse_rubric(const std::string& text, const std::string& path) {
  ProblemList problems(path);
  toml::table table;
  RubricSpec r;
  Places places;
  if (read_toml(text, path, table, problems)) {
    const auto* inner = table.get_as<toml::table>("rubric");
    r = read_rubric(inner != nullptr ? *inner : table,
                    inner != nullptr ? Where("[rubric]") : msg("the rubric"), places, problems);
  }
  r.path = path;
  require_none(problems.take());
  return r;
}

std::string find_tooth_file(const Scenario& scenario) {
  namespace fs = std::filesystem;
  const fs::path written(scenario.tooth_file), folder = fs::path(scenario.path).parent_path();
  std::error_code unreadable;  // a name too long for the file system is not there either
  if (written.is_absolute() && fs::exists(written, unreadable)) return written.string();
  std::vector<fs::path> places{folder / written, folder / ".." / "teeth" / written};
  for (const auto& data : shipped_folders()) places.push_back(data / "teeth" / written);
  for (const fs::path& candidate : places)
    if (fs::exists(candidate, unreadable)) return candidate.lexically_normal().string();
  throw Error(Mistake::unknown_tooth, Name{scenario.path},
              msg("the tooth file '{}' is nowhere to be found", scenario.tooth_file),
              msg("put it beside the scenario or in data/teeth, or name another with --tooth"));
}

std::vector<Problem> missing_tissues(const Scenario& s, const Tooth& tooth) {
  std::vector<std::string> known;
  for (const auto& t : tooth.tissues) known.push_back(t.name);
  std::vector<Problem> problems;
  const auto need = [&](const std::string& name, const std::string& place) {
    if (std::find(known.begin(), known.end(), name) == known.end())
      problems.push_back(problem_at(s, place, msg("this tooth has no tissue '{}'", name),
                                    suggestion(name, known), Mistake::unknown_tissue));
  };
  for (const auto& [key, list] : {std::pair("perforation/aims/", &s.perforation.aims),
                                  std::pair("perforation/faults/", &s.perforation.faults)})
    for (std::size_t i = 0; i < list->size(); ++i) need((*list)[i], key + std::to_string(i));
  for (const auto& [key, list] : {std::pair("zones/target/", &s.zones.target),
                                  std::pair("zones/protected/", &s.zones.protected_shapes)})
    for (std::size_t i = 0; i < list->size(); ++i) {
      const ShapeSpec& shape = (*list)[i];
      const std::string place = key + std::to_string(i);
      if (field_of<TissueField>(shape) != nullptr) need(shape.tissue, place + "/tissue");
      if (shape.outline.kind == OutlineSpec::Kind::projection)
        need(shape.outline.tissue, place + "/outline");
      if (shape.bottom.kind == BottomSpec::Kind::tissue_roof ||
          shape.bottom.kind == BottomSpec::Kind::tissue_floor)
        need(shape.bottom.tissue, place + "/bottom");
      if (shape.bottom.kind == BottomSpec::Kind::below_border) need("enamel", place + "/bottom");
    }
  for (std::size_t i = 0; i < s.rubric.criteria.size(); ++i) {
    const auto measure = find_measure(s.rubric.criteria[i].metric);
    if (measure && !measure->tissue.empty())
      need(measure->tissue, fmt::format("rubric/criteria/{}/metric", i));
  }
  return problems;
}

void require_tissues(const Scenario& scenario, const Tooth& tooth) {
  require_none(missing_tissues(scenario, tooth));
}

Problem problem_at(const Scenario& s, const std::string& place, const Message& what,
                   const Message& what_to_do, Mistake mistake) {
  // the place itself, else what holds it
  for (std::string key = place;; key.erase(key.rfind('/'))) {
    const auto at = s.places.find(key);
    if (at != s.places.end())
      return {{s.path, at->second.line, at->second.column}, what, what_to_do, false, mistake};
    if (key.rfind('/') == std::string::npos) return {{s.path}, what, what_to_do, false, mistake};
  }
}

}  // namespace cavum::scenarios
