// The school's keys: each purpose has a secret of its own, a key can be replaced and run out, and
// what was signed before stays proved.
#include "grading/records/school_keys.h"

#include <gtest/gtest.h>

#include "engine/base/json_fields.h"
#include "grading/records/cosign.h"
#include "grading/records/exports.h"
#include "grading/records/ledger_error.h"
#include "tests/grading/records/school.h"

namespace cavum::records {
namespace {

using namespace testing_ledger;
using testing_basics::code_of;

TEST(DerivedSecret, IsHkdfOfRfc5869) {
  // RFC 5869, A.3: SHA-256 with empty salt and info; the first 32 of its 42 bytes
  const Bytes material(22, 0x0b);
  EXPECT_EQ(to_hex(hkdf_sha256(material, "")),
            "8da4e775a563c18f715f802a063c5a31b8a11f5c5ee1879ec3454e5f3c738d2d");
}

TEST(DerivedSecret, IsAnotherForEachPurposeAndNeverTheSeed) {
  const School school;
  const SigningKey key = School::key();
  const auto a = derived_secret(key, "a"), b = derived_secret(key, "b");
  EXPECT_NE(a, b);
  EXPECT_FALSE(std::equal(a.begin(), a.end(), key.secret_key.begin()));
}

class SchoolKeys : public ::testing::Test {
 protected:
  void expect_holds() {
    const LedgerCheck check = check_ledger(school_.places(), false);
    for (const auto& f : check.findings) ADD_FAILURE() << f.message();
  }
  std::string replace(std::int64_t until_utc_ns = 0) {
    return replace_school_key(school_.ledger_folder(), school_key_path(), until_utc_ns, "yearly");
  }
  School school_;
};

TEST_F(SchoolKeys, ReplacedThenTheNewOneSignsAndAllOfBeforeStaysProved) {
  const std::string old_ticket = school_.ticket("4711");
  const auto receipt = school_.ledger().receipt(3);
  const Ledger before = school_.ledger();
  const std::string results = signed_results(read_registry(before.content()), before),
                    first = before.content().public_key, now = replace();
  EXPECT_NE(first, now);
  EXPECT_EQ(to_hex(School::key().public_key), now) << "the new key is in the place of the old one";
  EXPECT_EQ(to_hex(load_school_key(old_key_path(school_key_path(), first)).public_key), first)
      << "which is kept beside it";
  expect_holds();
  const LedgerContent c = read_ledger(school_.places());
  EXPECT_EQ(c.public_key, now);
  ASSERT_EQ(c.keys.size(), 2u);
  EXPECT_EQ(c.key_of(c.entries.size() - 1), first);
  EXPECT_EQ(c.key_of(c.entries.size()), now) << "the entry that introduces it is signed by it";
  for (const auto& f : check_receipt(receipt, c.public_key, &c)) ADD_FAILURE() << f.message();
  for (const auto& f : check_results(results, c.public_key, &c)) ADD_FAILURE() << f.message();
  EXPECT_TRUE(Identities(school_.places().identities()).check(School::key()).empty())
      << "identities are sealed by the new one";
  Ledger ledger = school_.ledger();
  EXPECT_TRUE(check_receipt(ledger.receipt(3), now, nullptr).empty())
      << "a new receipt of an old entry needs the new key alone";
  const Filing filing = file_session(ledger, school_.sit(old_ticket));
  for (const auto& f : filing.findings)
    ADD_FAILURE() << f.message() << " (a ticket of before is still good)";
  const Filing newer = file_session(ledger, school_.sit(school_.ticket("4712")));
  for (const auto& f : newer.findings) ADD_FAILURE() << f.message();
  expect_holds();
}

TEST_F(SchoolKeys, ResultsSignedByTheOldKeyAfterItWasReplacedAreFound) {
  const SigningKey old = School::key();
  static_cast<void>(replace());
  const LedgerContent c = read_ledger(school_.places());
  nlohmann::json facts = nlohmann::json::parse([&] {
    const Ledger ledger = school_.ledger();
    return signed_results(read_registry(ledger.content()), ledger);
  }());
  facts.erase("signature");
  facts["public_key"] = to_hex(old.public_key);
  const Checkpoint& last = c.checkpoints.back();
  const Checkpoint forged = sign_checkpoint(c.id, last.size, last.root, last.utc_ns, old);
  facts["checkpoint"] = checkpoint_note(c.id, to_hex(old.public_key), forged);
  facts["signature"] = to_hex(old.sign(ledger_bytes("CVRESULT" + facts.dump())));
  expect_kinds(check_results(facts.dump(), c.public_key, &c), {Kind::other_school});
}

TEST_F(SchoolKeys, TheOldKeySignsNothingMore) {
  const SigningKey old = School::key();
  static_cast<void>(replace());
  EXPECT_EQ(code_of([&] { const Ledger ledger(school_.ledger_folder(), old); }),
            LedgerError::another_key);
}

TEST_F(SchoolKeys, AKeyThatNoKeyBeforeItHasSignedIsFound) {
  const SigningKey stranger = load_signing_key(school_.file("stranger.key"), "school");
  Ledger ledger = school_.ledger();
  ledger.append(
      [&](const LedgerContent& now) { return school_key_entry(now, stranger, stranger, 0); },
      "mine now");
  expect_finding(check_ledger(school_.places(), false).findings, Kind::signature_invalid,
                 {std::to_string(k_first_entries)});
  EXPECT_EQ(read_ledger(school_.places()).public_key, to_hex(School::key().public_key));
}

TEST_F(SchoolKeys, AWordOfAnotherLedgerIntroducesNoKey) {
  const SigningKey key = School::key(), next = load_signing_key(school_.file("next.key"), "school");
  Ledger::create(school_.file("other"), "the same school", key);
  KeyEntry word;
  {
    Ledger other(school_.file("other"), key);
    word = school_key_entry(other.content(), key, next, 0);
  }
  Ledger ledger = school_.ledger();
  ledger.append([&](const LedgerContent&) { return word; });
  expect_finding(check_ledger(school_.places(), false).findings, Kind::signature_invalid,
                 {std::to_string(k_first_entries)});
}

TEST_F(SchoolKeys, OneThatRanOutEntersNothingUntilItIsReplaced) {
  {
    Ledger ledger = school_.ledger();
    limit_school_key(ledger, read_clocks().utc_ns - 1, "at the end of the year");
  }
  expect_holds();
  Ledger ledger = school_.ledger();
  EXPECT_EQ(code_of([&] {
              ledger.append([](const LedgerContent&) { return ForgetEntry{"C-a", {}}; });
            }),
            LedgerError::ended);
  static_cast<void>(replace(read_clocks().utc_ns + k_hour_ns));
  EXPECT_NO_THROW(school_.ticket("4711"));
  expect_holds();
}

TEST_F(SchoolKeys, AReplacementThatWasCutOffGoesOn) {
  const SigningKey old = School::key();
  school_.ticket("4711");
  {  // killed after the entry, before the identities were sealed again
    const SigningKey next = load_school_key(next_key_path(school_key_path()), true);
    Ledger ledger(school_.ledger_folder(), old);
    ledger.change_key(next, 0, "yearly");
  }
  EXPECT_THROW(school_.ledger(), Error);
  const std::string now = replace();
  EXPECT_EQ(to_hex(School::key().public_key), now);
  EXPECT_EQ(read_ledger(school_.places()).keys.size(), 2u) << "entered once";
  EXPECT_TRUE(Identities(school_.places().identities()).check(School::key()).empty());
  expect_holds();
}

TEST_F(SchoolKeys, AnOlderCopyPutBackFromBeforeTheReplacementIsFound) {
  const Bytes old = read_file(school_.places().database());
  static_cast<void>(replace());
  school_.ticket("4711");
  write_file(school_.places().database(), old);
  expect_finding(read_ledger(school_.places()).findings, Kind::witness_changed,
                 {witness_path(read_ledger(school_.places()).id)});
}

TEST_F(SchoolKeys, ACosignerGoesOnWithTheNewKeyWhenTheOldOneHasSignedForIt) {
  Cosigner cosigner{"cosigner.example/one",
                    load_signing_key(school_.file("cosigner.key"), "cosigner"),
                    school_.file("memory"), to_hex(School::key().public_key)};
  ASSERT_TRUE(cosign(cosigner, cosign_request(read_ledger(school_.places()), 0), "request", 1)
                  .findings.empty());
  static_cast<void>(replace());
  const LedgerContent c = read_ledger(school_.places());
  cosigner.school_key.clear();
  expect_kinds(cosign(cosigner, cosign_request(c, k_first_entries), "request", 2).findings,
               {Kind::signature_invalid});
  cosigner.key_entries = {c.entries.at(k_first_entries - 1).text,
                          c.entries.at(k_first_entries).text};
  const Cosigned signed_now = cosign(cosigner, cosign_request(c, k_first_entries), "request", 3);
  EXPECT_TRUE(signed_now.findings.empty());
  cosigner.key_entries.clear();
  EXPECT_TRUE(cosign(cosigner, cosign_request(c, c.entries.size()), "request", 4).findings.empty())
      << "and remembers it";
  const auto check = check_cosigned(
      signed_now.note, {{cosigner.name, NoteKind::cosignature, cosigner.key.public_key}}, c);
  for (const auto& f : check.findings) ADD_FAILURE() << f.message();
}

}  // namespace
}  // namespace cavum::records
