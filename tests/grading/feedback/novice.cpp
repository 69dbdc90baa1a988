#include "tests/grading/feedback/novice.h"

#include <algorithm>
#include <cmath>

#include "engine/base/file.h"
#include "engine/base/pose.h"
#include "engine/session/session_reader.h"
#include "scenarios/operators/simulated_exam.h"
#include "tests/engine/support/basics.h"

namespace cavum::testing {
namespace {

using grading::Lesson;
using grading::Topic;
using scenarios::Waypoint;

bool told(const std::vector<Lesson>& heard, std::initializer_list<Topic> of) {
  return std::any_of(heard.begin(), heard.end(), [&](const Lesson& l) {
    return std::find(of.begin(), of.end(), l.topic) != of.end();
  });
}

/// Whether the head at `p` stays within what an expert's bur may reach.
bool fits(const scenarios::ReachMap& map, Vec3 p) {
  const Vec3 l = map.tool.transposed(p);
  const int x = static_cast<int>(std::lround((l.x - map.origin_mm.x) / map.step_mm)),
            y = static_cast<int>(std::lround((l.y - map.origin_mm.y) / map.step_mm));
  return x >= 0 && y >= 0 && x < map.nx && y < map.ny &&
         map.lowest_mm[map.index(x, y)] <= l.z + 0.5 * map.step_mm;
}

/// The expert's way with what is wrong with the beginner's.
class Way {
 public:
  Way(const NoviceTask& task, const Beginner& who, const std::vector<Lesson>& heard)
      : task_(task), who_(who), received_(heard) {}

  [[nodiscard]] std::vector<Waypoint> planned() const {
    scenarios::ChosenBur own = task_.chosen;
    own.map = scenarios::middle_of(own.map, who_.middle_percent);
    std::vector<Waypoint> way = erring(plan(own));
    // what he is told of as left, he takes away once more before he hands in: all of it, and
    // nothing but the target
    if (told(received_, {Topic::left_standing, Topic::roof, Topic::canals})) {
      const auto again = plan(task_.chosen);
      way.insert(way.end(), again.begin(), again.end());
    }
    if (who_.perforates && !told(received_, {Topic::opened, Topic::too_deep})) pierce(way);
    return way;
  }

