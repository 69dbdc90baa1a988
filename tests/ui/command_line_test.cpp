// The program as a user runs it: complete exams by the three simulated candidates on the shipped
// molar, kills and resumes, and bad input, which must end with exit 2 and one line that names file
// and place.
#include <gtest/gtest.h>
#include <signal.h>
#include <unistd.h>

#include <chrono>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <sstream>

#include "engine/base/random.h"
#include "engine/session/session_reader.h"
#include "tests/ui/program.h"

namespace cavum::ui {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;
using testing_ui::k_block;
using testing_ui::k_data;
using testing_ui::Ran;

class CommandLine : public testing_ui::Program {
 protected:
  [[nodiscard]] json exam(const std::string& scenario, const std::string& who,
                          const std::string& more = "") const {
    const Ran r = run("exam " + scenario + " --candidate test --operator " + who + " --out " +
                      path(who + ".cavum") + " --json " + more);
    EXPECT_EQ(r.exit_code, 0) << r.err;
    return json::parse(r.out, nullptr, false);
  }

  /// The molar that ships, in leaves of 0.1 mm where they will do (with CAVUM_DEEP as it ships): an
  /// exam on it takes a third of the time.
  [[nodiscard]] std::string coarse_molar() const {
    if (std::getenv("CAVUM_DEEP") != nullptr) return "";
    EXPECT_EQ(run("tooth make molar --leaf-mm 0.1 --out " + path("coarse.cvt")).exit_code, 0);
    return "--tooth " + path("coarse.cvt");
  }

  /// Whether this build imports: then it names the file that is not there.
  [[nodiscard]] bool can_import() const {
    return run("tooth import --enamel none.stl --out y").err.find("none.stl") != std::string::npos;
  }

