// Someone opens a closed session in an SQLite shell and improves it. Every edit is detected, and the
// finding names what was edited.
#include <gtest/gtest.h>

#include <algorithm>

#include "engine/base/file.h"
#include "engine/session/chain.h"
#include "engine/session/session_reader.h"
#include "engine/session/verify.h"
#include "engine/tooth/octree_edit.h"
#include "tests/engine/session/fixture.h"

namespace cavum {
namespace {

std::string blob(std::span<const std::uint8_t> bytes) { return "x'" + to_hex(bytes) + "'"; }

/// Inputs of chunk `index`, with the tip lifted by 20 micrometres from tick `tick` of the chunk on.
Bytes lifted_inputs(const SessionReader& session, std::size_t index, std::size_t tick) {
  auto inputs = session.motion(index).inputs;
  for (std::size_t i = tick; i < inputs.size(); ++i) inputs[i].tip_nm[2] += 20'000;
  return pack_inputs(inputs);
}

class EditedSession : public testing::Test {
 protected:
  void SetUp() override { test::make_closed_session(path_, 2600); }

  VerifyReport edited(const std::string& sql) {
    test::tamper(path_, sql);
    VerifyReport report = verify_session(path_);
    EXPECT_FALSE(report.verified) << sql.substr(0, 200);
    EXPECT_FALSE(report.intact);
    return report;
  }
  /// Expects a finding that holds all of `words`.
  void expect_finding(const VerifyReport& report, const std::vector<std::string>& words) {
    std::string all;
    for (const auto& f : report.findings) {
      all += "  " + english_text(f) + "\n";
      if (std::all_of(words.begin(), words.end(), [&](const std::string& w) { return english_text(f).find(w) != std::string::npos; })) return;
    }
    ADD_FAILURE() << "no finding with '" << words.front() << "' in\n" << all;
  }