 private:
  [[nodiscard]] std::vector<Waypoint> plan(const scenarios::ChosenBur& chosen) const {
    return plan_work(chosen, task_.setup->tooth, task_.tray,
                     task_.setup->scenario.perforation.aims);
  }
  /// Shifted, too deep or short, unless he was told.
  [[nodiscard]] std::vector<Waypoint> erring(std::vector<Waypoint> way) const {
    const Vec3 up = task_.setup->zones.approach();
    double top = -1e9, bottom = 1e9;
    for (const auto& w : way) {
      top = std::max(top, dot(w.tip_mm, up));
      bottom = std::min(bottom, dot(w.tip_mm, up));
    }
    const Vec3 shift =
        up.z >= 0.5 ? who_.shift_mm : rotation(rotation_between({0, 0, 1}, up)) * who_.shift_mm;
    const bool stops_at_outline =
                   told(received_, {Topic::beside, Topic::elsewhere, Topic::neighbour}),
               measures_depth = told(received_, {Topic::too_deep, Topic::opened});
    for (auto& w : way) {
      if (!w.cut) continue;
      const Vec3 right = w.tip_mm;
      w.tip_mm +=
          up * std::max(0.0, bottom + who_.short_share * (top - bottom) - dot(w.tip_mm, up));
      if (dot(right, up) < bottom + 1.0)
        w.tip_mm += up * -(measures_depth ? std::min(0.0, who_.shift_down_mm) : who_.shift_down_mm);
      double part = 1.0;
      while (
          stops_at_outline && part > 0 &&
          !fits(task_.chosen.map, w.tip_mm + shift * part + up * std::max(0.0, who_.shift_down_mm)))
        part -= 0.125;
      w.tip_mm += shift * std::max(0.0, part);
      if (measures_depth && dot(right, up) < bottom + 0.5) w.careful = true;
    }
    return way;
  }
  void pierce(std::vector<Waypoint>& way) const {
    for (const auto& fault : task_.setup->scenario.perforation.faults) {
      const auto& tissues = task_.setup->tooth.tissues;
      if (std::none_of(tissues.begin(), tissues.end(),
                       [&](const auto& t) { return t.name == fault; }))
        continue;
      auto deeper = plan_perforation(task_.setup->zones, task_.setup->tooth, task_.chosen.map,
                                     task_.setup->tooth.tissue_id(fault));
      if (deeper.empty()) continue;
      for (auto& w : deeper) w.bur = static_cast<std::uint8_t>(task_.chosen.index);
      way.insert(way.end(), deeper.begin(), deeper.end());
      return;
    }
  }
  const NoviceTask& task_;
  const Beginner& who_;
  const std::vector<Lesson>& received_;
};

/// A hand that does what it was told: lighter, steadier.
scenarios::Skill hand_of(const Beginner& who, const std::vector<Lesson>& heard) {
  scenarios::Skill s = who.skill;
  s.offset_mm = {};
  s.stops_short = 0;
  if (told(heard, {Topic::force})) s.press_n *= 0.7;
  if (told(heard, {Topic::too_deep, Topic::opened}))
    s.careful_press_n = std::min(s.careful_press_n, 0.5);
  if (told(heard, {Topic::beside, Topic::too_deep, Topic::taper, Topic::elsewhere}))
    s.tremor_mm *= 0.5;
  if (told(heard, {Topic::time})) s.reaction_s *= 0.6;
  return s;
}

}  // namespace

NoviceTask novice_task(const std::string& scenario, const std::string& tooth_file) {
  scenarios::ExamOptions options;
  options.candidate = "simulated";
  options.tooth_file = tooth_file;
  NoviceTask t;
  t.setup = scenarios::prepare_exam(testing_basics::data_path("scenarios/" + scenario + ".toml"),
                                    options);
  for (const auto& p : t.setup->burs) t.tray.push_back(make_contact_tool(p));
  t.chosen = scenarios::choose_bur(t.setup->zones, t.setup->tooth, t.tray);
  return t;
}

const std::vector<std::string>& beginner_kinds() {
  static const std::vector<std::string> k_kinds{"leaner", "student", "deep",
                                                "wide",   "timid",   "piercer"};
  return k_kinds;
}

Beginner beginner(const std::string& kind, std::uint64_t seed) {
  Random r(seed);
  Beginner b;
  b.kind = kind;
  b.seed = r.next();
  const auto around = [&](double mm) {
    const double a = r.uniform(0.0, 6.2832);
    return Vec3{mm * std::cos(a), mm * std::sin(a), 0};
  };
  b.skill = scenarios::make_skill(
      kind == "student" ? "student-" + std::to_string(r.below(61)) : "novice", b.seed);
  b.shift_mm = around(r.uniform(0.0, 0.25));
  b.shift_down_mm = r.uniform(-0.15, 0.15);
  if (kind == "leaner" || kind == "student") {
    b.shift_mm = b.skill.offset_mm;
    b.short_share = b.skill.stops_short;
    b.perforates = b.skill.perforates;
  } else if (kind == "deep") {
    b.shift_down_mm = r.uniform(0.3, 0.8);
  } else if (kind == "wide") {
    b.shift_mm = around(r.uniform(0.4, 1.0));
  } else if (kind == "timid") {
    b.middle_percent = r.uniform(55, 85);
    b.short_share = r.uniform(0.0, 0.25);
  } else {
    b.perforates = true;
  }
  return b;
}

Sat sit(const NoviceTask& task, const Beginner& who, const std::vector<Lesson>& heard,
        const std::string& file) {
  scenarios::SimulatedCandidate candidate(
      {scenarios::Operator(hand_of(who, heard), Way(task, who, heard).planned(),
                           task.setup->zones.approach(), who.seed),
       static_cast<std::uint8_t>(task.chosen.index)},
      OmniModel{});
  Sat s;
  {
    const auto exam = scenarios::Exam::start(*task.setup, file, candidate.start_mm());
    scenarios::run_exam(*exam, candidate);
    exam->recorder().flush();
    const SessionReader reader(file);
    s.inputs = reader.inputs();
    s.records = reader.records();
    s.removed = reader.removed();
    s.events = reader.events();
    s.after = exam->tooth_now();
  }
  for (const char* end : {"", "-wal", "-shm"}) std::filesystem::remove(file + end);
  return s;
}

}  // namespace cavum::testing
