// A ledger is copied while others add to it, and goes on from a copy with an honest record of what
// was lost.
#include "grading/records/backup.h"

#include <sys/mman.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

#include <atomic>
#include <new>

#include "grading/records/cosign.h"
#include "grading/records/history.h"
#include "tests/grading/records/school.h"

namespace cavum::records {
namespace {

namespace fs = std::filesystem;
using namespace testing_ledger;
using nlohmann::json;

/// One school, one filed session (entry 4), and another that is not filed yet; each test works on a
/// copy.
class BackedUp : public ::testing::Test {
 protected:
  static void SetUpTestSuite() {
    shared_ = new School();
    Ledger ledger = shared_->ledger();
    ASSERT_TRUE(file_session(ledger, shared_->sit(shared_->ticket("4711"))).seq);
    shared_later_ = new std::string(
        fs::path(shared_->sit(shared_->ticket("4712"), "novice")).filename().string());
  }
  static void TearDownTestSuite() {
    delete shared_;
    delete shared_later_;
  }
  Backup back_up(bool with_identities = false) const {
    return records::back_up(school_.places(), backup(), with_identities);
  }
  std::string backup() const { return school_.file("backup"); }
  LedgerPaths restored() const { return {school_.file("restored")}; }
  void add(int entries) const {
    Ledger ledger = school_.ledger();
    for (int i = 0; i < entries; ++i)
      ledger.append([](const LedgerContent&) { return ForgetEntry{"C-" + random_hex(4), {}}; });
  }
  json file_later() const {
    Ledger ledger = school_.ledger();
    const auto filed = file_session(ledger, school_.file(*shared_later_));
    EXPECT_TRUE(filed.seq) << testing_basics::text_of(words_of(filed.findings));
    return ledger.receipt(*filed.seq);
  }
  std::string later() const { return school_.file(*shared_later_); }

  School school_{*shared_};

