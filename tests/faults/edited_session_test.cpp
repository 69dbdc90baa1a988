// Someone opens a closed session in an SQLite shell and improves it. Every edit is detected, and
// the finding names what was edited.
#include <gtest/gtest.h>

#include <algorithm>
#include <set>

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

class EditedSession : public ::testing::Test {
 protected:
  void SetUp() override { test::make_closed_session(path_, 2600); }

  VerifyReport edited(const std::string& sql) {
    test::tamper(path_, sql);
    VerifyReport report = verify_session(path_);
    EXPECT_FALSE(report.verified) << sql.substr(0, 200);
    EXPECT_FALSE(report.intact);
    return report;
  }
  /// Expects a finding that tells all of `values`.
  void expect_finding(const VerifyReport& report, const std::vector<Value>& values) {
    EXPECT_TRUE(std::any_of(report.findings.begin(), report.findings.end(), [&](const Damage& f) {
      return std::all_of(values.begin(), values.end(),
                         [&f](const Value& v) { return testing_basics::tells(f.message(), v); });
    })) << testing_basics::text_of(report.findings);
  }
  /// The number of a chunk, a tick.
  static Value at(std::int64_t number) { return number; }

  test::Folder folder_;
  std::string path_ = folder_.file("exam.cavum");
};

TEST_F(EditedSession, UnchangedIsVerified) { EXPECT_TRUE(verify_session(path_).verified); }

TEST_F(EditedSession, PoseIsNamedByChunkAndTick) {
  const Bytes inputs = lifted_inputs(SessionReader(path_), 1, 345);
  const auto report = edited("UPDATE chunk SET inputs = " + blob(inputs) + " WHERE seq = 1");
  expect_finding(report, {at(1), at(1000), at(1999)});
  ASSERT_TRUE(report.first_divergence);
  EXPECT_EQ(report.first_divergence->tick, 1345);
  EXPECT_NE(report.first_divergence->recorded, report.first_divergence->replayed);
  expect_finding(report, {at(1345), Name{report.first_divergence->what}});
}

TEST_F(EditedSession, ForceRecordIsNamedByTickAndField) {
  auto records = SessionReader(path_).motion(2).records;
  records[77].model_un += 5;
  const auto report =
      edited("UPDATE chunk SET records = " + blob(pack_records(records)) + " WHERE seq = 2");
  expect_finding(report, {at(2), at(2000)});
  ASSERT_TRUE(report.first_divergence);
  EXPECT_EQ(report.first_divergence->tick, 2077);
  EXPECT_EQ(report.first_divergence->what, "model_force");
  EXPECT_EQ(report.ticks_different, 1);
}

TEST_F(EditedSession, RemovedLeafIsNamedByTick) {
  auto removed = SessionReader(path_).motion(1).removed;
  ASSERT_FALSE(removed.leaves.empty());
  removed.leaves.front().tissue = k_pulp;
  const auto report =
      edited("UPDATE chunk SET removed = " + blob(pack_removed(removed)) + " WHERE seq = 1");
  expect_finding(report, {at(1), at(1000)});
  ASSERT_TRUE(report.first_divergence);
  EXPECT_EQ(report.first_divergence->what, "removed_leaf");
}

TEST_F(EditedSession, EachPartOfAChunkIsNamedInItsOwnWords) {
  const Bytes intact = read_file(path_);
  std::set<DamageKind> parts;
  for (const char* part :
       {"inputs = x'00'", "records = x'00'", "removed = x'00'", "utc_ns = utc_ns - 1"}) {
    write_file(path_, intact);
    test::tamper(path_, std::string("UPDATE chunk SET ") + part + " WHERE seq = 1");
    for (const Damage& d : verify_session(path_).findings) parts.insert(d.kind);
  }
  using enum DamageKind;
  for (const DamageKind kind : {chunk_inputs, chunk_records, chunk_removed, chunk_facts})
    EXPECT_TRUE(parts.contains(kind)) << rows_of(kind)[static_cast<std::size_t>(kind)].name;
}

