// A session keeps the force model as text, terms and all: so it replays bit for bit, and resumes.
#include <gtest/gtest.h>

#include "engine/session/resume.h"
#include "engine/session/verify.h"
#include "tests/engine/session/fixture.h"

namespace cavum {
namespace {

using test::Folder;

SessionSetup setup_with_terms(const std::string& fc_n) {
  SessionSetup setup = test::block_setup();
  setup.force_model_toml += "\n[[terms]]\nkind = \"coulomb_friction\"\nfc_n = " + fc_n +
                            "\nv0_mm_s = 0.5\n\n[[terms]]\nkind = \"series_compliance\"\nks_n_per_mm = 4\n\n[[terms]]\nkind = \"run_out\"\n"
                            "eccentricity_um = 20\n";
  return setup;
}

TEST(TermsSession, ReplaysAndResumesWithItsForceTerms) {
  const Folder folder;
  const std::string path = folder.file("terms.cavum");
  const SessionSetup setup = setup_with_terms("0.26");
  std::uint64_t after = 0;
  {
    Simulation simulation = make_simulation(setup, "test");
    ASSERT_EQ(simulation.model.force.terms.size(), 3u);
    Recorder recorder = Recorder::create(path, setup);
    test::drill(simulation, recorder, 0, 2500);
    recorder.flush();
    after = state_hash(simulation.state);
  }
  ResumedSession resumed = resume_session(path);
  EXPECT_EQ(resumed.ticks, 2500);
  EXPECT_EQ(state_hash(resumed.simulation.state), after);
  test::drill(resumed.simulation, resumed.recorder, 2500, 1200);
  resumed.recorder.close(save_tooth(drilled_tooth(resumed.simulation)), "{}");
  const VerifyReport report = verify_session(path);
  EXPECT_TRUE(report.verified) << (report.findings.empty() ? "" : report.findings.front());
  EXPECT_EQ(report.ticks_replayed, 3700);
}

TEST(TermsSession, ReplaysAndResumesWithWhatRemembersAndCounts) {
  const Folder folder;
  const std::string path = folder.file("cutting.cavum");
  SessionSetup setup = test::block_setup();
  for (const char* term : {"hysteresis\"\nalpha_n_per_mm = 0.2\nd_mm = 0.05\ngamma = 0.5", "backlash\"\nb_mm = 0.01", "wear\"\nper_mm3 = 0.5",
                           "chatter\"\namplitude_n = 0.02\nfrequency_hz = 37", "coolant\"\nfraction = -0.1", "thermal_softening\"\nper_k = 0.01",
                           "anisotropy\"\nepsilon = 0.2\nphi0_deg = 20", "run_out\"\namplitude_n = 0.01\nby_clock = 1"})
    setup.force_model_toml += std::string("\n[[terms]]\nkind = \"") + term + "\n";
  std::uint64_t after = 0;
  {
    Simulation simulation = make_simulation(setup, "test");
    ASSERT_EQ(simulation.model.force.terms.size(), 8u);
    Recorder recorder = Recorder::create(path, setup);
    test::drill(simulation, recorder, 0, 2500);
    recorder.flush();
    after = state_hash(simulation.state);
    EXPECT_GT(simulation.state.terms.removed_leaves[0], 0u);
  }
  ResumedSession resumed = resume_session(path);
  EXPECT_EQ(state_hash(resumed.simulation.state), after);
  test::drill(resumed.simulation, resumed.recorder, 2500, 1200);
  resumed.recorder.close(save_tooth(drilled_tooth(resumed.simulation)), "{}");
  const VerifyReport report = verify_session(path);
  EXPECT_TRUE(report.verified) << (report.findings.empty() ? "" : report.findings.front());
}

TEST(TermsSession, OtherFrictionIsAnotherHistory) {
  Simulation a = make_simulation(setup_with_terms("0.26"), "test"), b = make_simulation(setup_with_terms("0.27"), "test");
  for (std::int64_t tick = 0; tick < 200; ++tick) {
    (void)step(a.model, a.state, test::motion_at(tick));
    (void)step(b.model, b.state, test::motion_at(tick));
  }
  EXPECT_NE(state_hash(a.state), state_hash(b.state));
}

}  // namespace
}  // namespace cavum
