// A recording process killed at random moments: the file opens, a second at most is missing, and
// the exam goes on to a session that verifies.
#include <gtest/gtest.h>
#include <sys/mman.h>
#include <sys/wait.h>
#include <unistd.h>

#include <atomic>
#include <csignal>
#include <cstdio>
#include <new>

#include "engine/base/random.h"
#include "engine/session/resume.h"
#include "engine/session/session_reader.h"
#include "engine/session/verify.h"
#include "tests/engine/session/fixture.h"

namespace cavum {
namespace {

/// What the child tells the parent up to its last breath.
struct Truth {
  std::atomic<std::int64_t> ticks{0};
};

[[noreturn]] void record_until_killed(const std::string& path, Truth& truth) {
  const SessionSetup setup = test::block_setup();
  Simulation simulation = make_simulation(setup, "test");
  Recorder recorder = Recorder::create(path, setup);
  for (std::int64_t tick = 0;; ++tick) {
    if (tick % 500 == 3) recorder.add_event(tick, TimeUp{});
    test::drill(simulation, recorder, tick, 1);
    truth.ticks.store(tick + 1);
  }
}

TEST(KilledSession, LosesAtMostASecondAndResumesAt20RandomMoments) {
  Random random(test::drawn_seed("LosesAtMostASecondAndResumesAt20RandomMoments"));
  void* shared =
      ::mmap(nullptr, sizeof(Truth), PROT_READ | PROT_WRITE, MAP_SHARED | MAP_ANONYMOUS, -1, 0);
  ASSERT_NE(shared, MAP_FAILED);
  std::int64_t most_lost = 0, killed_with_motion = 0;
  for (int run = 0; run < 20; ++run) {
    const test::Folder folder;
    const std::string path = folder.file("exam.cavum");
    auto* truth = new (shared) Truth;
    const pid_t child = ::fork();
    ASSERT_GE(child, 0);
    if (child == 0) record_until_killed(path, *truth);
    while (truth->ticks.load() == 0) ::usleep(200);
    ::usleep(static_cast<useconds_t>(random.below(250'000)));
    ASSERT_EQ(::kill(child, SIGKILL), 0);
    int status = 0;
    ASSERT_EQ(::waitpid(child, &status, 0), child);
    ASSERT_TRUE(WIFSIGNALED(status) && WTERMSIG(status) == SIGKILL) << "the child ended by itself";

    const std::int64_t driven = truth->ticks.load();
    {
      const SessionReader session(path);
      session.require_readable();
      EXPECT_FALSE(session.closed());
      const std::int64_t lost =
          driven + 1 - session.ticks();  // one more tick may have been under way
      EXPECT_LE(lost, k_chunk_ticks + 1) << "of " << driven;
      EXPECT_GE(lost, 0);
      most_lost = std::max(most_lost, lost - 1);
      killed_with_motion += session.ticks() > 0;
      const auto inputs = session.inputs();
      for (std::size_t i = 0; i < inputs.size(); ++i)
        ASSERT_EQ(inputs[i], test::motion_at(static_cast<std::int64_t>(i)));
    }
    EXPECT_TRUE(verify_session(path).intact);
    ResumedSession exam = resume_session(path);
    const std::int64_t kept = exam.ticks;
    test::drill(exam.simulation, exam.recorder, kept, 600);
    exam.recorder.close(save_tooth(drilled_tooth(exam.simulation)), "{}");
    const VerifyReport report = verify_session(path);
    EXPECT_TRUE(report.verified) << testing_basics::text_of(report.findings);
    EXPECT_EQ(report.ticks, kept + 600);
    EXPECT_NE(SessionReader(path).events().back().as<RecordingGap>(), nullptr);
  }
  ::munmap(shared, sizeof(Truth));
  std::printf("at most %lld ticks lost; %lld of 20 killed after their first second\n",
              static_cast<long long>(most_lost), static_cast<long long>(killed_with_motion));
  EXPECT_GT(killed_with_motion, 5) << "the kills came too early to show anything";
}

}  // namespace
}  // namespace cavum
