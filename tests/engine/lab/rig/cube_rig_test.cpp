#include "engine/lab/rig/cube_rig.h"

#include <gtest/gtest.h>

#include <cmath>
#include <nlohmann/json.hpp>
#include <sstream>

#include "tests/engine/support/engine_testing.h"

namespace cavum {
namespace {

using namespace testing_engine;

/// Quick to settle: τ = 0.4 s, and c = g √k with a branch that settles as fast.
CubeModel quick(const std::string& name, double damping_ratio) {
  return {name, hard_model(1.0, damping_ratio, 0.4)};
}

CubeOptions small() {
  CubeOptions o;
  o.k_n_per_mm = {0.0, 0.4, 1.2};
  o.runs = 2;
  return o;
}

TEST(CubeRig, ForceIsKVTauPlusCVAndFrictionIsAnIntercept) {
  const CubeResult r = run_cube_rig({quick("damped", 0.3), quick("undamped", 0.0)},
                                    shipped_bur("round-1.0"), small());
  for (const CubeSet& set : r.sets) {
    for (const CubeRow& row : set.rows) {
      ASSERT_EQ(row.left_out, 0);
      EXPECT_NEAR(row.expected_n,
                  0.25 * (row.k_n_per_mm * 0.4 + set.damping_ratio * std::sqrt(row.k_n_per_mm)),
                  1e-12);
      EXPECT_NEAR(row.without.mean, row.expected_n, 0.03 + 0.02 * row.expected_n)
          << set.name << " k " << row.k_n_per_mm;
      EXPECT_NEAR(row.with.mean - row.without.mean, 0.26 + 0.25e-4, 1e-9);
    }
    EXPECT_NEAR(set.with.line.value[1] - set.without.line.value[1], 0.26 + 0.25e-4, 1e-9);
    EXPECT_NEAR(set.with.line.value[0], set.without.line.value[0], 1e-9);
    EXPECT_NEAR(set.with.with_root.value[2], 0.25 * set.damping_ratio, 0.04)
        << "c V is the root term";
  }
}

TEST(CubeRig, SameSeedSameFiguresAnotherSeedOthers) {
  CubeOptions o = small();
  o.k_n_per_mm = {0.4, 0.8};
  const auto run = [&](std::uint64_t seed) {
    o.seed = seed;
    return to_json(run_cube_rig({quick("damped", 0.3)}, shipped_bur("round-1.0"), o)).dump();
  };
  const std::string first = run(1);
  EXPECT_EQ(first, run(1));
  EXPECT_NE(first, run(2));
}

TEST(CubeRig, RecordingsReadAsExplainWantsThem) {
  CubeOptions o = small();
  o.k_n_per_mm = {0.4, 0.8};
  o.recorded_k_n_per_mm = 0.8;
  const CubeResult r = run_cube_rig({quick("damped", 0.3)}, shipped_bur("round-1.0"), o);
  std::istringstream csv(recordings_csv(r));
  std::string line;
  std::getline(csv, line);
  EXPECT_EQ(line, "session,t_s,x_mm,f_n,v_mm_s,spindle_rpm,removed_mm3");
  int rows = 0, sessions = 0;
  std::string session;
  double last_t = 0, last_x = 0;
  while (std::getline(csv, line)) {
    std::istringstream fields(line);
    std::string name, t, x;
    std::getline(fields, name, ',');
    std::getline(fields, t, ',');
    std::getline(fields, x, ',');
    if (name != session) {
      ++sessions;
      session = name;
      EXPECT_LT(std::stod(x), -0.2) << "begins in air";
    } else {
      EXPECT_NEAR(std::stod(t) - last_t, 0.01, 1e-9);
    }
    last_t = std::stod(t);
    last_x = std::stod(x);
    ++rows;
  }
  EXPECT_EQ(sessions, 2);
  EXPECT_GT(rows, 2 * 300);
  EXPECT_NEAR(last_x, 0.1, 0.05);
  const toml::table rig = parse_toml(recordings_rig_toml(r), "rig.toml");
  EXPECT_EQ(rig["k_n_per_mm"].value<double>(), 0.8);
  EXPECT_NEAR(*rig["c_n_s_per_mm"].value<double>(), 0.3 * std::sqrt(0.8), 1e-12);
  EXPECT_EQ(rig["position_quantum_mm"].value<double>(), 0.055);
}

TEST(CubeRig, ReadingSpeaksOfABendOnlyWhereThereIsOne) {
  CubeOptions o = small();
  o.k_n_per_mm = {0.0, 0.2, 0.6, 1.2};
  const Bur bur = shipped_bur("round-1.0");
  const CubeResult bent = run_cube_rig({quick("damped", 2.0)}, bur, o),
                   straight = run_cube_rig({quick("undamped", 0.0)}, bur, o);
  EXPECT_TRUE(is_bent(bent.sets[0]));
  EXPECT_FALSE(is_bent(straight.sets[0]));
  EXPECT_EQ(cube_reading(bent).size(), cube_reading(straight).size() + 1)
      << "a bend speaks against the force of c V";
  EXPECT_FALSE(to_text(bent).empty());
  o.k_n_per_mm = {0.4};
  EXPECT_EQ(cube_reading(run_cube_rig({quick("one", 0.0)}, bur, o)).size(), 1u)
      << "nothing can be said";
}

}  // namespace
}  // namespace cavum
