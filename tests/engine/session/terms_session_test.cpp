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
  setup.force_model_toml +=
      "\n[[terms]]\nkind = \"coulomb_friction\"\nfc_n = " + fc_n +
      "\nv0_mm_s = 0.5\n\n[[terms]]\nkind = \"series_compliance\"\nks_n_per_mm = 4\n\n[[terms]]\nkind = \"run_out\"\n"
      "eccentricity_um = 20\n";
  return setup;
}

/// Drills, is cut off, goes on from the file alone, and verifies. Returns the state in which it was
/// cut off.
ServoState replays_and_resumes(const SessionSetup& setup, std::size_t terms) {
  const Folder folder;
  const std::string path = folder.file("terms.cavum");
  ServoState cut_off;
  {
    Simulation simulation = make_simulation(setup, "test");
    EXPECT_EQ(simulation.model.force.terms.size(), terms);
    Recorder recorder = Recorder::create(path, setup);
    test::drill(simulation, recorder, 0, 2500);
    recorder.flush();
    cut_off = simulation.state;
  }
  ResumedSession resumed = resume_session(path);
  EXPECT_EQ(resumed.ticks, 2500);
  EXPECT_EQ(state_hash(resumed.simulation.state), state_hash(cut_off));
  test::drill(resumed.simulation, resumed.recorder, 2500, 1200);
  resumed.recorder.close(save_tooth(drilled_tooth(resumed.simulation)), "{}");
  const VerifyReport report = verify_session(path);
  EXPECT_TRUE(report.verified) << testing_basics::text_of(report.findings);
  EXPECT_EQ(report.ticks_replayed, 3700);
  return cut_off;
}

TEST(TermsSession, ReplaysAndResumesWithItsForceTerms) {
  replays_and_resumes(setup_with_terms("0.26"), 3);
}

TEST(TermsSession, ReplaysAndResumesWithWhatRemembersAndCounts) {
  SessionSetup setup = test::block_setup();
  for (const char* term :
       {"hysteresis\"\nalpha_n_per_mm = 0.2\nd_mm = 0.05\ngamma = 0.5", "backlash\"\nb_mm = 0.01",
        "wear\"\nper_mm3 = 0.5", "chatter\"\namplitude_n = 0.02\nfrequency_hz = 37",
        "coolant\"\nfraction = -0.1", "thermal_softening\"\nper_k = 0.01",
        "anisotropy\"\nepsilon = 0.2\nphi0_deg = 20",
        "run_out\"\namplitude_n = 0.01\nby_clock = 1"})
    setup.force_model_toml += std::string("\n[[terms]]\nkind = \"") + term + "\n";
  EXPECT_GT(replays_and_resumes(setup, 8).terms.removed_leaves[0], 0u);
}

TEST(TermsSession, OtherFrictionIsAnotherHistory) {
  Simulation a = make_simulation(setup_with_terms("0.26"), "test"),
             b = make_simulation(setup_with_terms("0.27"), "test");
  for (std::int64_t tick = 0; tick < 200; ++tick) {
    (void)step(a.model, a.state, test::motion_at(tick));
    (void)step(b.model, b.state, test::motion_at(tick));
  }
  EXPECT_NE(state_hash(a.state), state_hash(b.state));
}

}  // namespace
}  // namespace cavum