  /// Imports a molar from meshes of enamel, dentin and pulp: one of another shape than the shipped,
  /// made here; with CAVUM_DEEP a real one, where there is one beside the repository.
  void import_molar(const std::string& out) const {
    if (!can_import()) GTEST_SKIP() << "built without import";
    const fs::path real = fs::path(CAVUM_SOURCE_DIR) / ".." / "shared" / "teeth" / "openmandible";
    const bool deep = std::getenv("CAVUM_DEEP") != nullptr && fs::exists(real);
    const auto mesh = [&](const std::string& name) {
      std::string file = name;
      file[0] = static_cast<char>(std::tolower(file[0]));
      return deep ? real.string() + "/Tooth_L6_" + name + ".stl" : path(file + ".stl");
    };
    if (!deep) {
      ASSERT_EQ(
          run("tooth make molar --canals 4 --chamber-roof-mm -2.9 --lateral-enamel-mm 1.1 --leaf-mm 0.1 --out " +
              path("made.cvt"))
              .exit_code,
          0);
      for (const char* tissue : {"enamel", "dentin", "pulp"})
        ASSERT_EQ(run("tooth mesh " + path("made.cvt") + " --tissue " + tissue + " --out " +
                      path(std::string(tissue) + ".stl"))
                      .exit_code,
                  0);
    }
    const Ran import = run("tooth import --enamel " + mesh("Enamel") + " --dentin " +
                           mesh("Dentin") + " --pulp " + mesh("Pulp") + " --leaf-mm " +
                           (deep ? "0.05 --mesial-axis 0,-1,0" : "0.1") + " --out " + out);
    ASSERT_EQ(import.exit_code, 0) << import.err;
  }
};

double best_gap_s(const json& result) {
  const auto& p = result["perforation"];
  double best = 1e9;
  for (const auto& e : p["events"])
    if (p["truth"]["first_t_s"].is_number())
      best =
          std::min(best, std::fabs(e["t_s"].get<double>() - p["truth"]["first_t_s"].get<double>()));
  return best;
}

/// Of a criterion by a wall's own measure, whether its burs were lost and its reason has a figure.
bool lost_at_a_wall(const json& result) {
  const auto& all = result["criteria"];
  return std::any_of(all.begin(), all.end(), [](const json& c) {
    return c["points"] < c["max"] &&
           c["metric"].get<std::string>().find("wall") != std::string::npos &&
           !c["reason"].get<std::string>().empty();
  });
}

TEST_F(CommandLine, AFailureIsOneJsonObjectWithItsCode) {
  write_text_file(path("bad.toml"), "id = \n");
  write_text_file(path("file"), "x");
  const std::pair<std::string, const char*> calls[] = {
      {"nothing", "usage"},
      {"grade", "usage"},
      {"grade --nonsense x", "usage"},
      {"tooth info " + k_block + " --language xx", "error"},
      {"grade " + path("none.cavum"), "missing"},
      {"tooth info " + path("none.cvt"), "missing"},
      {"tooth info " + path("file/none.cvt"), "not_a_folder"},
      {"scenario solve " + path("bad.toml"), "not_toml"},
      {"exam " + path("bad.toml") + " --candidate a --operator expert --out " + path("x.cavum"),
       "not_toml"},
      {"explain " + path("none.csv"), "missing"},
      {"ledger verify " + path("none"), "unknown"}};
  for (const auto& [call, code] : calls) {
    const Ran r = run(call + " --json");
    EXPECT_EQ(r.exit_code, 2) << call << r.err;
    EXPECT_TRUE(r.err.starts_with("cavum: ")) << call << r.err;
    const json j = json::parse(r.out, nullptr, false);
    ASSERT_TRUE(j.is_object() && j.contains("error")) << call << r.out;
    for (const char* name : {"where", "what", "advice"})
      EXPECT_FALSE(j["error"][name].empty()) << call << name;
    EXPECT_EQ(j["error"]["code"], code) << call << r.out;
  }
  EXPECT_EQ(
      json::parse(
          run("scenario solve " + path("bad.toml") + " --json").out)["error"]["where"]["line"],
      1);
}

TEST_F(CommandLine, ExpertPassesTheAccessExamAndItsReplayVerifies) {
  const json result =
      exam(k_data + "/scenarios/molar_access.toml", "expert", "--report " + path("r.html"));
  EXPECT_EQ(result["verdict"], "pass");
  EXPECT_EQ(result["steps"]["completed"], result["steps"]["count"]);
  EXPECT_TRUE(result["notes"].empty()) << result["notes"];
  EXPECT_GT(result["volumes"]["target_removed_percent"], 90);
  EXPECT_FALSE(result["perforation"]["truth"]["perforated"]);
  const Ran replay = run("replay " + path("expert.cavum") + " --verify --json");
  EXPECT_EQ(replay.exit_code, 0) << replay.err;
  const json r = json::parse(replay.out);
  EXPECT_TRUE(r["verified"]);
  EXPECT_TRUE(r["first_divergence"].is_null());
  std::printf("replayed %lld ticks at %.0f times real time\n", r["ticks"].get<long long>(),
              r["speed_x_realtime"].get<double>());
  const Ran graded = run("grade " + path("expert.cavum") + " --json");
  EXPECT_EQ(json::parse(graded.out)["score"], result["score"])
      << "a grade from the file equals the one at the end of the exam";
  EXPECT_NE(read_text_file(path("r.html")).find("<svg"), std::string::npos);
}

TEST_F(CommandLine, ExpertCompletesTheStepsOfTheSmallScenariosToo) {
  for (const std::string& scenario : {k_block, k_data + "/scenarios/class_1.toml"}) {
    const json result = exam(scenario, "expert");
    EXPECT_EQ(result["verdict"], "pass") << scenario;
    EXPECT_EQ(result["finish"], "completed")
        << scenario << " " << result["volumes"]["target_removed_percent"];
    fs::remove(path("expert.cavum"));
  }
}

TEST_F(CommandLine, AMisspeltTissueOrBurIsFoundBeforeAnyExam) {
  std::ifstream in(k_data + "/scenarios/class_1.toml");
  const std::string good{std::istreambuf_iterator<char>(in), {}};
  for (const auto& [from, to] : {std::pair<std::string, std::string>{"\"pulp\"", "\"pulpa\""},
                                 {"burs = [\"", "burs = [\"round-9\", \""}}) {
    std::string bad = good;
    const auto at = bad.find(from, from[0] == '"' ? bad.find("[perforation]") : 0);
    ASSERT_NE(at, std::string::npos);
    bad.replace(at, from.size(), to);
    std::ofstream(path("bad.toml")) << bad;
    const std::string tooth = " --tooth " + k_data + "/teeth/lower_molar.cvt";
    const Ran check = run("scenario check " + path("bad.toml") + tooth);
    EXPECT_EQ(check.exit_code, 1) << check.out;
    const Ran exam = run("exam " + path("bad.toml") + tooth +
                         " --candidate A --operator expert --out " + path("bad.cavum"));
    EXPECT_EQ(exam.exit_code, 2) << exam.err;
    EXPECT_FALSE(fs::exists(path("bad.cavum")));
    if (from == "\"pulp\"") {
      EXPECT_NE(check.out.find("'pulp'"), std::string::npos) << check.out;
    }
  }
}

// Two of them, drawn by the seed, and all with CAVUM_DEEP: a solution takes up to twenty seconds.
TEST_F(CommandLine, TemplatesAreSolvedByTheExpertInAboutTheTimeThatCheckSays) {
  const std::vector<std::pair<std::string, std::string>> templates{
      {"block", "class_1"},       {"block", "slot"},           {"block", "cross"},
      {"molar", "class_1"},       {"molar", "class_2_mesial"}, {"molar", "slot_mesial"},
      {"molar", "access"},        {"premolar", "access"},      {"incisor", "access"},
      {"carious_molar", "lesion"}};
  for (const auto& [tooth, task] : testing_basics::some_of(
           templates, 2, "CommandLine.TemplatesAreSolvedByTheExpertInAboutTheTimeThatCheckSays")) {
    const std::string file = path(tooth + task + ".toml");
    ASSERT_EQ(run("scenario new --untried --tooth " + tooth + " --task " + task + " --out " + file)
                  .exit_code,
              0);
    const Ran check = run("scenario check " + file + " --json");
    EXPECT_EQ(check.exit_code, 0) << check.out;
    const Ran solve = run("scenario solve " + file + " --json");
    const json said = json::parse(check.out), done = json::parse(solve.out);
    EXPECT_TRUE(said["problems"].empty());
    EXPECT_TRUE(done["passed"].get<bool>()) << solve.out << solve.err;
    EXPECT_EQ(solve.exit_code, 0);
    EXPECT_EQ(done["steps"]["completed"], done["steps"]["count"]) << file;
    const double ratio = said["expert_s"].get<double>() / done["time_s"].get<double>();
    EXPECT_GT(ratio, 0.7) << file;
    EXPECT_LT(ratio, 1.7) << file;
  }
}

TEST_F(CommandLine, ANewTaskIsTriedBeforeItIsWritten) {
  const Ran made =
      run("scenario new --tooth premolar --task slot_distal --json --out " + path("slot.toml"));
  ASSERT_EQ(made.exit_code, 0) << made.err;
  const json said = json::parse(made.out);
  EXPECT_GE(said["tried"]["expert_percent"].get<double>(), 90.0);
  EXPECT_GT(said["tried"]["faulty_preparations"].get<int>(), 20);
  EXPECT_NE(read_text_file(path("slot.toml")).find("tooth = \"upper_premolar.cvt\""),
            std::string::npos);
  // too small for any bur: refused, and nothing is written
  expect_refused("scenario new --tooth premolar --task class_5 --out " + path("small.toml"),
                 {"class_5"});
  EXPECT_FALSE(fs::exists(path("small.toml")));
  const Ran draft = run("scenario new --tooth premolar --task slot_distal --untried --json --out " +
                        path("draft.toml"));
  ASSERT_EQ(draft.exit_code, 0) << draft.err;
  EXPECT_TRUE(json::parse(draft.out)["tried"].is_null());
}

TEST_F(CommandLine, SolveSaysWhyATaskCannotBePassed) {
  std::string text = read_text_file(k_block);
  text.replace(text.find("time_limit_s = 120"), 18, "time_limit_s = 8");
  write_text_file(path("hasty.toml"), text);
  const std::string tooth = " --tooth " + std::string(CAVUM_SOURCE_DIR) + "/tests/replay/block.cvt";
  const Ran check = run("scenario check --no-trial " + path("hasty.toml") + tooth);
  EXPECT_EQ(check.exit_code, 0) << "warnings alone are no mistakes\n" << check.out;
  EXPECT_NE(check.out.find("hasty.toml:7:16: "), std::string::npos) << check.out;
  const Ran solve =
      run("scenario solve --json " + path("hasty.toml") + tooth + " --out " + path("hasty.cavum"));
  EXPECT_EQ(solve.exit_code, 1);
  const json solved = json::parse(solve.out);
  EXPECT_EQ(solved["finish"], "time") << solved;
  EXPECT_EQ(solved["time_s"], 8.0);
  EXPECT_EQ(solved["steps"]["completed"], 0);
  EXPECT_EQ(run("replay " + path("hasty.cavum") + " --verify").exit_code, 0);
  expect_refused("scenario solve " + path("none.toml"), {"none.toml"});
  expect_refused("scenario show " + k_block + " --out " + path("zones.png"), {"zones.png"});
  expect_refused("scenario new --tooth canine --task access --out " + path("i.toml"),
                 {"--tooth canine", "molar, premolar"});
}

TEST_F(CommandLine, SolveLetsTheCarelessCandidateFailByTheCriterionThatTheScenarioNames) {
  const std::string tooth = " --tooth " + std::string(CAVUM_SOURCE_DIR) + "/tests/replay/block.cvt";
  std::string text = read_text_file(k_block);
  text.replace(text.find("critical_above = 0.5"), 20,
               "critical_above = 0.5\n\n[careless]\nfails_by = \"perforation\"\nperforates = true");
  write_text_file(path("deep.toml"), text);
  const json deep = run_json("scenario solve " + path("deep.toml") + tooth + " --careless");
  EXPECT_EQ(deep["passed"], true);
  EXPECT_EQ(deep["careless"]["fails_by"], "perforation");
  EXPECT_EQ(deep["careless"]["caught"], true) << deep["careless"];
  EXPECT_EQ(deep["careless"]["verdict"], "fail");
  EXPECT_NE(deep["careless"]["reason"].get<std::string>().find("pulp"), std::string::npos)
      << deep["careless"]["reason"];

  // a mistake that the rubric forgives is not caught: the answer is no
  text.replace(text.find("perforates = true"), 17, "sides_mm = 0.1");
  write_text_file(path("mild.toml"), text);
  const Ran mild = run("scenario solve --json " + path("mild.toml") + tooth + " --careless");
  EXPECT_EQ(mild.exit_code, 1) << mild.out << mild.err;
  EXPECT_EQ(json::parse(mild.out)["passed"], true) << mild.out;
  EXPECT_EQ(json::parse(mild.out)["careless"]["caught"], false) << mild.out;
  expect_refused("scenario solve " + k_block + tooth + " --careless", {"block_cavity.toml: "});
}

TEST_F(CommandLine, AForceModelThatIsNoneIsNamedAsItWasWritten) {
  const std::string exam = "exam " + k_block + " --tooth " + std::string(CAVUM_SOURCE_DIR) +
                           "/tests/replay/block.cvt --candidate A --operator expert --out " +
                           path("a.cavum") + " --model ";
  expect_refused(exam + "/etc/passwd", {"--model", "'/etc/passwd'", "consistent", "paper"});
  expect_refused(exam + "nothing", {"materials/nothing.toml"});
  EXPECT_FALSE(fs::exists(path("a.cavum")));
}

/// A stylus that drills a block from above, rests with the handpiece off between 6 s and 10 s, and
/// drills on to 20 s. Button 2 goes down at 8.000 s and at 9.500 s.
std::string drilling_with_a_break() {
  std::string csv = "t_s,x_mm,y_mm,z_mm,qw,qx,qy,qz,pedal,b1,b2\n";
  char line[120];
  for (int i = 0; i <= 2000; ++i) {
    const double t = i * 0.01;
    const double z = t < 1    ? 2 - 1.5 * t
                     : t < 6  ? 0.5 - 0.3 * (t - 1)
                     : t < 10 ? 2
                              : 2 - 0.4 * (t - 10);
    const bool drills = (t >= 1 && t < 6) || t >= 10,
               button = (i >= 800 && i < 820) || (i >= 950 && i < 960);
    std::snprintf(line, sizeof line, "%.3f,0,0,%.5f,1,0,0,0,%d,0,%d\n", t, z, drills ? 1 : 0,
                  button ? 1 : 0);
    csv += line;
  }
  return csv;
}

TEST_F(CommandLine, LimitPauseAndExtraTimeAreExactToTheTickAndRecorded) {
  std::string text = read_text_file(k_block);
  text.replace(text.find("time_limit_s = 120"), 18,
               "time_limit_s = 10\n[pauses]\ncount = 1\nlongest_s = 60\n");
  write_text_file(path("pause.toml"), text);
  write_text_file(path("break.csv"), drilling_with_a_break());
  const std::string exam =
      "exam " + path("pause.toml") + " --tooth " + std::string(CAVUM_SOURCE_DIR) +
      "/tests/replay/block.cvt --candidate A --json --motion " + path("break.csv") + " --out ";
  const Ran plain = run(exam + path("plain.cavum"));
  ASSERT_EQ(plain.exit_code, 0) << plain.err;
  const json without = json::parse(plain.out);
  EXPECT_EQ(without["time_s"], 10.0);
  EXPECT_EQ(without["finish"], "time");
  EXPECT_FALSE(without.contains("accommodations"));
  EXPECT_EQ(without["late_work"]["ticks"], 20001 - 11500);
  const Ran longer = run(exam + path("longer.cavum") +
                         " --extra-time-percent 10 --extra-time-s 0.501 --left-handed --report " +
                         path("longer.html"));
  ASSERT_EQ(longer.exit_code, 0) << longer.err;
  const json with = json::parse(longer.out);
  EXPECT_EQ(with["time_s"], 11.501);
  EXPECT_EQ(with["time_limit_s"], 11.501);
  EXPECT_EQ(with["pauses"]["ticks"], 1500);
  EXPECT_EQ(with["pauses"]["list"][0]["from_tick"], 8000);
  EXPECT_EQ(with["accommodations"]["left_handed"], true);
  EXPECT_EQ(with["accommodations"]["extra_time_s"], 0.501);
  EXPECT_NE(read_text_file(path("longer.html")).find("11.5 s"), std::string::npos) << "its limit";
  EXPECT_EQ(SessionReader(path("plain.cavum")).inputs().size(), 11500u);
  EXPECT_EQ(SessionReader(path("longer.cavum")).inputs().size(), 13001u);
  EXPECT_EQ(run("replay " + path("longer.cavum") + " --verify").exit_code, 0);
  const Ran again = run("grade " + path("longer.cavum") + " --json");
  json stored = json::parse(again.out);
  EXPECT_EQ(stored["accommodations"], with["accommodations"]);
  EXPECT_EQ(stored["score"], with["score"]);
  expect_refused("exam " + path("pause.toml") + " --candidate A --motion " + path("break.csv") +
                     " --extra-time-percent 900 --out " + path("no.cavum"),
                 {"900"});
}

TEST_F(CommandLine, NoviceLosesPointsWithTheWallNamed) {
  const json result = exam(k_data + "/scenarios/molar_access.toml", "novice", coarse_molar());
  EXPECT_NE(result["verdict"], "pass");
  EXPECT_LT(result["score"]["points"], 0.8 * result["score"]["max"].get<double>());
  EXPECT_TRUE(lost_at_a_wall(result)) << result["criteria"];
}

TEST_F(CommandLine, PerforatorFailsAndForceAndTissueAgreeWithin100Milliseconds) {
  const json result = exam(k_data + "/scenarios/molar_access.toml", "perforator", coarse_molar());
  EXPECT_EQ(result["verdict"], "fail");
  EXPECT_TRUE(result["perforation"]["detected"]);
  EXPECT_TRUE(result["perforation"]["truth"]["perforated"]);
  EXPECT_LE(best_gap_s(result), 0.1);
}

TEST_F(CommandLine, AMolarThatCameAsMeshesTakesTheSameExam) {
  import_molar(path("imported.cvt"));
  if (HasFatalFailure() || IsSkipped()) return;
  const std::string scenario = k_data + "/scenarios/molar_access.toml",
                    tooth = "--tooth " + path("imported.cvt");
  EXPECT_EQ(exam(scenario, "expert", tooth)["verdict"], "pass");
  std::string junit_says = "tests=\"1\"";
  if (std::getenv("CAVUM_DEEP") != nullptr) {
    const json novice = exam(scenario, "novice", tooth);
    EXPECT_NE(novice["verdict"], "pass");
    EXPECT_TRUE(lost_at_a_wall(novice)) << novice["criteria"];
    const json perforator = exam(scenario, "perforator", tooth);
    EXPECT_EQ(perforator["verdict"], "fail");
    EXPECT_LE(best_gap_s(perforator), 0.1);
    junit_says = "tests=\"3\"";
  }
  const Ran replay =
      run("replay " + folder_.path().string() + " --verify --json --junit " + path("j.xml"));
  EXPECT_EQ(replay.exit_code, 0) << replay.out;
  EXPECT_NE(read_text_file(path("j.xml")).find(junit_says), std::string::npos);
}

TEST_F(CommandLine, AnExamKilledAtRandomMomentsIsResumed) {
  Random random(testing_basics::drawn_seed("CommandLine.AnExamKilledAtRandomMomentsIsResumed"));
  for (int i = std::getenv("CAVUM_DEEP") != nullptr ? 20 : 8; i > 0; --i) {
    const std::string session = path("killed" + std::to_string(i) + ".cavum");
    const pid_t child = fork();
    if (child == 0) {
      std::freopen("/dev/null", "w", stdout);
      execl(CAVUM_BINARY, CAVUM_BINARY, "exam", k_block.c_str(), "--candidate", "killed",
            "--operator", "expert", "--out", session.c_str(), "--quiet", nullptr);
      _exit(127);
    }
    usleep(static_cast<useconds_t>(20'000 + random.below(900'000)));
    kill(child, SIGKILL);
    int status = 0;
    waitpid(child, &status, 0);
    if (!fs::exists(session)) continue;  // killed before the exam began: nothing to lose
    if (WIFEXITED(status)) continue;     // was done before the kill
    const Ran resumed = run("exam --resume --end --out " + session + " --json");
    if (resumed.exit_code == 2 && SessionReader(session).seal())
      continue;  // it was closed just before the kill
    EXPECT_EQ(resumed.exit_code, 0) << resumed.err;
    const Ran replay = run("replay " + session + " --verify --json");
    EXPECT_EQ(replay.exit_code, 0) << replay.out;
  }
}

