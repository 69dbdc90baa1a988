// Lines of work are the same bytes whoever made them; what is damaged, missing or changed is made
// again, and nothing else.
#include <gtest/gtest.h>

#include <atomic>
#include <filesystem>
#include <nlohmann/json.hpp>

#include "engine/base/file.h"
#include "grading/marking/grade.h"
#include "grading/marking/session_input.h"
#include "grading/pool/makers.h"
#include "grading/result/result_json.h"
#include "tests/engine/support/basics.h"

namespace cavum::pool {
namespace {

using nlohmann::json;

const std::string k_sessions = std::string(CAVUM_SOURCE_DIR) + "/tests/replay/sessions/";
const std::string k_other_rubric =
    "[rubric]\nrule = \"compensatory\"\npass_percent = 10\n[[rubric.criteria]]\nid = \"removed\"\nmetric = \"target_removed_percent\"\nfull = 50\n"
    "zero = 0\npoints = 10\n";

/// Four files of two recorded exams, marked, which takes least.
class Pool : public ::testing::Test {
 protected:
  void SetUp() override {
    work_.what = What::mark;
    work_.folder = folder_.file("s");
    std::filesystem::create_directories(work_.folder);
    for (const char* name : {"a.cavum", "b.cavum", "c.cavum", "d.cavum"}) {
      const bool odd = name[0] == 'b' || name[0] == 'd';
      std::filesystem::copy_file(
          k_sessions + (odd ? "block_perforator.cavum" : "block_expert.cavum"),
          work_.folder + "/" + name);
      work_.sessions.emplace_back(name);
    }
  }
  [[nodiscard]] std::string file(const std::string& name) const { return folder_.file(name); }
  std::size_t shard(std::size_t k, std::size_t of) {
    return make_shard(work_, k, of, file(std::to_string(k) + ".part"), {.threads = 1});
  }
  static void alter(const std::string& path, std::size_t from_end) {
    Bytes bytes = read_file(path);
    bytes[bytes.size() - from_end] ^= 1;
    write_file(path, bytes);
  }
  testing_basics::Folder folder_;
  Work work_;
};

TEST_F(Pool, OneThreadFourThreadsAndThreeShardsGiveTheSameBytes) {
  work_.what = What::verify;
  const Made one = by_threads(work_, {.threads = 1}), four = by_threads(work_, {.threads = 4});
  ASSERT_EQ(one.lines.size(), 4u);
  for (const auto& line : one.lines)
    EXPECT_TRUE(json::parse(line).at("verified").get<bool>()) << line;
  EXPECT_EQ(json::parse(one.lines[1]).at("session"), "b.cavum");
  EXPECT_EQ(one.lines, four.lines);
  EXPECT_EQ(shard(1, 3) + shard(2, 3) + shard(3, 3), 4u);
  const Parts parts = read_parts(work_, {file("3.part"), file("1.part"), file("2.part")});
  for (std::size_t i = 0; i < 4; ++i) EXPECT_EQ(parts.lines[i], one.lines[i]);
}

TEST_F(Pool, SaysWhatIsMissingAndMakesADamagedRowAgain) {
  EXPECT_EQ(shard(1, 2) + shard(2, 2), 4u);
  EXPECT_EQ(read_parts(work_, {file("2.part")}).missing(), (std::vector<std::size_t>{0, 2}));
  const auto whole = read_file(file("2.part"));
  alter(file("2.part"), 20);  // in the last row
  const Parts damaged = read_parts(work_, {file("1.part"), file("2.part")});
  EXPECT_EQ(damaged.missing(), (std::vector<std::size_t>{3}));
  ASSERT_EQ(damaged.remarks.size(), 1u);
  EXPECT_TRUE(testing_basics::tells(damaged.remarks[0], 1) &&
              testing_basics::tells(damaged.remarks[0], 2))
      << damaged.remarks[0];
  EXPECT_EQ(shard(2, 2), 1u);
  EXPECT_TRUE(read_parts(work_, {file("1.part"), file("2.part")}).missing().empty());
  write_file(file("2.part"),
             std::span(whole).first(whole.size() - 300));  // cut off in the last row
  EXPECT_EQ(shard(2, 2), 1u);
  EXPECT_TRUE(read_parts(work_, {file("1.part"), file("2.part")}).missing().empty());
}

TEST_F(Pool, RowsOfOtherWorkAreNone) {
  EXPECT_EQ(shard(1, 1), 4u);
  work_.rubric_toml = k_other_rubric;
  work_.what = What::regrade;
  EXPECT_EQ(read_parts(work_, {file("1.part")}).missing().size(), 4u);
}

TEST_F(Pool, TwoLinesOfOneSessionAreRefused) {
  for (const char* word : {"one", "two"}) {
    PartWriter part(file(std::string(word) + ".part"), id_of(work_));
    part.add(2, json{{"session", "c.cavum"}, {"result", word}}.dump(), {});
  }
  EXPECT_THROW(static_cast<void>(read_parts(work_, {file("one.part"), file("two.part")})), Error);
}

TEST_F(Pool, ARunThatWasStoppedGoesOnWhereItStood) {
  std::atomic<std::size_t> made{0};
  pool::Run run{.threads = 1, .parts = file("work")};
  run.told = [&](std::size_t, std::size_t) { ++made; };
  run.stop = [&] { return made == 1; };
  const Made broken = by_threads(work_, run);
  EXPECT_EQ(broken.missing, (std::vector<std::size_t>{1, 2, 3}));
  run.stop = {};
  const Made rest = by_threads(work_, run);
  EXPECT_EQ(rest.found, 1u);
  EXPECT_EQ(made, 4u);
  EXPECT_EQ(rest.lines, by_threads(work_).lines);
}

TEST_F(Pool, ASessionThatChangedMeanwhileIsMadeAgain) {
  const pool::Run run{.parts = file("work")};
  const Made before = by_threads(work_, run);
  std::filesystem::copy_file(work_.folder + "/b.cavum", work_.folder + "/a.cavum",
                             std::filesystem::copy_options::overwrite_existing);
  const Made after = by_threads(work_, run);
  EXPECT_EQ(after.found, 3u);
  EXPECT_NE(after.lines[0], before.lines[0]);
  EXPECT_EQ(after.lines, by_threads(work_).lines);
  EXPECT_EQ(by_threads(work_, run).found, 4u);
}

TEST_F(Pool, AFileThatIsGoneIsALineInAPartToo) {
  std::filesystem::remove(work_.folder + "/d.cavum");
  EXPECT_EQ(shard(1, 2) + shard(2, 2), 4u);
  Parts parts = read_parts(work_, {file("1.part"), file("2.part")});
  leave_out_changed(work_, parts);
  ASSERT_TRUE(parts.missing().empty()) << "it is not made again for ever";
  EXPECT_EQ(*parts.lines[3], by_threads(work_).lines[3]);
  EXPECT_EQ(parts.lines[3]->find(work_.folder), std::string::npos)
      << "no place stands in it: " << *parts.lines[3];
  std::filesystem::copy_file(work_.folder + "/b.cavum", work_.folder + "/d.cavum");
  leave_out_changed(work_, parts);
  EXPECT_EQ(parts.missing(), (std::vector<std::size_t>{3})) << "it is there again";
}

TEST_F(Pool, AFileThatIsNoSessionIsALineThatSaysSo) {
  write_text_file(work_.folder + "/c.cavum", "no session");
  std::filesystem::remove(work_.folder + "/d.cavum");
  const Made made = by_threads(work_);
  EXPECT_TRUE(made.missing.empty());
  EXPECT_TRUE(json::parse(made.lines[0]).contains("result"));
  for (const std::size_t i : {2u, 3u})
    EXPECT_FALSE(json::parse(made.lines[i]).at("error").get<std::string>().empty());
}

TEST_F(Pool, ARegradeIsThatOfOneSessionAlone) {
  work_.what = What::regrade;
  work_.rubric_toml = k_other_rubric;
  const Made made = by_threads(work_);
  const auto graded = grading::load_for_grading(k_sessions + "block_perforator.cavum");
  grading::use_rubric(*graded, scenarios::parse_rubric(k_other_rubric, "rubric"));
  EXPECT_EQ(json::parse(made.lines[1]).at("result"),
            json::parse(grading::to_json(grading::grade(graded->input(), graded->rubric)).dump()));
}

TEST_F(Pool, AListOfWorkIsReadAsItWasWritten) {
  work_.what = What::regrade;
  work_.scenario_toml = "a\nb";
  work_.surfaces = {{"x.stl", {0, 255, 16}}};
  work_.another_task = true;
  Work again = parse_work(to_text(work_), "work");
  EXPECT_EQ(to_text(again), to_text(work_));
  EXPECT_EQ(again.surfaces, work_.surfaces);
  EXPECT_THROW(static_cast<void>(parse_work("{}", "work")), Error);
}

}  // namespace
}  // namespace cavum::pool