TEST_F(EditedSession, EventIsNamed) {
  expect_finding(edited("UPDATE event SET tick = tick - 1 WHERE seq = 2"), {at(1), at(1000)});
}
TEST_F(EditedSession, EventDetailIsNamed) {
  expect_finding(edited("UPDATE event SET detail_json = '{\"step\":9}' WHERE seq = 0"),
                 {at(0), at(999)});
}
TEST_F(EditedSession, AddedEventIsNamed) {
  const auto report = edited("INSERT INTO event VALUES (4, 2590, 2, 'time_limit', '{}')");
  expect_finding(report, {at(5), at(4)});
}
TEST_F(EditedSession, EventOfNoChunkIsNamed) {
  expect_finding(edited("INSERT INTO event VALUES (4, 2590, 77, 'time_limit', '{}')"),
                 {at(4), at(2590)});
}
TEST_F(EditedSession, ClockIsNamed) {
  expect_finding(edited("UPDATE chunk SET utc_ns = utc_ns - 3600000000000 WHERE seq = 1"),
                 {at(1), at(1000)});
}
TEST_F(EditedSession, ClosingClockIsNamed) {
  EXPECT_FALSE(edited("UPDATE seal SET utc_ns = utc_ns - 1").findings.empty());
}
TEST_F(EditedSession, ScenarioIsNamed) {
  expect_finding(
      edited(
          "UPDATE artifact SET bytes = CAST('title = \"easy\"' AS BLOB), size_bytes = 14 WHERE name = 'scenario.toml'"),
      {Name{"scenario.toml"}});
}
TEST_F(EditedSession, ScenarioWithItsHashIsNamed) {
  const std::string text = "title = \"easy\"";
  const auto report = edited("UPDATE artifact SET bytes = CAST('" + text +
                             "' AS BLOB), size_bytes = 14, sha256 = " + blob(sha256(text)) +
                             " WHERE name = 'scenario.toml'");
  EXPECT_FALSE(report.findings.empty());
}
TEST_F(EditedSession, CandidateIsNamed) {
  EXPECT_FALSE(
      edited("UPDATE meta SET value = 'candidate-8' WHERE key = 'candidate'").findings.empty());
}
TEST_F(EditedSession, ResultIsNamed) {
  EXPECT_FALSE(edited("UPDATE result SET json = replace(json, '83', '93')").findings.empty());
}
TEST_F(EditedSession, FinalToothIsNamedByHashAndByReplay) {
  Tooth other = test::block_tooth();  // as if nothing had been drilled but one leaf
  std::vector<RemovedLeaf> removed;
  removed.reserve(10'000);
  other.octree.reserve_edits(100);
  ASSERT_TRUE(other.octree.carve(
      {-0.2, -0.2, -0.2}, {0.2, 0.2, 0.2}, [](Vec3 p) { return length(p) - 0.05; }, removed));
  const Bytes bytes = save_tooth(other);
  const auto report = edited("UPDATE artifact SET bytes = " + blob(bytes) + ", size_bytes = " +
                             std::to_string(bytes.size()) + ", sha256 = " + blob(sha256(bytes)) +
                             " WHERE name = 'final_tooth.cvt'");
  EXPECT_EQ(report.findings.size(), 2u) << testing_basics::text_of(report.findings);
}
TEST_F(EditedSession, StateHashIsNamed) {
  const auto report = edited("UPDATE chunk SET state_hash = state_hash + 1 WHERE seq = 0");
  expect_finding(report, {at(0), at(999)});
}
TEST_F(EditedSession, ChunkTakenOutIsNamed) {
  expect_finding(edited("DELETE FROM event; DELETE FROM chunk WHERE seq = 1"), {at(1)});
}
TEST_F(EditedSession, EndCutOffIsNamed) {
  expect_finding(edited("DELETE FROM event WHERE chunk = 2; DELETE FROM chunk WHERE seq = 2"),
                 {at(2000), at(2600)});
}
TEST_F(EditedSession, SealTakenOffIsNamed) {
  EXPECT_FALSE(edited("DELETE FROM seal").findings.empty());
}
TEST_F(EditedSession, SealAndResultTakenOffIsNotVerified) {
  test::tamper(
      path_,
      "DELETE FROM seal; DELETE FROM result; DELETE FROM artifact WHERE name = 'final_tooth.cvt'; DELETE FROM event WHERE chunk = 2;"
      "DELETE FROM chunk WHERE seq = 2");
  const VerifyReport report = verify_session(path_);
  EXPECT_FALSE(report.verified)
      << "now it reads like an interrupted exam, and such a one is not verified";
  EXPECT_FALSE(report.closed);
}
TEST_F(EditedSession, AnotherTableOrTriggerIsNamed) {
  test::tamper(
      path_,
      "CREATE TRIGGER t AFTER INSERT ON event BEGIN DELETE FROM event; END; UPDATE meta SET value = value");
  const VerifyReport report = verify_session(path_);
  EXPECT_FALSE(report.verified);
  EXPECT_FALSE(report.findings.empty());
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
      sql += "UPDATE chunk SET inputs = " + blob(c.inputs) +
             ", inputs_sha256 = " + blob(c.inputs_sha256) +
             ", prev_sha256 = " + blob(c.prev_sha256) + ", sha256 = " + blob(c.sha256) +
             " WHERE seq = " + std::to_string(c.seq) + ";";
    }
    seal.chain_sha256 = before;
    seal.public_key = forger.public_key;
    seal.signature = forger.sign(seal_message(seal));
    test::tamper(path_, sql + "UPDATE seal SET chain_sha256 = " + blob(seal.chain_sha256) +
                            ", public_key = " + blob(seal.public_key) +
                            ", signature = " + blob(seal.signature));
  }
  const VerifyReport report = verify_session(path_);
  EXPECT_FALSE(report.verified);
  ASSERT_TRUE(report.first_divergence);
  EXPECT_EQ(report.first_divergence->tick, 1345);
  expect_finding(report, {at(1345)});
  const VerifyReport known =
      verify_session(path_, to_hex(load_station_key(station_key_path()).public_key));
  expect_finding(known, {Name{report.station_key}});
}

}  // namespace
}  // namespace cavum