TEST_F(CommandLine, AResumedExamKeepsWhatItsSessionHoldsAndNamesItsNewSource) {
  const std::string session = path("killed.cavum");
  const pid_t child = fork();
  if (child == 0) {
    std::freopen("/dev/null", "w", stdout);
    execl(CAVUM_BINARY, CAVUM_BINARY, "exam", k_block.c_str(), "--candidate", "anna", "--operator",
          "expert", "--out", session.c_str(), "--quiet", nullptr);
    _exit(127);
  }
  const auto begun = [&] {
    try {
      return SessionReader(session).findings().empty() && SessionReader(session).ticks() > 0;
    } catch (const std::exception&) {
      return false;
    }
  };
  int status = 0;
  for (int i = 0; i < 10'000 && !begun(); ++i) usleep(1000);
  kill(child, SIGKILL);
  waitpid(child, &status, 0);
  ASSERT_TRUE(WIFSIGNALED(status)) << "the exam was over before it was killed";

  write_text_file(path("other.toml"), read_text_file(k_block) + "\n# another one\n");
  write_text_file(path("other.cvt"), "another tooth");
  write_text_file(
      path("beyond.csv"),
      "t_s,x_mm,y_mm,z_mm,qw,qx,qy,qz,pedal,bur\n0,0,0,5,1,0,0,0,0,0\n1,0,0,4,1,0,0,0,0,2\n");
  write_text_file(path("go_on.csv"),
                  "t_s,x_mm,y_mm,z_mm,qw,qx,qy,qz,pedal\n0,0,0,5,1,0,0,0,0\n0.1,0,0,4,1,0,0,0,0\n");
  const std::string resume = "exam --resume --end --out " + session + " ";
  expect_refused("grade " + session, {session});
  expect_refused(resume + "--candidate berta", {"--candidate berta", "'anna'"});
  expect_refused("exam " + path("other.toml") + " --resume --end --out " + session, {"other.toml"});
  expect_refused(resume + "--tooth " + path("other.cvt"), {"--tooth", "other.cvt"});
  expect_refused(resume + "--model paper", {"--model paper"});
  expect_refused(resume + "--rubric " + path("other.toml"), {"--rubric", "other.toml"});
  expect_refused("exam --resume --out " + session + " --motion " + path("beyond.csv"),
                 {"beyond.csv:3", "2"});
  expect_refused("exam --resume --out " + session + " --operator wizard", {"wizard"});

  const Ran resumed =
      run("exam " + k_block + " --resume --candidate anna --model consistent --motion " +
          path("go_on.csv") + " --json --out " + session);
  ASSERT_EQ(resumed.exit_code, 0) << resumed.err;
  int gaps = 0;
  const SessionReader done(session);
  for (const auto& row : done.event_rows())
    if (const auto* gap = row.as<RecordingGap>()) {
      ++gaps;
      EXPECT_EQ(gap->by.source, (MotionSource{SourceKind::motion_file, "go_on.csv", ""}));
      EXPECT_EQ(gap->by.notes, (Notes{{"motion_file", "go_on.csv"}}));
    }
  EXPECT_EQ(gaps, 1) << "a refused call leaves no gap";
  EXPECT_EQ(run("replay " + session + " --verify").exit_code, 0);
  expect_refused(resume + "--candidate berta", {session});
}

TEST_F(CommandLine, BadInputEndsWithOneLineAndExit2) {
  const std::string out = " --candidate c --out " + path("x.cavum");
  for (const auto& [command, parts] : std::vector<std::pair<std::string, std::vector<std::string>>>{
           {"grade " + path("nothing.cavum"), {"nothing.cavum"}},
           {"exam " + path("nothing.toml") + " --operator expert" + out, {"nothing.toml"}},
           {"exam " + k_block + " --operator wizard" + out, {"wizard"}},
           {"exam " + k_block + out, {}},
           {"tooth info " + k_block, {"block_cavity.toml"}},
           {"nonsense", {"nonsense"}},
           {"exam --resume --out " + path("x.cavum"), {}}})
    expect_refused(command, parts);
  const auto motion = [&](const std::string& text) {
    write_text_file(path("m.csv"), text);
    return "exam " + k_block + " --motion " + path("m.csv") + out;
  };
  const std::string head = "t_s,x_mm,y_mm,z_mm,qw,qx,qy,qz,pedal\n0,0,0,5,1,0,0,0,0\n";
  const std::string with_bur =
      "\xef\xbb\xbf# a comment\r\n\r\nt_s,x_mm,y_mm,z_mm,qw,qx,qy,qz,pedal,bur\r\n0,0,0,5,1,0,0,0,0,1\r\n# more\r\n";
  for (const auto& [text, parts] : std::vector<std::pair<std::string, std::vector<std::string>>>{
           {head + "1,nan,0,0,1,0,0,0,0\n", {"m.csv:3", "x_mm"}},
           {head + "1,0,0,0,1,0,0,0,1.5\n", {"m.csv:3", "pedal"}},
           {"t_s,x_m,y_m,z_m,qw,qx,qy,qz,pedal\n0,0,0,5,1,0,0,0,0\n", {"m.csv:1", "x_m", "x_mm"}},
           {head + "1,0.01,0,5,1,0,0,0,0\n", {"m.csv"}},
           {with_bur + "1,0,0,4,1,0,0,0,0,2\r\n", {"m.csv:6", "2", "2"}},
           {with_bur + "1,0,0,4,1,0,0,0,0,0.5\r\n", {"m.csv:6", "bur"}},
           {with_bur + "1,0,0,4,1,0,0,0,0,-2\r\n", {"m.csv:6", "bur"}},
           {with_bur + "1,0,0,4,1,0,0,0,0,first\r\n", {"m.csv:6", "bur"}},
           {"# bur = chisel\n" + head + "1,0,0,0,1,0,0,0,0\n", {"chisel"}}})
    expect_refused(motion(text), parts);
  EXPECT_FALSE(fs::exists(path("x.cavum"))) << "nothing was begun";
}

TEST_F(CommandLine, TeethThatCannotBeBuiltAreRefusedAndNothingIsWritten) {
  const std::string out = " --json --out " + path("t.cvt");
  for (const auto& [tooth, parts] : std::vector<std::pair<std::string, std::vector<std::string>>>{
           {"block --size-mm 1,1,1 --layers enamel:1 --leaf-mm 2", {"2"}},
           {"block --size-mm 1,1,1 --layers enamel:0.96,dentin:0.04", {"dentin"}},
           {"cube --edge-mm 0", {"0"}},
           {"block --size-mm 1,1,1 --layers $(printf 'ena\\377mel'):1", {"--layers"}},
           {"cube --tissue $(printf 'a\\033b')", {}},
           {"molar --seed 7 --canals 4", {"--canals", "--seed"}},
           {"incisor --seed -7", {"--seed"}}})
    expect_refused("tooth make " + tooth + out, parts);
  EXPECT_FALSE(fs::exists(path("t.cvt")));
}

TEST_F(CommandLine, ATissueThatNoMaterialSetKnowsIsNamedButBuilt) {
  const std::string make =
      "tooth make block --size-mm 1,1,1 --leaf-mm 0.1 --json --out " + path("t.cvt");
  const Ran slip = run(make + " --layers enamle:1");
  EXPECT_EQ(slip.exit_code, 0);
  EXPECT_TRUE(json::accept(slip.out)) << "standard output stays JSON";
  EXPECT_EQ(std::count(slip.err.begin(), slip.err.end(), '\n'), 1) << slip.err;
  EXPECT_NE(slip.err.find("'enamel'"), std::string::npos) << slip.err;
  const Ran own = run(make + " --layers gutta-percha:1");
  EXPECT_EQ(own.exit_code, 0);
  EXPECT_NE(own.err.find("dentin, enamel"), std::string::npos) << own.err;
  EXPECT_EQ(run(make + " --layers enamel:0.4,lesion:0.3,pulp:0.3").err, "");
}

TEST_F(CommandLine, ImportNamesTheFirstThingThatIsWrong) {
  if (!can_import()) GTEST_SKIP() << "built without import";
  const std::string out = " --out " + path("t.cvt"), mesh = path("mesh.stl");
  write_text_file(mesh, "");
  expect_refused("tooth import --enamel ." + out, {".: "});
  expect_refused("tooth import --enamel " + path("nope.stl") + out, {"nope.stl: "});
  expect_refused("tooth import --enamel " + mesh + out, {"--dentin", "--pulp"});
  expect_refused("tooth import --enamel " + mesh + " --pulp " + mesh + out, {"--dentin"});
}

TEST_F(CommandLine, PlacesThatCannotBeWrittenAreNamedBeforeTheWork) {
  const std::string who = " --candidate c --operator expert --out ", missing = path("none/r.html"),
                    session = path("x.cavum");
  expect_refused("exam " + k_block + who + session + " --report " + missing, {"r.html"});
  expect_refused("exam " + k_block + who + session + " --report " + folder_.path().string(),
                 {folder_.path().string()});
  expect_refused("exam " + k_block + who + session + " --report " + session, {"--report"});
  expect_refused("exam " + k_block + who + path("none/x.cavum"), {"x.cavum"});
  EXPECT_FALSE(fs::exists(session)) << "no exam was begun";
  // the place comes first: what would take long, the session, is not even there
  expect_refused("exam --resume --end --out " + session + " --report " + missing, {"r.html"});
  expect_refused("replay " + session + " --verify --junit " + path("none/j.xml"), {"j.xml"});
  expect_refused("report " + session + " --out " + missing, {"r.html"});
}

TEST_F(CommandLine, AStationKeyThatIsNoKeyIsRefused) {
  static_cast<void>(exam(k_block, "expert"));
  const std::string replay = "replay " + path("expert.cavum") + " --verify --json";
  for (const char* wrong : {"zz", "''", "0123"})
    expect_refused(replay + " --station-key " + wrong, {"--station-key", "64"});
  std::string key = json::parse(run(replay).out)["station_key"];
  std::transform(key.begin(), key.end(), key.begin(),
                 [](char c) { return c >= 'a' ? static_cast<char>(c - 'a' + 'A') : c; });
  EXPECT_EQ(run(replay + " --station-key " + key).exit_code, 0) << "upper case is the same key";
  EXPECT_EQ(run(replay + " --station-key " + std::string(64, '0')).exit_code, 1);
}

TEST_F(CommandLine, ADamagedScenarioInsideASessionIsOneLine) {
  static_cast<void>(exam(k_block, "expert"));
  std::string bytes = read_text_file(path("expert.cavum"));
  const auto at = bytes.find("title = \"Round cavity");
  ASSERT_NE(at, std::string::npos);
  bytes.replace(at, 5, "\n\n\n\n\n");
  write_text_file(path("expert.cavum"), bytes);
  expect_refused("grade " + path("expert.cavum"), {"expert.cavum", "scenario.toml"});
  expect_refused("report " + path("expert.cavum") + " --out " + path("r.html"),
                 {"expert.cavum", "scenario.toml"});
}

TEST_F(CommandLine, AScenarioWithManyMistakesIsOneLineAndItsFileNamesAreShownSafely) {
  write_text_file(path("bad.toml"), "id = 3\nfoo = 2\n\"two\\nlines\" = 1\n");
  expect_refused(
      "exam " + path("bad.toml") + " --candidate c --operator expert --out " + path("x.cavum"),
      {"bad.toml:1:1"});
  expect_refused(
      "exam $(printf 'a\\nb.toml') --candidate c --operator expert --out " + path("x.cavum"),
      {"b.toml"});
  expect_refused("exam " + k_block + " --candidate $(printf 'c\\377') --operator expert --out " +
                     path("x.cavum"),
                 {"--candidate"});
}

TEST_F(CommandLine, JUnitIsSoundXmlWhateverAFileIsCalled) {
  write_text_file(path("a&b<\xff\x01"
                       "z\xc3\xa4hne.cavum"),
                  "no session");
  EXPECT_EQ(
      run("replay " + folder_.path().string() + " --verify --junit " + path("j.xml")).exit_code, 1);
  EXPECT_NE(read_text_file(path("j.xml")).find("a&amp;b&lt;??z\xc3\xa4hne.cavum"),
            std::string::npos)
      << read_text_file(path("j.xml"));
}

TEST_F(CommandLine, AMotionFileDrillsAndAnExistingSessionIsNotOverwritten) {
  std::ostringstream csv;
  csv << "# bur = "
         "round-1.0\nt_s,x_mm,y_mm,z_mm,qw,qx,qy,qz,pedal\n0,0,0,1,1,0,0,0,1\n2,0,0,0.1,1,0,0,0,1\n8,0,0,-1.4,1,0,0,0,1\n9,0,0,2,1,0,0,0,0\n";
  write_text_file(path("m.csv"), csv.str());
  const std::string call = "exam " + k_block + " --motion " + path("m.csv") +
                           " --candidate c --out " + path("m.cavum") + " --json";
  const Ran first = run(call);
  ASSERT_EQ(first.exit_code, 0) << first.err;
  const json result = json::parse(first.out);
  EXPECT_GT(result["volumes"]["removed_mm3"], 0.3);
  EXPECT_EQ(result["steps"]["completed"], 0);
  EXPECT_EQ(result["notes"][0]["kind"], "steps_open");
  EXPECT_EQ(result["notes"][0]["values"], (json{{"open", 1}, {"steps", 1}}));
  expect_refused(call, {"m.cavum"});
  EXPECT_EQ(run("replay " + path("m.cavum") + " --verify").exit_code, 0);
}

TEST_F(CommandLine, TheMotionOfAnExamGivesItsMarksAgainToTheLastDigit) {
  const json sat = exam(k_block, "expert");
  ASSERT_EQ(run("session export " + path("expert.cavum") + " --motion " + path("m.csv")).exit_code,
            0);
  EXPECT_EQ(run("exam " + k_block + " --motion " + path("m.csv") + " --candidate test --out " +
                path("again.cavum") + " --json")
                .exit_code,
            0);
  const auto graded = [&](const std::string& session) {
    json j = json::parse(run("grade " + path(session) + " --json").out);
    j.erase("file");
    return j;
  };
  EXPECT_EQ(graded("expert.cavum"), graded("again.cavum"));
  EXPECT_EQ(sat["score"], graded("again.cavum")["score"]);
  // without the encoder's step the tip is taken as exact, and another exam comes of it
  std::string text = read_text_file(path("m.csv"));
  write_text_file(path("exact.csv"), text.substr(text.find("t_s,")));
  EXPECT_EQ(run("exam " + k_block + " --motion " + path("exact.csv") + " --candidate test --out " +
                path("exact.cavum"))
                .exit_code,
            0);
  EXPECT_NE(graded("expert.cavum")["force"], graded("exact.cavum")["force"]);
  expect_refused("session export " + path("m.csv") + " --motion " + path("n.csv"), {"m.csv"});
}

TEST_F(CommandLine, APerforatorWithoutAWayThroughIsRefused) {
  expect_refused("exam " + k_data +
                     "/scenarios/premolar_access.toml --candidate c --operator perforator --out " +
                     path("x.cavum"),
                 {"premolar_access.toml"});
  EXPECT_FALSE(fs::exists(path("x.cavum")));
}

TEST_F(CommandLine, MistakesAreNamedWithTheFileTheyAreIn) {
  const std::string exam =
      "exam " + k_block + " --candidate c --operator expert --out " + path("x.cavum");
  expect_refused(exam + " --tooth " + k_block, {"block_cavity.toml: "});
  std::ifstream in(k_data + "/materials/paper.toml");
  std::string bad{std::istreambuf_iterator<char>(in), {}};
  bad.replace(bad.find("rpm_ref"), 7, "rpm_rex");
  write_text_file(path("bad_model.toml"), bad);
  expect_refused(exam + " --model " + path("bad_model.toml"), {path("bad_model.toml") + ":"});
  EXPECT_FALSE(fs::exists(path("x.cavum")));
  expect_refused(exam + " --seed -1", {"--seed"});
}

TEST_F(CommandLine, PlacesToWriteAreLookedAtBeforeTheWorkAndDevicesAreNeverReplaced) {
  ASSERT_EQ(std::system(("mkfifo " + path("pipe")).c_str()), 0);
  const std::string cube = "tooth make cube --edge-mm 1 --leaf-mm 0.1 --out ";
  expect_refused(cube + path("pipe"), {path("pipe")});
  EXPECT_TRUE(fs::is_fifo(path("pipe")));
  ASSERT_EQ(run(cube + path("cube.cvt")).exit_code, 0);
  // what is wrong with the work itself would be found later
  for (const char* verb :
       {"tooth make cube --edge-mm -1 --out ", "tooth make block --size-mm 1,1,-1 --out ",
        "tooth make molar --leaf-mm -1 --out "})
    expect_refused(verb + path("none/a.cvt"), {path("none")});
  expect_refused("tooth mesh " + path("none.cvt") + " --out " + path("none/a.stl"), {path("none")});
}

TEST_F(CommandLine, ABlockOfPartLeavesSaysWhatIsCounted) {
  const Ran r =
      run("tooth make block --size-mm 1,1,1.03 --layers dentin:1.03 --leaf-mm 0.05 --out " +
          path("b.cvt"));
  EXPECT_EQ(r.exit_code, 0);
  for (const char* mm : {"1.03 mm", "1.05 mm"})
    EXPECT_NE(r.err.find(mm), std::string::npos) << r.err;
  EXPECT_EQ(run("tooth make block --size-mm 1,1,1.05 --layers dentin:1.05 --leaf-mm 0.05 --out " +
                path("b.cvt"))
                .err,
            "");
}

TEST_F(CommandLine, OfTwoExamsBegunUnderOneNameOneGoesOn) {
  const std::string exam = std::string(CAVUM_BINARY) + " exam " + k_block +
                           " --operator expert --quiet --out " + path("one.cavum") +
                           " --candidate ";
  const std::string both = exam + "a >" + path("o1") + " 2>" + path("e1") + " & first=$!; " + exam +
                           "b >" + path("o2") + " 2>" + path("e2") +
                           "; b=$?; wait $first; echo $? $b >" + path("codes");
  for (int i = 0; i < 3; ++i) {
    fs::remove(path("one.cavum"));
    ASSERT_EQ(std::system(both.c_str()), 0);
    const std::string codes = read_text_file(path("codes")),
                      errors = read_text_file(path("e1")) + read_text_file(path("e2"));
    EXPECT_TRUE(codes == "0 2\n" || codes == "2 0\n") << codes << errors;
    EXPECT_NE(errors.find(path("one.cavum")), std::string::npos) << errors;
    EXPECT_EQ(run("replay " + path("one.cavum") + " --verify").exit_code, 0);
  }
}

TEST_F(CommandLine, WrongSeedsFoldersAndFilesThatAreNoTextAreNamedPlainly) {
  const std::string exam =
      "exam " + k_block + " --candidate a --operator expert --out " + path("o.cavum");
  for (const char* seed : {"-1", "99999999999999999999999", "1.5", "abc"}) {
    for (const std::string& verb : {exam, "scenario solve " + k_block})
      expect_refused(verb + " --seed " + seed,
                     {"'" + std::string(seed) + "'", "18446744073709551615"});
  }
  std::filesystem::create_directory(path("folder"));
  expect_refused("scenario new --out " + path("folder"), {"folder: "});
  write_text_file(path("bin.csv"), std::string("CVT\0\x01\x02\n", 7));
  expect_refused("exam " + k_block + " --candidate a --motion " + path("bin.csv") + " --out " +
                     path("o.cavum"),
                 {"bin.csv: "});
}

}  // namespace
}  // namespace cavum::ui
