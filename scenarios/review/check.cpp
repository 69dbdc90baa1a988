#include "scenarios/review/check.h"

#include <fmt/core.h>

#include <algorithm>
#include <charconv>
#include <filesystem>

#include "engine/base/error.h"
#include "engine/base/file.h"
#include "scenarios/exam/exam.h"
#include "scenarios/file/checked_toml.h"
#include "scenarios/file/surface_files.h"
#include "scenarios/review/advice.h"

namespace cavum::scenarios {
namespace {

/// An Error as a problem at `place`; where it names a line of the scenario itself, at that.
Problem problem_of(const Error& e, const Scenario& s, const std::string& place) {
  Problem p = problem_at(s, place, e.problem(), e.advice());
  p.mistake = e.code().as<Mistake>().value_or(p.mistake);
  if (const FileLocation* at = e.file_place(); at != nullptr && at->file == s.path && at->line > 0)
    p.where = *at;
  return p;
}

/// Burs of the tray; those that do not exist are problems.
std::vector<Bur> read_burs(const Scenario& s, std::vector<Problem>& problems) {
  std::vector<Bur> burs;
  for (std::size_t i = 0; i < s.burs.size(); ++i) {
    const std::string place = fmt::format("burs/{}", i);
    try {
      const std::string file = find_data_file("burs", s.burs[i] + ".toml", s.path);
      try {
        burs.push_back(parse_bur(read_text_file(file), file));
      } catch (const Error& e) {
        problems.push_back(problem_at(s, place, msg("its file is wrong ({})", e.message()),
                                      msg("mend that file, or use another bur")));
      }
    } catch (const Error&) {
      const auto known = data_names("burs", s.path);
      problems.push_back(problem_at(
          s, place, msg("there is no bur '{}'", s.burs[i]),
          known.empty() ? msg("set CAVUM_DATA to the data folder") : suggestion(s.burs[i], known),
          Mistake::unknown_bur));
    }
  }
  return burs;
}

/// Another tooth than the scenario's own. Throws Error when it cannot be read.
Tooth other_tooth(const Scenario& s, const std::string& tooth_file,
                  std::vector<Problem>& problems) {
  Tooth tooth = load_tooth_file(tooth_file);
  const auto name_of = [](const std::string& file) {
    return std::filesystem::path(file).filename().string();
  };
  if (!s.tooth_file.empty() && name_of(tooth_file) != name_of(s.tooth_file)) {
    problems.push_back(problem_at(s, "tooth",
                                  msg("the scenario was written for {}, and is checked on {}",
                                      name_of(s.tooth_file), name_of(tooth_file)),
                                  msg("see where its zones lie: `cavum scenario show --tooth`"),
                                  Mistake::contradictory));
    problems.back().warning = true;
  }
  return tooth;
}

/// The scenario's own; none, and a problem, when it cannot be read.
std::optional<Tooth> own_tooth_of(const Scenario& s, std::vector<Problem>& problems) {
  if (s.tooth_file.empty()) return std::nullopt;
  try {
    const std::string found = find_tooth_file(s);
    try {
      return load_tooth_file(found);
    } catch (const Error& e) {
      problems.push_back(problem_at(s, "tooth", msg("the tooth cannot be read ({})", e.message()),
                                    msg("name another, or make it again")));
    }
  } catch (const Error& e) {
    problems.push_back(problem_of(e, s, "tooth"));
  }
  return std::nullopt;
}

ZoneMap lay(const Scenario& s, const Tooth& tooth) { return build_zones(s, tooth); }

/// `tooth_of(scenario, problems)` gives the tooth, if there is one; `zones_of(scenario, tooth)`
/// lays the zones into it.
template <class ToothOf, class ZonesOf>
CheckedScenario check_with(const std::string& text, const std::string& path,
                           const ToothOf& tooth_of, const ZonesOf& zones_of) {
  ReadScenario read = read_scenario(text, path);
  CheckedScenario checked{.problems = std::move(read.problems), .expert = {}};
  std::vector<Problem>& problems = checked.problems;
  SurfaceFiles files;
  for (auto& p : read_surfaces(read.scenario, files)) problems.push_back(std::move(p));
  const Scenario& s = read.scenario;
  const bool names_sound = checked.sound();
  const auto burs = names_sound || !s.burs.empty() ? read_burs(s, problems) : std::vector<Bur>();
  std::optional<Tooth> tooth = tooth_of(s, problems);
  if (tooth) {
    for (auto& p : missing_tissues(s, *tooth)) problems.push_back(std::move(p));
    if (checked.sound()) {
      try {
        ZoneMap zones = zones_of(s, *tooth);
        for (auto& p : advise(s, *tooth, zones, burs, checked.expert))
          problems.push_back(std::move(p));
        if (checked.sound())
          checked.laid = std::make_shared<const LaidScenario>(
              LaidScenario{s, std::move(*tooth), std::move(zones)});
      } catch (const Error& e) {
        problems.push_back(problem_of(e, s, "zones"));
      }
    }
  }
  sort_problems(problems);
  problems.erase(std::unique(problems.begin(), problems.end(),
                             [](const Problem& a, const Problem& b) { return a == b; }),
                 problems.end());
  return checked;
}

}  // namespace

bool CheckedScenario::sound() const {
  return std::all_of(problems.begin(), problems.end(), [](const Problem& p) { return p.warning; });
}

void sort_problems(std::vector<Problem>& problems) {
  std::stable_sort(problems.begin(), problems.end(), [](const Problem& a, const Problem& b) {
    return a.where.line != b.where.line ? a.where.line < b.where.line
                                        : a.where.column < b.where.column;
  });
}

CheckedScenario check_whole(const std::string& text, const std::string& path,
                            const std::string& tooth_file) {
  const auto tooth_of = [&](const Scenario& s,
                            std::vector<Problem>& problems) -> std::optional<Tooth> {
    return tooth_file.empty() ? own_tooth_of(s, problems) : other_tooth(s, tooth_file, problems);
  };
  return check_with(text, path, tooth_of, lay);
}

CheckedScenario check_whole_on(const Tooth& tooth, const std::string& text,
                               const std::string& path) {
  return check_with(
      text, path,
      [&](const Scenario&, std::vector<Problem>&) { return std::optional<Tooth>(tooth); }, lay);
}

CheckedScenario check_whole_in(const LaidScenario& laid, const std::string& text,
                               const std::string& path) {
  return check_with(
      text, path,
      [&](const Scenario&, std::vector<Problem>&) { return std::optional<Tooth>(laid.tooth); },
      [&](const Scenario&, const Tooth&) { return laid.zones; });
}

}  // namespace cavum::scenarios
