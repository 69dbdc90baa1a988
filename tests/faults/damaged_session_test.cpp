// Files cut short and bits flipped at random: whatever a disk or a hand does to a session, reading
// it ends in an answer, and the answer is never "verified" on changed content.
#include <gtest/gtest.h>

#include <cstdio>

#include "engine/base/error.h"
#include "engine/base/file.h"
#include "engine/base/random.h"
#include "engine/session/session_reader.h"
#include "engine/session/verify.h"
#include "tests/engine/session/fixture.h"

namespace cavum {
namespace {

constexpr std::int64_t k_ticks = 1400;  // two chunks; the bur is cutting from tick 330 on

void put_clocks(ByteWriter& out, const Clocks& c) {
  for (const auto v : {c.monotonic_ns, c.boot_ns, c.utc_ns}) out.put(v);
}

/// All that a session says, decoded, as bytes; independent of the hashes inside the file. Throws on
/// damage.
Bytes content_of(const std::string& path) {
  const SessionReader s(path);
  s.require_readable();
  ByteWriter out;
  for (const auto& [key, value] : s.meta()) {
    out.put_string(key);
    out.put_string(value);
  }
  for (const auto& a : s.artifacts()) {
    out.put_string(a.name);
    out.put_bytes(a.bytes);
  }
  for (const auto& in : s.inputs()) {
    for (const auto v : in.tip_nm) out.put(v);
    for (const auto v : in.rotation_q30) out.put(v);
    out.put(in.pedal_q16);
    out.put(in.flags);
    out.put(in.bur);
  }
  for (const auto& r : s.records()) {
    for (const auto v : r.rendered_un) out.put(v);
    for (const auto v : r.proxy_nm) out.put(v);
    for (const auto v : {r.model_un, r.penetration_nm, r.rpm}) out.put(v);
    out.put(r.removed);
    out.put(r.notices);
  }
  for (const auto& r : s.removed()) {
    out.put(r.tick);
    for (const auto v : {r.leaf.x, r.leaf.y, r.leaf.z}) out.put(v);
    out.put(r.leaf.tissue);
  }
  for (const auto& c : s.chunks()) {
    out.put(c.first_tick);
    out.put(c.ticks);
    out.put(c.state_hash);
    put_clocks(out, c.clocks);
  }
  for (const auto& e : s.event_rows()) {
    out.put(e.chunk);
    out.put(e.tick);
    const EventText text = encode(e.event);
    out.put_string(text.kind);
    out.put_string(text.detail_json);
  }
  out.put_string(s.result_json());
  if (s.seal()) put_clocks(out, s.seal()->clocks);
  return out.take();
}

struct Tally {
  int unreadable = 0, findings = 0, verified = 0;
};

/// Puts `bytes` under `path` and checks that the verdict agrees with the content.
void judge(const std::string& path, const Bytes& bytes, const Bytes& original,
           const std::string& what, Tally& tally) {
  write_file(path, bytes);
  try {
    const VerifyReport report = verify_session(path);
    if (!report.verified) {
      EXPECT_FALSE(report.findings.empty()) << what << ": not verified, and no word why";
      ++tally.findings;
      return;
    }
    ++tally.verified;
    EXPECT_EQ(content_of(path), original) << what << ": verified, though its content changed";
  } catch (const Error&) {
    ++tally.unreadable;
  }
}

class DamagedSession : public ::testing::Test {
 protected:
  void SetUp() override {
    test::make_closed_session(path_, k_ticks);
    bytes_ = read_file(path_);
    content_ = content_of(path_);
  }
  test::Folder folder_;
  std::string path_ = folder_.file("exam.cavum"), damaged_ = folder_.file("damaged.cavum");
  Bytes bytes_, content_;
};

TEST_F(DamagedSession, CutAt200RandomBytesIsNeverVerified) {
  Random random(test::drawn_seed("CutAt200RandomBytesIsNeverVerified"));
  Tally tally;
  for (int run = 0; run < 200; ++run) {
    const auto size = random.below(bytes_.size());
    judge(damaged_, Bytes(bytes_.begin(), bytes_.begin() + static_cast<std::ptrdiff_t>(size)),
          content_, "cut at " + std::to_string(size), tally);
  }
  std::printf("cut: %d with findings, %d unreadable\n", tally.findings, tally.unreadable);
  EXPECT_EQ(tally.verified, 0);
  EXPECT_GT(tally.findings, 100) << "most cuts leave a header, so their damage can be named";
}

TEST_F(DamagedSession, With200RandomBitsFlippedOneByOneIsVerifiedOnlyWhenUnchanged) {
  Random random(test::drawn_seed("With200RandomBitsFlippedOneByOneIsVerifiedOnlyWhenUnchanged"));
  Tally tally;
  for (int run = 0; run < 200; ++run) {
    Bytes bytes = bytes_;
    const auto at = random.below(bytes.size());
    const auto bit = random.below(8);
    bytes[at] ^= static_cast<std::uint8_t>(1u << bit);
    judge(damaged_, bytes, content_, "byte " + std::to_string(at) + " bit " + std::to_string(bit),
          tally);
  }
  std::printf("flipped: %d with findings, %d unreadable, %d in dead bytes\n", tally.findings,
              tally.unreadable, tally.verified);
  EXPECT_GT(tally.findings, 100);
}

TEST_F(DamagedSession, WithManyBitsFlippedAtOnceIsVerifiedOnlyWhenUnchanged) {
  Random random(test::drawn_seed("WithManyBitsFlippedAtOnceIsVerifiedOnlyWhenUnchanged"));
  Tally tally;
  for (int run = 0; run < 60; ++run) {
    Bytes bytes = bytes_;
    const auto flips = 2 + random.below(run % 2 == 0 ? 8 : 400);
    // half of the runs go for the structure: page headers and cell pointers
    for (std::uint64_t i = 0; i < flips; ++i) {
      auto at = random.below(bytes.size());
      if (run % 4 < 2) at = at / 1024 * 1024 + (at < 1024 ? 100 : 0) + random.below(40);
      if (at >= 16) bytes[at % bytes.size()] ^= static_cast<std::uint8_t>(1u << random.below(8));
    }
    judge(damaged_, bytes, content_, "run " + std::to_string(run), tally);
  }
  EXPECT_LT(tally.verified, 30);
}

TEST_F(DamagedSession, WithItsPagesShuffledIsNeverVerified) {
  Random random(test::drawn_seed("WithItsPagesShuffledIsNeverVerified"));
  Tally tally;
  const std::size_t pages = bytes_.size() / 1024;
  for (int run = 0; run < 30; ++run) {
    Bytes bytes = bytes_;
    const auto from = 1 + random.below(pages - 1),
               to = 1 + random.below(pages - 1);  // a page refers to another as its own child
    std::copy_n(bytes_.begin() + static_cast<std::ptrdiff_t>(from * 1024), 1024,
                bytes.begin() + static_cast<std::ptrdiff_t>(to * 1024));
    if (bytes == bytes_) continue;
    judge(damaged_, bytes, content_, "page " + std::to_string(from) + " over " + std::to_string(to),
          tally);
  }
  EXPECT_EQ(tally.verified, 0);
}

TEST(KilledSession, WithADamagedLogIsNeverACrashNorVerified) {
  const test::Folder folder;
  Random random(test::drawn_seed("WithADamagedLogIsNeverACrashNorVerified"));
  const std::string path = folder.file("exam.cavum"), damaged = folder.file("damaged.cavum");
  const SessionSetup setup = test::block_setup();
  Simulation simulation = make_simulation(setup, "test");
  Recorder recorder = Recorder::create(path, setup);
  test::drill(simulation, recorder, 0, 2000);
  const Bytes file = read_file(path), log = read_file(path + "-wal");
  write_file(damaged, file);
  int shorter = 0;
  for (int run = 0; run < 60; ++run) {
    Bytes bytes = log;
    if (run % 2 == 0)
      bytes.resize(random.below(bytes.size()));
    else
      bytes[random.below(bytes.size())] ^= static_cast<std::uint8_t>(1u << random.below(8));
    write_file(damaged + "-wal", bytes);
    const VerifyReport report = verify_session(damaged);
    EXPECT_FALSE(report.verified);
    EXPECT_LE(report.ticks, 2000);
    EXPECT_EQ(report.ticks % k_chunk_ticks, 0) << "a second is there as a whole or not at all";
    shorter += report.ticks < 2000;
  }
  EXPECT_GT(shorter, 30);
}

}  // namespace
}  // namespace cavum
