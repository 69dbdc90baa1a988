// Simulated novices, each of whose lessons is obeyed: the tooth as it would be had he not made that mistake is cut anew by geometry alone and marked.
// Points must rise, and the mistakes named first must be those that cost most. Two novices every day; with CAVUM_DEEP two hundred.
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdlib>
#include <iostream>
#include <map>

#include "engine/base/file.h"
#include "engine/base/random.h"
#include "engine/session/session_reader.h"
#include "engine/tooth/make/make_molar.h"
#include "engine/tooth/make/make_premolar.h"
#include "engine/tooth/make/tooth_shapes.h"
#include "engine/tooth/octree_edit.h"
#include "grading/grade.h"
#include "grading/words/lessons.h"
#include "scenarios/candidates/simulated_exam.h"
#include "tests/engine/support/basics.h"

namespace cavum::grading {
namespace {

/// An exam that a simulated novice sat on a tooth in leaves of 0.1 mm.
struct Sat {
  std::unique_ptr<scenarios::ExamSetup> setup;
  std::vector<TickInput> inputs;
  std::vector<TickRecord> records;
  std::vector<RemovedAt> removed;
  std::vector<SessionEvent> events;
  Tooth after;
  [[nodiscard]] GradeInput input() const { return {setup->scenario, setup->tooth, setup->zones, after.octree, inputs, records, removed, events}; }
};

class LessonsOfNovices : public ::testing::Test {
 protected:
  void SetUp() override {
    ::setenv("CAVUM_HOME", folder_.file("home").c_str(), 1);
    MolarShape molar;
    PremolarShape premolar;
    molar.leaf_mm = premolar.leaf_mm = 0.1;
    write_file(folder_.file("molar.cvt"), save_tooth(make_molar(molar)));
    write_file(folder_.file("premolar.cvt"), save_tooth(make_premolar(premolar)));
  }
  [[nodiscard]] Sat sat(const std::string& task, const std::string& tooth, std::uint64_t seed) const {
    scenarios::ExamOptions options;
    options.candidate = "simulated";
    options.device = "simulated Omni";
    options.tooth_file = folder_.file(tooth);
    Sat s;
    s.setup = scenarios::prepare_exam(testing_basics::data_path("scenarios/" + task + ".toml"), options);
    const std::string file = folder_.file(task + std::to_string(seed) + ".cavum");
    scenarios::SimulatedCandidate novice = scenarios::make_simulated_candidate(*s.setup, "novice", seed, OmniModel{});
    const auto exam = scenarios::Exam::start(*s.setup, file, novice.start_mm());
    scenarios::run_exam(*exam, novice);
    exam->recorder().flush();
    const SessionReader reader(file);
    s.inputs = reader.inputs();
    s.records = reader.records();
    s.removed = reader.removed();
    s.events = reader.events();
    s.after = exam->tooth_now();
    return s;
  }
  testing_basics::Folder folder_;
};

bool is_cut(Topic t) {
  return t == Topic::left_standing || t == Topic::roof || t == Topic::canals || t == Topic::beside || t == Topic::too_deep || t == Topic::elsewhere;
}

/// Points of the same exam without the mistake: its cavity filled up to the target where it went too far, or cut on to the target.
double points_without(const Sat& s, Topic mistake) {
  const scenarios::ZoneMap& zones = s.setup->zones;
  const Octree &was = s.after.octree, &before = s.setup->tooth.octree;
  Octree::Cursor cursor;
  const auto cut = [&](Vec3 p) {
    const double open = was.sample(p, cursor).distance_mm, target = zones.distance_mm(p);
    const double cavity = open > 0 && was.tissue_at(p, cursor) != k_air ? open : -open;  // pulp that is still there is void, and was not cut
    const IVec3 leaf = before.leaf_at(p);
    const bool floor = zones.wall(leaf) == scenarios::Wall::floor;
    const scenarios::Zone zone = zones.zone(leaf);
    switch (mistake) {
      case Topic::beside:
        return floor ? cavity : std::max(cavity, target);
      case Topic::too_deep:
        return floor ? std::max(cavity, target) : cavity;
      case Topic::elsewhere:
        return zone == scenarios::Zone::none || zone == scenarios::Zone::protected_ ? 1.0 : cavity;
      case Topic::left_standing:
      case Topic::roof:
      case Topic::canals:
        return std::min(cavity, target);
      default:  // as it is
        return cavity;
    }
  };
  Octree after = before;
  after.reserve_edits(60'000);
  std::vector<RemovedLeaf> leaves;
  leaves.reserve(4'000'000);
  const Vec3 around{4, 4, 4};
  EXPECT_TRUE(after.carve(zones.target_low_mm() - around, zones.target_high_mm() + around, cut, leaves));
  std::vector<RemovedAt> removed;
  const auto last = static_cast<std::int64_t>(s.records.size()) - 1;
  for (const auto& l : leaves) removed.push_back({last, l});
  return grade({s.setup->scenario, s.setup->tooth, zones, after, s.inputs, s.records, removed, s.events}, s.setup->scenario.rubric).points;
}

TEST_F(LessonsOfNovices, WhoObeysWinsPoints) {
  const bool deep = std::getenv("CAVUM_DEEP") != nullptr;
  Random random(testing_basics::drawn_seed("LessonsOfNovices.WhoObeysWinsPoints"));
  const std::pair<const char*, const char*> tasks[] = {{"class_1", "molar.cvt"}, {"premolar_access", "premolar.cvt"}};
  int obeyed = 0, won = 0, first_is_dearest = 0, novices = 0;
  for (int i = 0; i < (deep ? 200 : 2); ++i) {
    const auto [task, tooth] = tasks[i % 2];
    const Sat s = sat(task, tooth, random.below(1'000'000));
    const Result r = grade(s.input(), s.setup->scenario.rubric);
    // the same cavity cut anew by its own surface is what gains are counted from
    const double points = points_without(s, Topic::time);
    std::map<Topic, double> gain;
    const auto said = lessons(s.input(), r);
    for (const auto& l : said)
      if (is_cut(l.topic) && gain.size() < 3) gain[l.topic] = points_without(s, l.topic) - points;
    for (const auto& [topic, g] : gain) {
      ++obeyed;
      won += g > 0;
      std::cout << task << ' ' << topic_name(topic) << ": wins " << g << " points\n";
    }
    const auto dearest = std::max_element(gain.begin(), gain.end(), [](const auto& a, const auto& b) { return a.second < b.second; });
    const auto first = std::find_if(said.begin(), said.end(), [](const Lesson& l) { return is_cut(l.topic); });
    if (gain.empty()) continue;
    ++novices;
    first_is_dearest += first->topic == dearest->first || first->fails_exam || gain.at(first->topic) > dearest->second - 1;
  }
  std::cout << won << " of " << obeyed << " lessons obeyed win points; the first is the dearest of " << first_is_dearest << " of " << novices
            << " novices\n";
  EXPECT_GE(won, (9 * obeyed) / 10);
  EXPECT_GT(obeyed, 0);
  if (deep) {
    EXPECT_GE(first_is_dearest, (9 * novices) / 10);
  }
}

}  // namespace
}  // namespace cavum::grading
