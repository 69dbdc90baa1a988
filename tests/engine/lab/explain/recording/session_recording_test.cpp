#include "engine/lab/explain/recording/session_recording.h"

#include <gtest/gtest.h>

#include <cmath>

#include "engine/base/file.h"
#include "engine/base/random.h"
#include "engine/lab/explain/inference/explain.h"
#include "engine/physics/force/force_model.h"
#include "tests/engine/session/fixture.h"
#include "tests/engine/support/basics.h"

namespace cavum::explain {
namespace {

constexpr std::int64_t k_ticks = 9000;

/// What a load cell would read: the law of the tissue touched, friction of 0.2 N along the normal,
/// and noise.
double measured_n(const Simulation& s, const TickOutput& out, Random& random) {
  const auto& of = s.state.touched.means.of;
  const double law = voigt_force_n({of.stiffness_n_per_mm, of.damping_n_s_per_mm},
                                   out.penetration_mm, out.approach_mm_s);
  return law + 0.2 * std::tanh(out.approach_mm_s / 0.3) + 0.02 * random.normal();
}

/// A session of k_ticks ticks, and the force that was measured meanwhile, every fifth tick: in the
/// session, and as a CSV.
std::string make_session(const std::string& path, bool with_force) {
  const SessionSetup setup = test::block_setup();
  Simulation simulation = make_simulation(setup, "test");
  Recorder recorder = Recorder::create(path, setup);
  Random random(3);
  MeasuredForce measured{5, {}};
  std::string csv = "t_s,f_n\n";
  for (std::int64_t tick = 0; tick < k_ticks; ++tick) {
    const TickInput input = test::motion_at(tick);
    const TickOutput out = step(simulation.model, simulation.state, input);
    if (tick % 5 == 0) {
      measured.f_n.push_back(measured_n(simulation, out, random));
      csv += std::to_string(0.001 * static_cast<double>(tick)) + "," +
             std::to_string(measured.f_n.back()) + "\n";
    }
    if (with_force && tick % 1000 == 999) {
      recorder.add_event(tick - 999, measured);
      measured.f_n.clear();
    }
    recorder.append(input, make_tick_record(out), simulation.state.removed,
                    state_hash(simulation.state));
  }
  recorder.close(save_tooth(drilled_tooth(simulation)), "{}");
  return csv;
}

Message first_note(const Recording& r) {
  return r.notes.empty() ? Message() : r.notes.front().what();
}

TEST(SessionRecording, AMeasuredForceIsReadFromTheSessionAndItsFrictionIsNamed) {
  const test::Folder folder;
  const std::string path = folder.file("measured.cavum");
  const std::string csv = make_session(path, true);
  const Recording r = read_session_recording(path);
  EXPECT_TRUE(testing_basics::figures_in(first_note(r)).empty())
      << "a measured force, not that of its law";
  EXPECT_GT(r.rows(), 600);
  EXPECT_LE(r.relative_k.maxCoeff(), 1.0 + 1e-12);
  EXPECT_LT(r.relative_k.minCoeff(), 0.9) << "the pulp resists nothing, and the motion reaches it";
  const Explanation e = explain(r);
  ASSERT_FALSE(e.causes.empty()) << english_text(to_text(e));
  EXPECT_EQ(std::string(mechanism_at(e.causes.front().term.mechanism).name), "coulomb_friction")
      << english_text(to_text(e));
  EXPECT_NEAR(e.causes.front().parameters.at(0).second.value, 0.2, 0.03);
  EXPECT_NEAR(e.base.k_n_per_mm, 0.8, 0.06);
}

TEST(SessionRecording, AForceBesideTheSessionCountsInsteadOfItsLaw) {
  const test::Folder folder;
  const std::string path = folder.file("plain.cavum"), force = folder.file("force.csv");
  write_text_file(force, make_session(path, false));
  const Recording own = read_session_recording(path),
                  measured = read_session_recording(path, force);
  EXPECT_EQ(testing_basics::figures_in(first_note(own)).size(), 1u)
      << "its own law, and what was rendered otherwise";
  EXPECT_NE(english_text(first_note(measured)).find(force), std::string::npos);
  ASSERT_EQ(own.rows(), measured.rows());
  EXPECT_EQ((own.x_mm - measured.x_mm).abs().maxCoeff(), 0.0);
  EXPECT_GT((own.f_n - measured.f_n).abs().maxCoeff(), 0.05);
}

TEST(SessionRecording, TheFrictionOfTheSessionsOwnLawIsNamed) {
  const test::Folder folder;
  const std::string path = folder.file("friction.cavum");
  SessionSetup setup = test::block_setup();
  setup.force_model_toml +=
      "\n[[terms]]\nkind = \"coulomb_friction\"\nfc_n = 0.03\nv0_mm_s = 0.5\n";
  Simulation simulation = make_simulation(setup, "test");
  Recorder recorder = Recorder::create(path, setup);
  for (std::int64_t tick = 0; tick < k_ticks; ++tick) {
    const TickInput input = test::motion_at(tick);
    const TickOutput out = step(simulation.model, simulation.state, input);
    recorder.append(input, make_tick_record(out), simulation.state.removed,
                    state_hash(simulation.state));
  }
  recorder.close(save_tooth(drilled_tooth(simulation)), "{}");
  const Explanation e = explain(read_session_recording(path));
  ASSERT_FALSE(e.causes.empty()) << english_text(to_text(e));
  EXPECT_EQ(std::string(mechanism_at(e.causes.front().term.mechanism).name), "coulomb_friction")
      << english_text(to_text(e));
  EXPECT_NEAR(e.causes.front().parameters.at(0).second.value, 0.03, 0.003);
}

TEST(SessionRecording, XAndVAreThoseOfTheReplay) {
  const test::Folder folder;
  const std::string path = folder.file("x.cavum");
  static_cast<void>(make_session(path, false));
  const Recording r = read_session_recording(path);
  Simulation simulation = make_simulation(test::block_setup(), "test");
  Eigen::Index row = 0;
  for (std::int64_t tick = 0; tick < k_ticks && row < r.rows(); ++tick) {
    const TickOutput out = step(simulation.model, simulation.state, test::motion_at(tick));
    if (std::fabs(r.t_s[row] - 0.001 * static_cast<double>(tick)) > 1e-9) continue;
    ASSERT_EQ(r.x_mm[row], out.penetration_mm);
    ASSERT_EQ(r.v_mm_s[row], out.approach_mm_s);
    ASSERT_EQ(r.f_n[row], out.model_force_n);
    ++row;
  }
  EXPECT_EQ(row, r.rows());
}

TEST(SessionRecording, AForceMeasuredTwiceIsAnError) {
  const test::Folder folder;
  const std::string path = folder.file("bad.cavum");
  const SessionSetup setup = test::block_setup();
  Simulation simulation = make_simulation(setup, "test");
  Recorder recorder = Recorder::create(path, setup);
  for (int i = 0; i < 2; ++i) recorder.add_event(0, MeasuredForce{1, {0.5}});
  test::drill(simulation, recorder, 0, 1500);
  recorder.close(save_tooth(drilled_tooth(simulation)), "{}");
  EXPECT_THROW(static_cast<void>(read_session_recording(path)), Error);
}

}  // namespace
}  // namespace cavum::explain
