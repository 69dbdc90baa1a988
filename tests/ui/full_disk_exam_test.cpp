// The program on a disk that is really full: a file system in memory of 200 kB, of a mount that
// only the exam's own process sees. The candidate is told, the exam goes on, and what was recorded
// is saved elsewhere or when there is room; with the same result as on a large disk.
#include <filesystem>

#include "engine/session/session_reader.h"
#include "tests/ui/program.h"

namespace cavum::ui {
namespace {

class FullDiskExam : public testing_ui::Program {
 protected:
  void SetUp() override {
    Program::SetUp();
    std::filesystem::create_directories(small());
    std::filesystem::create_directories(path("kept"));
    if (std::system(in_own_mount("true").c_str()) != 0)
      GTEST_SKIP() << "no file system of a limited size can be mounted here (unshare, tmpfs)";
  }
  [[nodiscard]] std::string small() const { return path("small"); }
  /// Runs `commands` with the small disk at small(), which is gone afterwards; what lay on it is
  /// copied to kept/.
  [[nodiscard]] std::string in_own_mount(const std::string& commands) const {
    return "unshare -m sh -c 'mount -t tmpfs -o size=200k none " + small() + " && { " + commands +
           "; code=$?; cp -p " + small() + "/* " + path("kept") +
           "/ 2>/dev/null; exit $code; }' 2>" + path("err") + " >" + path("out");
  }
  [[nodiscard]] std::string exam(const std::string& out) const {
    return std::string(CAVUM_BINARY) + " exam " + CAVUM_SOURCE_DIR +
           "/tests/replay/block_cavity.toml --candidate 7 --operator expert --quiet --out " + out;
  }
  [[nodiscard]] testing_ui::Ran on_the_small_disk(const std::string& commands) const {
    const int status = std::system(in_own_mount(commands).c_str());
    return {WIFEXITED(status) ? WEXITSTATUS(status) : -1, read_text_file(path("out")),
            read_text_file(path("err"))};
  }
  /// The session at `saved` is whole, true, and what the same candidate leaves on a large disk.
  void expect_saved(const std::string& saved) {
    EXPECT_EQ(run("replay " + saved + " --verify").exit_code, 0)
        << read_text_file(path("out")) << read_text_file(path("err"));
    ASSERT_EQ(std::system((exam(path("large.cavum")) + " >" + path("out")).c_str()), 0);
    const auto mine = run_json("grade " + saved), large = run_json("grade " + path("large.cavum"));
    EXPECT_EQ(mine["score"], large["score"]);
    EXPECT_EQ(mine["volumes"], large["volumes"]);
    EXPECT_EQ(run_json("replay " + saved + " --verify")["ticks"],
              run_json("replay " + path("large.cavum") + " --verify")["ticks"]);
  }
};

TEST_F(FullDiskExam, GoesOnAtTheSecondPlaceAndTellsSo) {
  const auto r =
      on_the_small_disk(exam(small() + "/e.cavum") + " --out-if-full " + path("saved.cavum"));
  ASSERT_EQ(r.exit_code, 0) << r.err;
  EXPECT_NE(r.err.find(path("saved.cavum")), std::string::npos) << r.err;
  EXPECT_NE(r.out.find(path("saved.cavum")), std::string::npos) << r.out;
  expect_saved(path("saved.cavum"));
  // what was on the small disk is still true, and could be resumed
  const auto first = run("replay " + path("kept/e.cavum") + " --verify");
  EXPECT_EQ(first.exit_code, 1);
  EXPECT_GT(SessionReader(path("kept/e.cavum")).ticks(), 0);
}

TEST_F(FullDiskExam, FullBeforeItBeginsItBeginsAtTheSecondPlaceAndTellsSoAtOnce) {
  const std::string fill = "cat /dev/zero >" + small() + "/filler; ";
  const auto r = on_the_small_disk(fill + exam(small() + "/e.cavum") + " --out-if-full " +
                                   path("saved.cavum"));
  ASSERT_EQ(r.exit_code, 0) << r.err;
  EXPECT_NE(r.err.find(path("saved.cavum")), std::string::npos) << r.err;
  EXPECT_EQ(std::count(r.err.begin(), r.err.end(), '\n'), 2)
      << "cat's and one of ours: there was room from the first second on: " << r.err;
  EXPECT_NE(r.out.find(path("saved.cavum")), std::string::npos) << r.out;
  expect_saved(path("saved.cavum"));
  const auto events = SessionReader(path("saved.cavum")).events();
  ASSERT_FALSE(events.empty());
  ASSERT_NE(events[0].as<RecordingMoved>(), nullptr)
      << "the session says itself that it was meant for another disk";
  EXPECT_EQ(events[0].as<RecordingMoved>()->from, "e.cavum");
  EXPECT_EQ(events[0].tick, 0);

  // without a second place nothing begins, and nothing is left behind that could be taken for a
  // session
  std::filesystem::remove_all(path("kept"));
  std::filesystem::create_directories(path("kept"));
  const auto refused = on_the_small_disk(fill + exam(small() + "/e.cavum"));
  EXPECT_EQ(refused.exit_code, 2) << refused.err;
  EXPECT_NE(refused.err.find("e.cavum"), std::string::npos) << refused.err;
  for (const auto& left : std::filesystem::directory_iterator(path("kept")))
    EXPECT_EQ(left.path().filename(), "filler") << refused.err;
}

TEST_F(FullDiskExam, AsksForAnotherPlaceAtItsEnd) {
  // an empty line tries again, a place on the same disk is full as well
  const auto r = on_the_small_disk("printf \"\\n" + small() + "/other.cavum\\n" +
                                   path("typed.cavum") + "\\n\" | " + exam(small() + "/e.cavum"));
  ASSERT_EQ(r.exit_code, 0) << r.err;
  EXPECT_NE(r.err.find(small() + "/other.cavum"), std::string::npos)
      << "that is full, too: " << r.err;
  expect_saved(path("typed.cavum"));
}

TEST_F(FullDiskExam, IsSavedWhereItWasOnceThereIsRoom) {
  const std::string filler = small() + "/filler",
                    err = path("err");  // lines: that it is full, and at the end that it still is
  const auto r =
      on_the_small_disk("mount -o remount,size=4m " + small() + " && head -c 3990000 /dev/zero >" +
                        filler + " && { n=0; until [ $(wc -l <" + err +
                        ") -ge 3 ] || [ $n -gt 600 ]; do sleep 0.1; n=$((n+1)); done; rm -f " +
                        filler + "; echo; } | " + exam(small() + "/e.cavum"));
  ASSERT_EQ(r.exit_code, 0) << r.err;
  expect_saved(path("kept/e.cavum"));
}

TEST_F(FullDiskExam, WithNobodyToAnswerIsRescuedToTheTemporaryFolder) {
  std::filesystem::create_directories(path("tmp"));
  const auto r =
      on_the_small_disk("TMPDIR=" + path("tmp") + " " + exam(small() + "/e.cavum") + " </dev/null");
  ASSERT_EQ(r.exit_code, 0) << r.err;
  expect_saved(path("tmp/e-rescued.cavum"));
}

}  // namespace
}  // namespace cavum::ui