  test::Folder folder_;
  std::string path_ = folder_.file("exam.cavum");
};

TEST_F(EditedSession, UnchangedIsVerified) { EXPECT_TRUE(verify_session(path_).verified); }

TEST_F(EditedSession, PoseIsNamedByChunkAndTick) {
  const Bytes inputs = lifted_inputs(SessionReader(path_), 1, 345);
  const auto report = edited("UPDATE chunk SET inputs = " + blob(inputs) + " WHERE seq = 1");
  expect_finding(report, {"chunk 1 (ticks 1000 to 1999)", "motion (inputs)"});
  ASSERT_TRUE(report.first_divergence);
  EXPECT_EQ(report.first_divergence->tick, 1345);
  EXPECT_NE(report.first_divergence->recorded, report.first_divergence->replayed);
  expect_finding(report, {"tick 1345", report.first_divergence->what});
}

TEST_F(EditedSession, ForceRecordIsNamedByTickAndField) {
  auto records = SessionReader(path_).motion(2).records;
  records[77].model_un += 5;
  const auto report = edited("UPDATE chunk SET records = " + blob(pack_records(records)) + " WHERE seq = 2");
  expect_finding(report, {"chunk 2", "forces (records)"});
  ASSERT_TRUE(report.first_divergence);
  EXPECT_EQ(report.first_divergence->tick, 2077);
  EXPECT_EQ(report.first_divergence->what, "model_force");
  EXPECT_EQ(report.ticks_different, 1);
}

TEST_F(EditedSession, RemovedLeafIsNamedByTick) {
  auto removed = SessionReader(path_).motion(1).removed;
  ASSERT_FALSE(removed.leaves.empty());
  removed.leaves.front().tissue = k_pulp;
  const auto report = edited("UPDATE chunk SET removed = " + blob(pack_removed(removed)) + " WHERE seq = 1");
  expect_finding(report, {"chunk 1", "removed leaves"});
  ASSERT_TRUE(report.first_divergence);
  EXPECT_EQ(report.first_divergence->what, "removed_leaf");
}

TEST_F(EditedSession, EventIsNamed) { expect_finding(edited("UPDATE event SET tick = tick - 1 WHERE seq = 2"), {"chunk 1", "events"}); }
TEST_F(EditedSession, EventDetailIsNamed) {
  expect_finding(edited("UPDATE event SET detail_json = '{\"step\":9}' WHERE seq = 0"), {"chunk 0", "events"});
}
TEST_F(EditedSession, AddedEventIsNamed) {
  const auto report = edited("INSERT INTO event VALUES (4, 2590, 2, 'time_limit', '{}')");
  expect_finding(report, {"table event", "5 events, closed with 4"});
}
TEST_F(EditedSession, EventOfNoChunkIsNamed) {
  expect_finding(edited("INSERT INTO event VALUES (4, 2590, 77, 'time_limit', '{}')"), {"table event, row 4", "no chunk"});
}
TEST_F(EditedSession, ClockIsNamed) {
  expect_finding(edited("UPDATE chunk SET utc_ns = utc_ns - 3600000000000 WHERE seq = 1"), {"chunk 1", "clocks"});
}
TEST_F(EditedSession, ClosingClockIsNamed) { expect_finding(edited("UPDATE seal SET utc_ns = utc_ns - 1"), {"table seal", "clock"}); }
TEST_F(EditedSession, ScenarioIsNamed) {
  expect_finding(edited("UPDATE artifact SET bytes = CAST('title = \"easy\"' AS BLOB), size_bytes = 14 WHERE name = 'scenario.toml'"),
                 {"'scenario.toml' was changed"});
}
TEST_F(EditedSession, ScenarioWithItsHashIsNamed) {
  const std::string text = "title = \"easy\"";
  const auto report = edited("UPDATE artifact SET bytes = CAST('" + text + "' AS BLOB), size_bytes = 14, sha256 = " + blob(sha256(text)) +
                             " WHERE name = 'scenario.toml'");
  expect_finding(report, {"meta or artifact"});
}
TEST_F(EditedSession, CandidateIsNamed) {
  expect_finding(edited("UPDATE meta SET value = 'candidate-8' WHERE key = 'candidate'"), {"meta or artifact"});
}
TEST_F(EditedSession, ResultIsNamed) { expect_finding(edited("UPDATE result SET json = replace(json, '83', '93')"), {"table result"}); }
TEST_F(EditedSession, FinalToothIsNamedByHashAndByReplay) {
  Tooth other = test::block_tooth();  // as if nothing had been drilled but one leaf
  std::vector<RemovedLeaf> removed;
  removed.reserve(10'000);
  other.octree.reserve_edits(100);
  ASSERT_TRUE(other.octree.carve(
      {-0.2, -0.2, -0.2}, {0.2, 0.2, 0.2}, [](Vec3 p) { return length(p) - 0.05; }, removed));
  const Bytes bytes = save_tooth(other);
  const auto report = edited("UPDATE artifact SET bytes = " + blob(bytes) + ", size_bytes = " + std::to_string(bytes.size()) +
                             ", sha256 = " + blob(sha256(bytes)) + " WHERE name = 'final_tooth.cvt'");
  expect_finding(report, {"final tooth was changed"});
  expect_finding(report, {"not the one that the replay leaves"});
}
TEST_F(EditedSession, StateHashIsNamed) {
  const auto report = edited("UPDATE chunk SET state_hash = state_hash + 1 WHERE seq = 0");
  expect_finding(report, {"chunk 0", "state hash after tick 999"});
}
TEST_F(EditedSession, ChunkTakenOutIsNamed) {
  expect_finding(edited("DELETE FROM event; DELETE FROM chunk WHERE seq = 1"), {"table chunk", "number 1"});
}
TEST_F(EditedSession, EndCutOffIsNamed) {
  expect_finding(edited("DELETE FROM event WHERE chunk = 2; DELETE FROM chunk WHERE seq = 2"), {"table chunk", "2000 ticks, closed with 2600"});
}
TEST_F(EditedSession, SealTakenOffIsNamed) { expect_finding(edited("DELETE FROM seal"), {"table seal", "missing"}); }
TEST_F(EditedSession, SealAndResultTakenOffIsNotVerified) {
  test::tamper(path_,
               "DELETE FROM seal; DELETE FROM result; DELETE FROM artifact WHERE name = 'final_tooth.cvt'; DELETE FROM event WHERE chunk = 2;"
               "DELETE FROM chunk WHERE seq = 2");
  const VerifyReport report = verify_session(path_);
  EXPECT_FALSE(report.verified) << "now it reads like an interrupted exam, and such a one is not verified";
  EXPECT_FALSE(report.closed);
}
TEST_F(EditedSession, AnotherTableOrTriggerIsNamed) {
  test::tamper(path_, "CREATE TRIGGER t AFTER INSERT ON event BEGIN DELETE FROM event; END; UPDATE meta SET value = value");
  const VerifyReport report = verify_session(path_);
  EXPECT_FALSE(report.verified);
  expect_finding(report, {"schema"});
}

/// A forger with a key of his own, who makes every hash and the signature fit again.
TEST_F(EditedSession, ForgedWithAllHashesAndAnotherKeyDivergesAtItsTick) {
  {
    const SessionReader session(path_);
    const SigningKey forger = load_station_key(folder_.file("forger/station.key"));
    Seal seal = *session.seal();
    std::string sql;
    Sha256 before = session.chunks()[0].prev_sha256;
    for (ChunkRow c : session.chunks()) {
      if (c.seq == 1) c.inputs = lifted_inputs(session, 1, 345);
      c.inputs_sha256 = sha256(c.inputs);
      c.prev_sha256 = before;
      c.sha256 = before = chunk_hash(c);
      sql += "UPDATE chunk SET inputs = " + blob(c.inputs) + ", inputs_sha256 = " + blob(c.inputs_sha256) + ", prev_sha256 = " + blob(c.prev_sha256) +
             ", sha256 = " + blob(c.sha256) + " WHERE seq = " + std::to_string(c.seq) + ";";
    }
    seal.chain_sha256 = before;
    seal.public_key = forger.public_key;
    seal.signature = forger.sign(seal_message(seal));
    test::tamper(path_, sql + "UPDATE seal SET chain_sha256 = " + blob(seal.chain_sha256) + ", public_key = " + blob(seal.public_key) +
                            ", signature = " + blob(seal.signature));
  }
  const VerifyReport report = verify_session(path_);
  EXPECT_FALSE(report.verified);
  ASSERT_TRUE(report.first_divergence);
  EXPECT_EQ(report.first_divergence->tick, 1345);
  expect_finding(report, {"tick 1345"});
  const VerifyReport known = verify_session(path_, to_hex(load_station_key(station_key_path()).public_key));
  expect_finding(known, {"not by the one expected"});
}

}  // namespace
}  // namespace cavum
