// A sitting without any window: the stages follow one another, and whoever looks at it from another
// thread finds whole values.
#include "ui/station/sitting.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <chrono>
#include <filesystem>
#include <functional>
#include <thread>

#include "engine/session/session_reader.h"
#include "engine/session/verify.h"
#include "engine/tooth/surface_patches.h"
#include "tests/engine/support/basics.h"
#include "tests/faults/full_disk.h"
#include "tests/grading/records/school.h"

namespace cavum::station {
namespace {

using namespace std::chrono_literals;

class SittingTest : public ::testing::Test {
 protected:
  void SetUp() override {
    ::setenv("CAVUM_HOME", folder_.file("home").c_str(), 1);
    options_.scenario = std::string(CAVUM_SOURCE_DIR) + "/tests/replay/block_cavity.toml";
    options_.out = folder_.file("s.cavum");
    options_.device.name = "simulated";
  }
  /// Goes on as a window does, until `enough` or for two minutes.
  static bool goes_on(Sitting& sitting, const std::function<bool()>& enough) {
    for (int i = 0; i < 24000; ++i) {
      sitting.advance();
      if (enough()) return true;
      std::this_thread::sleep_for(5ms);
    }
    return false;
  }
  testing_basics::Folder folder_;
  SittingOptions options_;
};

TEST_F(SittingTest, LeadsFromTheCodeToASealedResult) {
  Sitting sitting(options_, "K1");
  EXPECT_EQ(sitting.stage(), Stage::preparing);
  ASSERT_TRUE(goes_on(sitting, [&] { return sitting.stage() == Stage::checking; }));
  ASSERT_TRUE(goes_on(sitting, [&] { return all_good(check_items(sitting.sight())); }));
  sitting.begin();
  ASSERT_EQ(sitting.stage(), Stage::running);
  // what a window does in each frame: look, mesh what changed, set the desk
  std::optional<LeafBlocks> leaves;
  sitting.live().look_at_tooth([&](const Octree& tooth) { leaves.emplace(tooth); });
  SurfacePatches surface(*leaves);
  std::vector<LeafBounds> changed;
  std::vector<std::uint32_t> touched;
  std::int64_t last = -1;
  std::size_t patches = 0;
  ASSERT_TRUE(goes_on(sitting, [&] {
    if (sitting.stage() != Stage::running) return true;
    const scenarios::LiveView view = sitting.live().view();
    EXPECT_GE(view.ticks, last);
    last = view.ticks;
    changed.clear();
    sitting.live().look_at_tooth([&](const Octree& tooth) { leaves->take(tooth, changed); });
    surface.update(*leaves, changed, touched);
    patches += touched.size();
    touched.clear();
    sitting.desk().speed_share = 0.9;
    if (view.ticks > 5000) sitting.ask_to_end();
    return false;
  }));
  EXPECT_GT(patches, 0u);
  ASSERT_TRUE(goes_on(sitting, [&] { return sitting.stage() == Stage::done; }));
  EXPECT_EQ(sitting.report().first_disagreement, -1);
  EXPECT_GT(sitting.closed().result.volumes.removed.mm3, 0.1);
  EXPECT_TRUE(verify_session(sitting.path()).verified);
}

/// Sits for a few seconds on a disk that is full from the second one on, and ends the exam.
class FullDiskSitting : public SittingTest {
 protected:
  void sit() {
    ASSERT_TRUE(goes_on(sitting_, [&] { return sitting_.stage() == Stage::checking; }));
    sitting_.begin();
    ASSERT_TRUE(goes_on(sitting_, [&] { return sitting_.live().view().ticks > 1300; }));
    full_.emplace(std::filesystem::file_size(options_.out + "-wal") + 1500);
    ASSERT_TRUE(goes_on(sitting_, [&] { return !sitting_.live().view().recording_error.empty(); }))
        << "the candidate is told";
    ASSERT_TRUE(goes_on(sitting_, [&] { return sitting_.live().view().unwritten_ticks > 1500; }))
        << "and goes on working";
    sitting_.ask_to_end();
    ASSERT_TRUE(goes_on(sitting_, [&] { return sitting_.stage() == Stage::unsaved; }));
    EXPECT_GT(sitting_.unwritten_s(), 1.5);
    EXPECT_FALSE(sitting_.trouble().empty());
  }
  void expect_whole() {
    ASSERT_TRUE(goes_on(sitting_, [&] { return sitting_.stage() == Stage::done; }));
    const VerifyReport report = verify_session(sitting_.path());
    EXPECT_TRUE(report.verified) << testing_basics::text_of(report.findings);
    EXPECT_EQ(report.ticks, sitting_.live().view().ticks);
  }
  Sitting sitting_{(SetUp(), options_), "K1"};
  std::optional<test::FullDisk> full_;
};

TEST_F(FullDiskSitting, IsSavedByItselfOnceThereIsRoom) {
  sit();
  if (HasFatalFailure()) return;
  full_.reset();
  expect_whole();
  EXPECT_EQ(sitting_.path(), options_.out);
}

TEST_F(FullDiskSitting, IsSavedInAnotherFolderThatSomebodyTypes) {
  sit();
  if (HasFatalFailure()) return;
  const std::string folder = folder_.file("stick");
  std::filesystem::create_directories(folder);
  EXPECT_THROW(sitting_.save(folder_.file("no/such/folder/x.cavum")), Error);
  EXPECT_THROW(sitting_.save(folder_.file("notes.txt")), Error);
  EXPECT_EQ(sitting_.stage(), Stage::unsaved);
  full_.reset();
  sitting_.save(folder);
  expect_whole();
  EXPECT_EQ(sitting_.path(), folder + "/s.cavum");
  const VerifyReport first = verify_session(options_.out);
  EXPECT_TRUE(first.intact);
  EXPECT_FALSE(first.closed);
}

TEST_F(FullDiskSitting, WithNobodyToAnswerSaysThatNothingTakesItAndKeepsIt) {
  sit();
  if (HasFatalFailure()) return;
  const std::string temporary = folder_.file("temporary");
  std::filesystem::create_directories(temporary);
  ::setenv("TMPDIR", temporary.c_str(), 1);
  EXPECT_THROW(sitting_.rescue(), Error) << "it is as full there";
  EXPECT_EQ(sitting_.stage(), Stage::unsaved);
  EXPECT_TRUE(std::filesystem::is_empty(temporary));
  full_.reset();
  sitting_.rescue();
  ::unsetenv("TMPDIR");
  EXPECT_EQ(sitting_.stage(), Stage::done) << "it waits until all is sealed";
  expect_whole();
  EXPECT_EQ(sitting_.path(), options_.out) << "where there is room it stays";
}

TEST_F(SittingTest, StoppedByTheWindowItIsInterruptedAndAllOfItOnDisk) {
  Sitting sitting(options_, "K9");
  ASSERT_TRUE(goes_on(sitting, [&] { return sitting.stage() == Stage::checking; }));
  sitting.stop();
  EXPECT_EQ(sitting.stage(), Stage::checking) << "nothing runs yet";
  sitting.begin();
  ASSERT_TRUE(goes_on(sitting, [&] { return sitting.live().view().ticks > 1200; }));
  sitting.rescue();
  EXPECT_EQ(sitting.stage(), Stage::interrupted);
  EXPECT_EQ(sitting.unwritten_s(), 0.0);
  EXPECT_EQ(SessionReader(options_.out).ticks(), sitting.live().view().ticks);
}

TEST_F(SittingTest, LeftInTheMiddleItCanBeResumed) {
  {
    Sitting sitting(options_, "K2");
    ASSERT_TRUE(goes_on(sitting, [&] { return sitting.stage() == Stage::checking; }));
    sitting.begin();
    ASSERT_TRUE(goes_on(sitting, [&] { return sitting.live().view().ticks > 1500; }));
  }
  const VerifyReport open = verify_session(options_.out);
  EXPECT_TRUE(open.intact);
  EXPECT_FALSE(open.closed);
  EXPECT_GT(open.ticks, 1500);
}

TEST_F(SittingTest, LeftWhileItIsPreparedItLeavesNothing) {
  { const Sitting sitting(options_, "K3"); }
  EXPECT_FALSE(std::filesystem::exists(options_.out));
}

TEST_F(SittingTest, SaysWhatIsWrongWithItsFiles) {
  options_.scenario = folder_.file("none.toml");
  Sitting sitting(options_, "K4");
  EXPECT_THROW(goes_on(sitting, [] { return false; }), Error);
}

TEST_F(SittingTest, WhereNothingCanBeRecordedNothingBegins) {
  options_.out = folder_.file("no/such/folder/s.cavum");
  Sitting sitting(options_, "K5");
  ASSERT_TRUE(goes_on(sitting, [&] { return sitting.stage() == Stage::checking; }));
  EXPECT_THROW(sitting.begin(), Error);
  EXPECT_EQ(sitting.stage(), Stage::checking);
  EXPECT_TRUE(goes_on(sitting, [&] { return sitting.sight().read_once; }))
      << "the device is watched on";
}

TEST_F(SittingTest, BeginsAtTheSecondPlaceWhenTheFirstRefuses) {
  options_.out = folder_.file("no/such/disk/s.cavum");
  options_.out_if_full = folder_.file("stick");
  std::filesystem::create_directories(options_.out_if_full);
  Sitting sitting(options_, "K6");
  ASSERT_TRUE(goes_on(sitting, [&] { return sitting.stage() == Stage::checking; }));
  sitting.begin();
  for (const std::string& path : {options_.out, sitting.path()})
    EXPECT_NE(english_text(sitting.moved()).find(path), std::string::npos)
        << "told at once: " << sitting.moved();
  EXPECT_EQ(std::filesystem::path(sitting.path()).parent_path(),
            std::filesystem::path(options_.out_if_full));
  ASSERT_TRUE(goes_on(sitting, [&] { return sitting.live().view().ticks > 1200; }));
  EXPECT_EQ(sitting.live().view().recording_error, Message());
  sitting.ask_to_end();
  ASSERT_TRUE(goes_on(sitting, [&] { return sitting.stage() == Stage::done; }));
  EXPECT_TRUE(verify_session(sitting.path()).verified);
}

TEST_F(SittingTest, GivesEachCandidateAFileOfHisOwnInAFolder) {
  options_.out = folder_.file("");
  Sitting sitting(options_, "A/../7");
  ASSERT_TRUE(goes_on(sitting, [&] { return sitting.stage() == Stage::checking; }));
  sitting.begin();
  EXPECT_EQ(std::filesystem::path(sitting.path()).parent_path(),
            std::filesystem::path(folder_.file("")).parent_path());
  EXPECT_NE(sitting.path().find("block_cavity-A_.._7-"), std::string::npos) << sitting.path();
  EXPECT_TRUE(std::filesystem::exists(sitting.path()));
}

TEST_F(SittingTest, OnlyWhoHasATicketSitsAndAsItPromises) {
  const testing_ledger::School school;
  const std::string ticket = school.ticket("4711", [](records::Ticket& t) {
    t.grant = {{"accommodation.extra_time_percent", "50"}};
  });
  const std::string candidate = records::parse_ticket(ticket, "", "ticket").candidate;
  options_.tickets = school.file("tickets");
  std::filesystem::create_directories(options_.tickets);
  write_text_file(options_.tickets + "/" + candidate + ".ticket", ticket + "\n");
  EXPECT_THROW(Sitting(options_, "4711"), Error)
      << "the code is the pseudonym, and nothing that others know";
  EXPECT_THROW(Sitting(options_, "../tickets/" + candidate), Error);
  int asked = 0;
  options_.word = [&asked](const std::string&) {  // an office that does not answer
    ++asked;
    return std::string();
  };
  std::string typed = candidate;
  for (char& c : typed) c = static_cast<char>(std::tolower(c));
  {
    Sitting sitting(options_, typed);
    EXPECT_EQ(sitting.candidate(), candidate);
    ASSERT_TRUE(goes_on(sitting, [&] { return sitting.stage() == Stage::checking; }));
    EXPECT_EQ(sitting.setup().scenario.accommodations.extra_time_percent, 50.0);
    EXPECT_EQ(sitting.setup().session.candidate, candidate);
    EXPECT_EQ(asked, 1);
  }
  std::string bare = candidate, spaced = typed;  // without dashes; with blanks in their place
  std::erase(bare, '-');
  std::replace(spaced.begin(), spaced.end(), '-', ' ');
  for (const std::string& code : {bare, spaced})
    EXPECT_EQ(Sitting(options_, code).candidate(), candidate) << code;
  EXPECT_THROW(Sitting(options_, bare.substr(0, 12)), Error) << "a letter is missing";
  EXPECT_THROW(Sitting(options_, bare + "0"), Error) << "one too many";
  const int before = asked;
  options_.model = "paper";
  Sitting other(options_, candidate);
  EXPECT_THROW(goes_on(other, [&] { return other.stage() == Stage::checking; }), Error)
      << "another force model than promised";
  EXPECT_EQ(asked, before) << "the office would take it for begun";
}

TEST_F(SittingTest, AnInterruptedExamGoesOnByTheOneWhoBeganIt) {
  std::int64_t before = 0;
  {
    Sitting sitting(options_, "C-7K3M-Q9WD-XT20");
    ASSERT_TRUE(goes_on(sitting, [&] { return sitting.stage() == Stage::checking; }));
    sitting.begin();
    ASSERT_TRUE(goes_on(sitting, [&] { return sitting.live().view().ticks > 2000; }));
  }
  before = SessionReader(options_.out).ticks();
  EXPECT_GE(before, 2000);
  SittingOptions again;
  again.resume = options_.out;
  again.device.name = "simulated";
  EXPECT_THROW(Sitting(again, "C-7K3M-Q9WD-XT21"), Error) << "another candidate";
  SittingOptions mouse = again;
  mouse.device.name = "mouse";
  EXPECT_THROW(Sitting(mouse, "C-7K3M-Q9WD-XT20"), Error) << "another encoder";
  {
    Sitting sitting(again, "c7k3m q9wdxt20");
    EXPECT_EQ(sitting.candidate(), "C-7K3M-Q9WD-XT20") << "as it was begun, however it is typed";
    ASSERT_TRUE(goes_on(sitting, [&] { return sitting.stage() == Stage::checking; }));
    ASSERT_TRUE(sitting.begun());
    EXPECT_NEAR(
        sitting.begun()->left_s,
        0.001 * static_cast<double>(scenarios::exam_limit_ticks(sitting.setup().scenario) - before),
        1e-9);
    EXPECT_EQ(sitting.begun()->bur, SessionReader(options_.out).inputs().back().bur);
    for (const auto& removed : SessionReader(options_.out).removed())
      ASSERT_EQ(sitting.begun()->tooth.tissue(removed.leaf.leaf()), k_air);
    sitting.begin();
    ASSERT_TRUE(goes_on(sitting, [&] {
      return sitting.stage() == Stage::done || sitting.live().view().ticks > before + 1500;
    }));
    EXPECT_EQ(SessionReader(options_.out).inputs().back().bur, sitting.begun()->bur);
    sitting.ask_to_end();
    ASSERT_TRUE(goes_on(sitting, [&] { return sitting.stage() == Stage::done; }));
    EXPECT_EQ(sitting.path(), options_.out);
    EXPECT_GT(sitting.closed().result.motion.time_s, 0.001 * static_cast<double>(before));
  }
  EXPECT_TRUE(verify_session(options_.out).verified);
  EXPECT_THROW(Sitting(again, "C-7K3M-Q9WD-XT20"), Error) << "it is closed now";
}

}  // namespace
}  // namespace cavum::station
