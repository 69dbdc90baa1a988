// Class I on the lower molar, cut by a person's means alone: keyboard, mouse or stylus, at 10 and
// at 60 pictures a second. Real events of the X server and of emulated devices go into the running
// `cavum station`; what comes back is where its pictures show the tip. An exam without practice's
// aids.
//   [CAVUM_PERSON=mouse] umockdev-wrapper person_test     each means, or this one, for the cavity's
//   first way CAVUM_DEEP=1 ...                                      for the whole cavity, at both
//   rates CAVUM_PERSON_RATE=60 ...                              at this rate alone
//   CAVUM_PERSON_KEEP=FOLDER ...                          sessions, and the tip's places of each
//   picture, stay there
#include "tests/ui/person/person.h"

#include <gtest/gtest.h>
#include <spawn.h>
#include <sys/wait.h>

#include <array>
#include <chrono>
#include <fstream>
#include <nlohmann/json.hpp>
#include <sstream>
#include <thread>

#include "engine/base/file.h"
#include "engine/session/verify.h"
#include "scenarios/exam/exam.h"
#include "tests/engine/support/basics.h"
#include "tests/ui/station/virtual_screen.h"

extern char** environ;

namespace cavum::testing_person {
namespace {

const std::string k_task = std::string(CAVUM_SOURCE_DIR) + "/data/scenarios/class_1.toml";

std::vector<std::string> burs_on_the_shelf() {
  std::vector<std::string> names;
  for (const auto& e :
       std::filesystem::directory_iterator(std::string(CAVUM_SOURCE_DIR) + "/data/burs"))
    names.push_back(e.path().stem().string());
  std::sort(names.begin(), names.end());
  return names;
}

/// The last whole line that the station told.
class Told {
 public:
  explicit Told(std::string path) : path_(std::move(path)) {}
  Seen operator()() {
    std::ifstream in(path_);
    in.seekg(read_);
    for (std::string line; std::getline(in, line) && !in.eof();) {
      read_ = in.tellg();
      std::istringstream words(line);
      words >> seen_.screen >> seen_.exam_s >> seen_.tip_mm.x >> seen_.tip_mm.y >> seen_.tip_mm.z;
      ++seen_.picture;
    }
    return seen_;
  }

 private:
  std::string path_;
  std::streampos read_ = 0;
  Seen seen_;
};

struct Outcome {
  double score = 0, pictures_s = 0, took_s = 0;
  std::string verdict;
  int left = 0;  ///< ways that the hand was held up on
  nlohmann::json grade;
};

enum class Work { whole, begun };  // the first way alone

bool asked_for(const std::string& means) {
  const char* only = std::getenv("CAVUM_PERSON");
  return only == nullptr || means == only;
}

bool asked_for_rate(int pictures_s) {
  const char* only = std::getenv("CAVUM_PERSON_RATE");
  return only == nullptr || std::to_string(pictures_s) == only;
}

class PersonAtTheStation : public ::testing::Test {
 protected:
  void SetUp() override {
    screen_ = std::make_unique<testing_station::VirtualScreen>();
    if (!screen_->there())
      GTEST_SKIP() << "SKIPPED: no Xvfb on this computer, so no window can be opened";
    hand_ = std::make_unique<testing_station::XHand>();
    if (!hand_->there()) GTEST_SKIP() << "no libXtst on this computer, so no key can be pressed";
    ::setenv("LANGUAGE", "en", 1);
    ::setenv("CAVUM_HOME", folder_.file("home").c_str(), 1);
    std::filesystem::create_directories(folder_.file("home"));
    // the emulation of devices knows no sound card, and a library that looks for one overflows it
    write_text_file(folder_.file("asound.conf"), "");
    ::setenv("ALSA_CONFIG_PATH", folder_.file("asound.conf").c_str(), 1);
  }