 private:
  static inline School* shared_ = nullptr;
  static inline std::string* shared_later_ = nullptr;
};

TEST_F(BackedUp, IsALedgerThatHoldsAndItsOwnersAlone) {
  const Backup b = back_up();
  EXPECT_EQ(b.checkpoint.size, 6u);
  EXPECT_EQ(b.sessions, 1u);
  EXPECT_TRUE(b.missing.empty());
  EXPECT_FALSE(fs::exists(backup() + "/identities.db")) << "names are copied only when asked for";
  EXPECT_TRUE(check_ledger({backup()}, true).findings.empty());
  const ReadCheckpoint note = parse_checkpoint(read_text_file(backup() + "/checkpoint"),
                                               to_hex(School::key().public_key), "checkpoint");
  EXPECT_EQ(note.checkpoint.root, b.checkpoint.root);
  struct stat info {};
  for (const std::string& f :
       {backup() + "/ledger.db",
        LedgerPaths{backup()}.session(
            read_registry(read_ledger({backup()})).sessions[0].file_sha256)}) {
    ASSERT_EQ(::stat(f.c_str(), &info), 0) << f;
    EXPECT_EQ(info.st_mode & 077, 0u) << f;
  }
  ASSERT_EQ(::stat(backup().c_str(), &info), 0);
  EXPECT_EQ(info.st_mode & 077, 0u);
  EXPECT_TRUE(back_up(true).identities);
  EXPECT_EQ(Identities(LedgerPaths{backup()}.identities()).all().size(), 2u);
}

/// What three programs and the test say to each other.
struct Growth {
  std::atomic<bool> enough = false;
  std::atomic<std::size_t> added = 0;
};

/// Adds to the ledger until the test has seen enough; the program's exit code.
int add_until_enough(const School& school, Growth& growth) {
  try {
    Ledger ledger = school.ledger();
    while (!growth.enough) try {
        ledger.append([&](const LedgerContent&) {
          return ForgetEntry{"C-" + random_hex(200), {}};
        });
        ++growth.added;
      } catch (const DatabaseError& e) {  // another one has it at the moment
        if (e.refusal().fault != DiskFault::held) return 2;
      }
  } catch (const std::exception&) {
    return 1;
  }
  return 0;
}

TEST_F(BackedUp, WhileThreeProgramsAddToIt) {
  void* shared =
      ::mmap(nullptr, sizeof(Growth), PROT_READ | PROT_WRITE, MAP_SHARED | MAP_ANONYMOUS, -1, 0);
  ASSERT_NE(shared, MAP_FAILED);
  Growth& growth = *new (shared) Growth;
  std::vector<pid_t> programs;
  for (int i = 0; i < 3; ++i) {
    const pid_t pid = ::fork();
    ASSERT_GE(pid, 0);
    if (pid == 0) ::_exit(add_until_enough(school_, growth));
    programs.push_back(pid);
  }
  std::vector<Checkpoint> copies;
  constexpr int k_grown = 5;
  for (int grown = 0; grown < k_grown && !HasFatalFailure();)
    [&] {
      const Backup b = back_up();
      const LedgerContent copy = read_ledger({backup()}, AskWitness::no);
      ASSERT_TRUE(copy.findings.empty()) << copy.findings[0].message();
      ASSERT_EQ(copy.entries.size(), b.checkpoint.size);
      grown += copies.empty() || copies.back().size < b.checkpoint.size ? 1 : 0;
      copies.push_back(b.checkpoint);
      ASSERT_EQ(::waitpid(-1, nullptr, WNOHANG), 0) << "a program gave up";
    }();
  growth.enough = true;
  for (const pid_t program : programs) {
    int status = 0;
    ::waitpid(program, &status, 0);
    EXPECT_TRUE(WIFEXITED(status) && WEXITSTATUS(status) == 0) << status;
  }
  const LedgerContent all = read_ledger(school_.places());
  EXPECT_TRUE(all.findings.empty());
  EXPECT_EQ(all.entries.size(), 6u + growth.added);
  for (const auto& p : copies)
    EXPECT_EQ(History(all).standing_of(p), Standing::begins_with_it) << p.size;
  ::munmap(shared, sizeof(Growth));
}

TEST_F(BackedUp, IsBroughtUpToDateAndCopiesWhatIsNew) {
  EXPECT_EQ(back_up().copied, 1u);
  file_later();
  const Backup again = back_up();
  EXPECT_EQ(again.copied, 1u);
  EXPECT_EQ(again.sessions, 2u);
  EXPECT_EQ(again.checkpoint.size, 7u);
  const std::string other = school_.file("other");
  fs::create_directories(other);
  write_text_file(other + "/mine", "x");
  EXPECT_THROW(records::back_up(school_.places(), other, false), Error);
  EXPECT_THROW(records::back_up(school_.places(), school_.ledger_folder(), false), Error);
}

TEST_F(BackedUp, IsNotReplacedByALedgerThatWasPutBack) {
  const Bytes old = read_file(school_.places().database());
  add(1);
  back_up();
  fs::remove(witness_path(read_ledger(school_.places()).id));
  write_file(school_.places().database(), old);
  EXPECT_THROW(back_up(), Error);
  EXPECT_EQ(read_ledger({backup()}).entries.size(), 7u) << "what was there still stands";
}

TEST_F(BackedUp, ALedgerThatDoesNotHoldIsNotBackedUp) {
  test::tamper(
      school_.places().database(),
      "DROP TRIGGER entry_stays; UPDATE entry SET text = replace(text, 'C-', 'D-') WHERE seq = 1");
  EXPECT_THROW(back_up(), Error);
  EXPECT_FALSE(fs::exists(backup()));
}

TEST_F(BackedUp, ASessionThatIsGoneIsNamed) {
  const auto filed = read_registry(read_ledger(school_.places())).sessions.at(0);
  write_text_file(school_.places().session(filed.file_sha256), "changed");
  EXPECT_EQ(back_up().missing, std::vector<std::string>{filed.file_sha256});
  const RestorePlan plan = plan_restore(backup(), {}, {});
  EXPECT_EQ(plan.missing_sessions, std::vector<std::string>{filed.file_sha256});
  restore(backup(), restored().folder, plan, "", School::key());
  const LedgerContent c = read_ledger(restored());
  EXPECT_EQ(c.entries.back().as<RestoreEntry>()->missing_sessions,
            std::vector<std::string>{filed.file_sha256});
  expect_kinds(check_ledger(restored(), false).findings, {Kind::file_gone});
}

TEST_F(BackedUp, NothingIsLostWhenNothingWasAdded) {
  back_up(true);
  const RestorePlan plan = plan_restore(backup(), {}, {});
  EXPECT_TRUE(plan.compared && plan.identities);
  EXPECT_TRUE(plan.findings.empty() && plan.lost_entries.empty() && plan.missing_sessions.empty());
  restore(backup(), restored().folder, plan, "", School::key());
  const auto check = check_ledger(restored(), true);
  EXPECT_TRUE(check.findings.empty()) << check.findings[0].message();
  expect_finding(check.remarks, Kind::restored, {"6", "6"});
  Ledger ledger(restored().folder, School::key());
  EXPECT_TRUE(file_session(ledger, later()).seq) << "it goes on";
}

TEST_F(BackedUp, AnOlderOneSaysWhatIsMissingAndGoesOn) {
  back_up(true);
  add(1);
  const json receipt = file_later();
  add(2);
  write_text_file(school_.file("r.json"), receipt.dump());
  const std::vector<std::string> receipts{school_.file("r.json")};
  const Checkpoint lost = read_ledger(school_.places()).checkpoints.back();
  const RestorePlan plan = plan_restore(backup(), receipts, {});
  ASSERT_TRUE(plan.findings.empty());
  ASSERT_TRUE(plan.last_seen);
  EXPECT_EQ(plan.last_seen->checkpoint.size, 10u) << "the witness has seen more than the receipt";
  expect_told(plan.lost_entries, {"6", "9"});
  expect_told(
      plan.lost_entries,
      {"7", read_registry(read_ledger(school_.places())).sessions.at(1).candidate, "r.json"});
  EXPECT_THROW(restore(backup(), restored().folder, plan, "", School::key()), Error)
      << "a person accepts the loss";
  EXPECT_FALSE(fs::exists(restored().folder));

  restore(backup(), restored().folder, plan, "the disk died", School::key());
  const LedgerContent c = read_ledger(restored());
  ASSERT_TRUE(c.findings.empty()) << c.findings[0].message();
  const LedgerEntry& e = c.entries.at(6);
  const auto* said = e.as<RestoreEntry>();
  ASSERT_NE(said, nullptr);
  ASSERT_EQ(said->lost.size(), 4u) << "each that the witness saw";
  EXPECT_EQ(said->lost[3].size, 10u);
  EXPECT_EQ(said->lost[3].root, lost.root);
  EXPECT_EQ(said->backup.size, 6u);
  EXPECT_TRUE(read_registry(c).findings.empty());
  expect_finding(check_ledger(restored(), false).remarks, Kind::restored, {"4", "the disk died"});

  // the lost session's receipt is heard until the session is filed again
  expect_finding(check_receipt(receipt, c.public_key, &c), Kind::restored, {"6"});
  Ledger ledger(restored().folder, School::key());
  ASSERT_TRUE(file_session(ledger, later()).seq);
  EXPECT_TRUE(check_receipt(receipt, c.public_key, &ledger.content()).empty());
  // the witness remembers both, and the ledger that was left is no longer added to
  Findings findings;
  EXPECT_EQ(read_witness(c.id, findings).size(), 12u)
      << "ten of before, the restore and what was added since";
  EXPECT_TRUE(check_ledger(restored(), false).findings.empty());
  expect_kinds(check_ledger(school_.places(), false).findings, {Kind::rewritten});
  EXPECT_THROW(school_.ledger(), Error);
}

TEST_F(BackedUp, WhereNoWitnessIsANoteOrAReceiptTells) {
  back_up();
  add(3);
  const LedgerContent before = read_ledger(school_.places());
  const Checkpoint last = before.checkpoints.back();
  write_text_file(school_.file("note"), checkpoint_note(before.id, before.public_key, last));
  fs::remove(witness_path(before.id));
  EXPECT_FALSE(plan_restore(backup(), {}, {}).compared);
  const RestorePlan plan = plan_restore(backup(), {}, {school_.file("note")});
  ASSERT_TRUE(plan.last_seen);
  EXPECT_EQ(plan.last_seen->checkpoint.size, 9u);
  restore(backup(), restored().folder, plan, "moved to another computer", School::key());
  const LedgerContent c = read_ledger(restored());
  EXPECT_EQ(History(c).standing_of(last), Standing::loss_on_record);
  Checkpoint other = last;
  other.root[0] ^= 1;
  EXPECT_NE(History(c).standing_of(other), Standing::loss_on_record)
      << "what was lost had that root and no other";
  other = last;
  other.size = 10;
  EXPECT_EQ(History(c).standing_of(other), Standing::older_copy)
      << "nor was more on record than what was seen";
  std::string changed = read_text_file(school_.file("note"));
  changed.replace(changed.find("\n9\n"), 3, "\n7\n");
  write_text_file(school_.file("note"), changed);
  EXPECT_THROW(static_cast<void>(plan_restore(backup(), {}, {school_.file("note")})), Error)
      << "a note that the school did not sign tells nothing";
}

TEST_F(BackedUp, OfAnotherHistoryIsNotRestored) {
  const Bytes old = read_file(school_.places().database());
  add(1);
  back_up();
  const std::string witness = witness_path(read_ledger(school_.places()).id);
  fs::remove(witness);
  write_file(school_.places().database(), old);
  add(2);
  const RestorePlan plan = plan_restore(backup(), {}, {});
  expect_kinds(plan.findings, {Kind::rewritten});
  EXPECT_THROW(restore(backup(), restored().folder, plan, "r", School::key()), Error);
  EXPECT_FALSE(fs::exists(restored().folder));
}

TEST_F(BackedUp, IsRestoredAgainAfterTheRestoredOneWasLost) {
  back_up();
  add(2);
  restore(backup(), restored().folder, plan_restore(backup(), {}, {}), "first", School::key());
  {
    Ledger ledger(restored().folder, School::key());
    for (int i = 0; i < 5; ++i)
      ledger.append([](const LedgerContent&) { return ForgetEntry{"C-a", {}}; });
  }
  const RestorePlan plan = plan_restore(backup(), {}, {});
  ASSERT_TRUE(plan.last_seen);
  EXPECT_EQ(plan.last_seen->checkpoint.size, 12u);
  restore(backup(), school_.file("again"), plan, "second", School::key());
  EXPECT_TRUE(check_ledger({school_.file("again")}, false).findings.empty());
  EXPECT_FALSE(check_ledger(restored(), false).findings.empty());
}

TEST_F(BackedUp, OneWhoseLastEntriesWereCutOffIsNotTheOneThatWasTaken) {
  back_up();
  test::tamper(
      LedgerPaths{backup()}.database(),
      "DROP TRIGGER entry_is_kept; DROP TRIGGER note_is_kept; DELETE FROM entry WHERE seq = (SELECT max(seq) FROM entry); DELETE FROM note WHERE "
      "size = (SELECT max(size) FROM note); CREATE TRIGGER entry_is_kept BEFORE DELETE ON entry BEGIN SELECT RAISE(ABORT, 'the ledger is append "
      "only'); END; CREATE TRIGGER note_is_kept BEFORE DELETE ON note BEGIN SELECT RAISE(ABORT, 'the ledger is append only'); END;");
  expect_kinds(plan_restore(backup(), {}, {}).findings, {Kind::tree_differs});
}

TEST_F(BackedUp, ASecondOneCutOffBeforeItSaysWhatItHoldsIsStillABackup) {
  back_up();
  const std::string said = read_text_file(backup() + "/checkpoint");
  add(2);
  const Backup second = back_up();
  write_text_file(backup() + "/checkpoint", said);
  const RestorePlan plan = plan_restore(backup(), {}, {});
  EXPECT_TRUE(plan.findings.empty()) << plan.findings[0].message();
  EXPECT_EQ(plan.content.entries.size(), second.checkpoint.size);
  restore(backup(), restored().folder, plan, "", School::key());
  EXPECT_TRUE(check_ledger(restored(), false).findings.empty());
}

TEST_F(BackedUp, WhoWasForgottenBeforeStaysForgotten) {
  const std::string candidate =
      read_registry(read_ledger(school_.places())).sessions.at(0).candidate;
  const Bytes names = read_file(school_.places().identities());
  Identities(school_.places().identities()).forget(candidate);
  {
    Ledger ledger = school_.ledger();
    ledger.append([&](const LedgerContent&) { return ForgetEntry{candidate, {}}; });
  }
  write_file(school_.places().identities(), names);  // somebody restored an old copy of these alone
  back_up(true);
  EXPECT_FALSE(Identities(LedgerPaths{backup()}.identities()).of_pseudonym(candidate));
  EXPECT_TRUE(Identities(school_.places().identities()).of_pseudonym(candidate))
      << "the ledger's own file is not touched";
}

TEST_F(BackedUp, ACosignerRefusesARestoredLedgerUntilAPersonMovesWhatItRemembers) {
  const std::string school = to_hex(School::key().public_key),
                    id = read_ledger(school_.places()).id;
  const Cosigner cosigner{"cosigner.example/one",
                          load_signing_key(school_.file("cosigner.key"), "cosigner"),
                          school_.file("memory"), school};
  back_up();
  add(2);
  ASSERT_TRUE(cosign(cosigner, cosign_request(read_ledger(school_.places()), 0), "request", 1)
                  .findings.empty());
  restore(backup(), restored().folder, plan_restore(backup(), {}, {}), "the disk died",
          School::key());
  Ledger ledger(restored().folder, School::key());
  expect_kinds(cosign(cosigner, cosign_request(ledger.content(), 7), "request", 1).findings,
               {Kind::older_copy});
  for (int i = 0; i < 3; ++i)
    ledger.append([](const LedgerContent&) { return ForgetEntry{"C-a", {}}; });
  expect_kinds(cosign(cosigner, cosign_request(ledger.content(), 8), "request", 1).findings,
               {Kind::rewritten});
  fs::rename(school_.file("memory/" + id), school_.file("kept"));
  EXPECT_TRUE(cosign(cosigner, cosign_request(ledger.content(), 0), "request", 1).findings.empty());
  const auto check =
      check_cosigned(read_text_file(school_.file("kept"))
                         .substr(read_text_file(school_.file("kept")).find('\n') + 1),
                     {}, ledger.content());
  EXPECT_TRUE(check.findings.empty()) << "what it signed before is on record as lost";
}

TEST_F(BackedUp, AnotherSchoolsKeyRestoresNothing) {
  back_up();
  const SigningKey other = load_signing_key(school_.file("other.key"), "school");
  EXPECT_THROW(restore(backup(), restored().folder, plan_restore(backup(), {}, {}), "", other),
               Error);
  EXPECT_FALSE(fs::exists(restored().folder));
}

}  // namespace
}  // namespace cavum::records
