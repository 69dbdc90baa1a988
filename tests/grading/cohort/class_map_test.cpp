#include "grading/cohort/class_map.h"

#include <gtest/gtest.h>

#include <array>
#include <map>
#include <random>
#include <set>

#include "engine/session/session_reader.h"
#include "scenarios/file/parse.h"
#include "tests/engine/support/basics.h"
#include "tests/grading/records/school.h"

namespace cavum::cohort {
namespace {

using testing_ledger::School;

struct Block {
  std::unique_ptr<scenarios::ExamSetup> setup =
      scenarios::prepare_exam(testing_ledger::k_scenario, {});
  Tooth tooth = load_tooth(setup->session.tooth, "block");
  scenarios::ZoneMap zones = scenarios::build_zones(setup->scenario, tooth);
};

/// Any leaf of a zone.
IVec3 leaf_of(const scenarios::ZoneMap& zones, scenarios::Zone wanted) {
  IVec3 found{-1, -1, -1};
  zones.for_each_leaf([&](IVec3 leaf, scenarios::Zone zone) {
    if (zone == wanted && found.x < 0) found = leaf;
  });
  EXPECT_GE(found.x, 0) << scenarios::zone_name(wanted);
  return found;
}

TEST(ClassMap, CountsWhoRemovedWhatShouldStayAndLeftWhatShouldGo) {
  const Block b;
  const IVec3 target = leaf_of(b.zones, scenarios::Zone::target),
              leeway = leaf_of(b.zones, scenarios::Zone::leeway_sides),
              damage = leaf_of(b.zones, scenarios::Zone::container_sides);
  const IVec3 far = b.zones.low() + b.zones.size() + IVec3{7, 3, 1};
  ClassMap map(b.zones);
  map.add({target, leeway, damage});
  map.add({target, damage});
  map.add({target, far});
  map.add({});
  EXPECT_EQ(map.sessions(), 4u);
  EXPECT_EQ(map.percent(target), -25.0) << "one of four left it";
  EXPECT_EQ(map.percent(leeway), 0.0) << "may be removed or left";
  EXPECT_EQ(map.percent(damage), 50.0);
  EXPECT_EQ(map.percent(far), 25.0) << "beyond the box of the zones";
  EXPECT_EQ(map.percent(far + IVec3{1, 0, 0}), 0.0);
}

TEST(ClassMap, TheBoxMayGrowInAnyOrder) {
  const Block b;
  std::mt19937_64 random(testing_basics::drawn_seed("ClassMap"));
  std::map<std::array<int, 3>, int> plain;
  ClassMap map(b.zones);
  constexpr int k_sessions = 20;
  for (int i = 0; i < k_sessions; ++i) {
    std::vector<IVec3> cavity;
    std::set<std::array<int, 3>> once;
    for (int k = 0; k < 50; ++k) {
      const auto along = [&](int low, int size) {
        return low + static_cast<int>(random() % static_cast<unsigned>(size + 20 + i)) - 10 - i / 2;
      };
      const IVec3 leaf{along(b.zones.low().x, b.zones.size().x),
                       along(b.zones.low().y, b.zones.size().y),
                       along(b.zones.low().z, b.zones.size().z)};
      if (!once.insert({leaf.x, leaf.y, leaf.z}).second) continue;
      cavity.push_back(leaf);
      ++plain[{leaf.x, leaf.y, leaf.z}];
    }
    map.add(cavity);
  }
  for (const auto& [at, n] : plain) {
    const IVec3 leaf{at[0], at[1], at[2]};
    const double removed = 100.0 * n / k_sessions;
    const scenarios::Zone zone = b.zones.zone(leaf);
    const double expected =
        zone == scenarios::Zone::target ? removed - 100
        : zone == scenarios::Zone::leeway_sides || zone == scenarios::Zone::leeway_bottom ? 0
                                                                                          : removed;
    ASSERT_NEAR(map.percent(leaf), expected, 1e-9);
  }
}

TEST(ClassMap, AgreesWithTheTeethThatWereLeft) {
  const School school;
  std::vector<std::string> sat;
  for (const char* skill : {"expert", "perforator", "student-20"}) {
    sat.push_back(school.sit(school.ticket(skill), skill));
    records::Ledger ledger = school.ledger();
    ASSERT_TRUE(records::file_session(ledger, sat.back(), {.simulated = true}).seq) << skill;
  }
  const records::LedgerContent content = records::read_ledger(school.places());
  const auto read = class_tooth(records::read_registry(content), school.places(), "block_cavity");
  ASSERT_EQ(read->map->sessions(), 3u);
  EXPECT_TRUE(read->findings.empty());
  EXPECT_EQ(read->left_out, 0u);
  std::vector<Tooth> left;
  for (const auto& path : sat) left.push_back(load_tooth(SessionReader(path).final_tooth(), path));
  std::size_t over = 0, under = 0;
  read->zones.for_each_leaf([&](IVec3 leaf, scenarios::Zone zone) {
    if (read->tooth.octree.tissue(leaf) == k_air || zone == scenarios::Zone::leeway_sides ||
        zone == scenarios::Zone::leeway_bottom)
      return;
    int gone = 0;
    for (const auto& tooth : left) gone += tooth.octree.tissue(leaf) == k_air ? 1 : 0;
    const double removed = 100.0 * gone / 3,
                 expected = zone == scenarios::Zone::target ? removed - 100 : removed;
    ASSERT_NEAR(read->map->percent(leaf), expected, 1e-9);
    over += expected > 0 ? 1 : 0;
    under += expected < 0 ? 1 : 0;
  });
  EXPECT_GT(over, 0u) << "the students leave the target";
  EXPECT_GT(under, 0u) << "and leave some of it standing";

  write_text_file(school.places().session(records::read_registry(content).sessions[1].file_sha256),
                  "changed");
  const auto again = class_tooth(records::read_registry(content), school.places(), "block_cavity");
  EXPECT_EQ(again->map->sessions(), 2u);
  ASSERT_EQ(again->findings.size(), 1u);
  EXPECT_TRUE(testing_basics::tells(
      again->findings[0],
      school.places().session(records::read_registry(content).sessions[1].file_sha256)))
      << again->findings[0];
}

}  // namespace
}  // namespace cavum::cohort