  Outcome sits(const std::string& name, int pictures_s, Work work) {
    const char* keep = std::getenv("CAVUM_PERSON_KEEP");
    const std::string run = name + "-" + std::to_string(pictures_s),
                      kept = keep == nullptr ? folder_.file("kept") : keep,
                      session = kept + "/" + run + ".cavum";
    std::filesystem::create_directories(kept);
    for (const std::string& old :
         {session, session + "-wal", session + "-shm", kept + "/" + run + ".txt"})
      std::filesystem::remove(old);
    const auto setup = scenarios::prepare_exam(k_task, {});
    std::unique_ptr<Means> means;
    if (name == "keyboard") means = std::make_unique<KeyboardMeans>(*hand_);
    if (name == "mouse") means = std::make_unique<MouseMeans>(*hand_);
    if (name == "stylus") {
      if (!testing_device::EmulatedPedal::possible()) {
        ADD_FAILURE() << "a stylus is emulated under umockdev-wrapper only";
        return {};
      }
      const Vec3 middle = (setup->zones.target_low_mm() + setup->zones.target_high_mm()) * 0.5;
      means = std::make_unique<StylusMeans>(
          *hand_, folder_.file("home"),
          Vec3{middle.x, middle.y, setup->zones.opening_z_mm() + 4.0});
    }
    write_text_file(folder_.file("script"),
                    "pace " + std::to_string(pictures_s) + "\ntell " + run + "\nsleep 3000\n");
    // where no device is emulated, the station is as it is on a desk
    const std::string plain = name == "stylus" ? "" : "env -u LD_PRELOAD -u UMOCKDEV_DIR ";
    const std::string command = "exec " + plain + std::string(CAVUM_BINARY " station ") + k_task +
                                " " + means->options() + " --out " + session +
                                " --width 800 --height 500 --effects 5 --script " +
                                folder_.file("script") + " --pictures " + kept + " >" +
                                folder_.file("out") + " 2>" + folder_.file("err");
    std::array<char*, 4> arguments{const_cast<char*>("sh"), const_cast<char*>("-c"),
                                   const_cast<char*>(command.c_str()), nullptr};
    pid_t child = -1;
    EXPECT_EQ(::posix_spawn(&child, "/bin/sh", nullptr, nullptr, arguments.data(), environ), 0);
    Outcome o;
    Told told(kept + "/" + run + ".txt");
    const Eye eye = [&told] { return told(); };
    try {
      const auto shelf = burs_on_the_shelf();
      const auto bur = std::find(shelf.begin(), shelf.end(), "cylinder-flat-1.0") - shelf.begin();
      means->come_to_exam(eye, static_cast<int>(bur), static_cast<int>(shelf.size()));
      Person person(*means, eye);
      const Seen first = eye();
      person.learn();
      means->pedal(true);
      for (const Way& way : ways_through(setup->zones, 0.5)) {
        o.left += person.follow(way);
        if (work == Work::begun) break;
      }
      means->pedal(false);
      person.lift(5.0);  // over the cusps, from the floor
      const Seen last = eye();
      o.took_s = last.exam_s;
      o.pictures_s =
          static_cast<double>(last.picture - first.picture) / (last.exam_s - first.exam_s);
      means->hand_in(eye);
    } catch (const std::exception& e) {
      ADD_FAILURE() << run << ": " << e.what() << "\n" << read_text_file(folder_.file("err"));
      ::kill(child, SIGTERM);
    }
    int status = 0;
    ::waitpid(child, &status, 0);
    if (::testing::Test::HasFailure()) return o;
    EXPECT_EQ(WEXITSTATUS(status), 0) << read_text_file(folder_.file("err"));
    EXPECT_TRUE(verify_session(session).verified) << run;
    EXPECT_EQ(std::system((std::string(CAVUM_BINARY " grade ") + session + " --json >" +
                           folder_.file("grade"))
                              .c_str()),
              0);
    o.grade = nlohmann::json::parse(read_text_file(folder_.file("grade")));
    o.verdict = o.grade["verdict"];
    o.score = o.grade["score"]["points"];
    std::printf(
        "%s at %d pictures a second: %.1f came; %s, %.2f points, %.0f s, %d of the ways left, %.2f mm3 removed\n",
        name.c_str(), pictures_s, o.pictures_s, o.verdict.c_str(), o.score, o.took_s, o.left,
        o.grade["volumes"]["removed_mm3"].get<double>());
    std::fflush(stdout);
    return o;
  }

  testing_basics::Folder folder_;
  std::unique_ptr<testing_station::VirtualScreen> screen_;
  std::unique_ptr<testing_station::XHand> hand_;
};

TEST_F(PersonAtTheStation, BeginsACavityByKeyboardMouseOrStylusAlone) {
  for (const std::string name : {"keyboard", "mouse", "stylus"}) {
    if (!asked_for(name)) continue;
    const Outcome o = sits(name, 60, Work::begun);
    if (HasFailure()) return;
    const auto& volumes = o.grade["volumes"];
    EXPECT_GT(volumes["removed_mm3"].get<double>(), 0.3) << name;
    EXPECT_LT(volumes["outside_mm3"].get<double>(), 0.05) << name;
  }
}

TEST_F(PersonAtTheStation, PassesClassIAtTenPicturesASecondAsAtSixty) {
  if (std::getenv("CAVUM_DEEP") == nullptr) GTEST_SKIP() << "takes half an hour: CAVUM_DEEP=1";
  for (const std::string name : {"keyboard", "mouse", "stylus"}) {
    if (!asked_for(name)) continue;
    std::vector<double> scores;
    for (const int pictures_s : {10, 60}) {
      if (!asked_for_rate(pictures_s)) continue;
      const Outcome o = sits(name, pictures_s, Work::whole);
      if (HasFailure()) return;
      EXPECT_EQ(o.verdict, "pass") << name << " at " << pictures_s << " pictures a second";
      scores.push_back(o.score);
    }
    if (scores.size() == 2)
      std::printf("%s: %+.2f points from 10 to 60 pictures a second\n", name.c_str(),
                  scores[1] - scores[0]);
  }
}

}  // namespace
}  // namespace cavum::testing_person
