// Checkpoints as notes, and what other parties' word for them finds: a ledger that was put back
// together with its witness, a history that was rewritten.
#include "grading/records/cosign.h"

#include <random>

#include "grading/records/exports.h"
#include "grading/records/ledger_error.h"
#include "tests/grading/records/school.h"

namespace cavum::records {
namespace {

using namespace testing_ledger;
using nlohmann::json;
using testing_basics::code_of;
using testing_basics::tells;
using testing_basics::thrown_by;

constexpr std::uint64_t k_now_s = 1'800'000'000;
constexpr int k_changes = 2000;

/// A school, and a cosigner with a memory of its own.
class Cosigning : public ::testing::Test {
 protected:
  void add(int entries) {
    Ledger ledger = school_.ledger();
    for (int i = 0; i < entries; ++i)
      ledger.append([](const LedgerContent&) { return ForgetEntry{"C-" + random_hex(4), {}}; });
  }
  LedgerContent content() const { return read_ledger(school_.places()); }
  Cosigned sign(const std::string& request, const std::string& school_key = "") const {
    return cosign({"cosigner.example/one", key_, school_.file("memory"), school_key}, request,
                  "request", k_now_s);
  }
  std::string school_key() const { return to_hex(School::key().public_key); }
  std::vector<NoteKey> known() const {
    return {{"cosigner.example/one", NoteKind::cosignature, key_.public_key}};
  }
  /// The ledger and its witness, as somebody copies them who wants to put them back.
  struct Copy {
    Bytes database, witness;
  };
  Copy copy() const {
    return {read_file(school_.places().database()), read_file(witness_path(content().id))};
  }
  void put_back(const Copy& c) const {
    const std::string witness = witness_path(content().id);
    for (const char* end : {"-wal", "-shm"})
      std::filesystem::remove(school_.places().database() + end);
    write_file(school_.places().database(), c.database);
    write_file(witness, c.witness);
  }

  School school_{false};
  SigningKey key_ = load_signing_key(school_.file("cosigner.key"), "cosigner");
};

TEST_F(Cosigning, ACheckpointIsANoteOfFourLines) {
  const LedgerContent c = content();
  ASSERT_EQ(c.checkpoints.size(), 1u);
  const Checkpoint& p = c.checkpoints[0];
  const std::string note = checkpoint_note(c.id, c.public_key, p);
  EXPECT_TRUE(note.starts_with("cavum.ledger/" + c.id + "\n1\n" + to_base64(p.root) + "\nutc_ns " +
                               std::to_string(p.utc_ns) + "\n\n— cavum.ledger/" + c.id + " "))
      << note;
  const ReadCheckpoint read = parse_checkpoint(note, c.public_key, "note");
  EXPECT_EQ(read.ledger_id, c.id);
  EXPECT_TRUE(is_signed_by_school(c.id, c.public_key, read.checkpoint));
  EXPECT_EQ(check_note(read.note, checkpoint_key(c.id, c.public_key)), NoteVerdict::holds);
  const auto refused = [&](const std::string& what, const std::string& by) {
    std::string other = note;
    other.replace(other.find(what), what.size(), by);
    EXPECT_THROW(static_cast<void>(parse_checkpoint(other, c.public_key, "note")), Error) << by;
  };
  refused("cavum.ledger/", "cavum.other/");
  refused("\n1\n", "\n01\n");
  refused("\n1\n", "\n-1\n");
  refused("\nutc_ns ", "\nutc_ns +");
  refused("\nutc_ns ", "\nmore\nutc_ns ");
  refused("=\nutc", "\nutc");
  Checkpoint other = p;
  other.utc_ns += 1;
  EXPECT_FALSE(is_signed_by_school(c.id, c.public_key, other));
}

TEST_F(Cosigning, GoesOnFromWhatWasSignedBefore) {
  const Cosigned first = sign(cosign_request(content(), 0), school_key());
  ASSERT_TRUE(first.findings.empty()) << first.findings[0].message();
  EXPECT_EQ(first.size, 1u);
  std::uint64_t before = 1;
  for (const int more : {1, 2, 5, 0, 9}) {
    add(more);
    const Cosigned next = sign(cosign_request(content(), before));
    before = next.size;
    ASSERT_TRUE(next.findings.empty()) << next.findings[0].message();
    EXPECT_EQ(next.size, content().entries.size());
    const CosignedNoteCheck check = check_cosigned(next.note, known(), content());
    EXPECT_TRUE(check.findings.empty() && check.not_checked.empty());
    ASSERT_EQ(check.cosignatures.size(), 1u);
    EXPECT_EQ(cosigned_at(check.cosignatures[0]), k_now_s);
  }
}

TEST_F(Cosigning, AForkIsRefused) {
  add(3);
  const Copy old = copy();
  add(2);
  ASSERT_TRUE(sign(cosign_request(content(), 0), school_key()).findings.empty());
  const std::string memory = read_text_file(school_.file("memory/" + content().id));
  put_back(old);
  add(4);  // another history, which the school's own key has signed, and which its witness knows
           // nothing against
  EXPECT_TRUE(check_ledger(school_.places(), false).findings.empty());
  const std::string request = cosign_request(content(), 6);
  expect_kinds(sign(request).findings, {Kind::rewritten});
  // nor with a proof that is left out, or is somebody's own
  std::string bare = request;
  bare.erase(bare.find('\n') + 1, bare.find("\n\n") - bare.find('\n'));
  expect_kinds(sign(bare).findings, {Kind::rewritten});
  EXPECT_EQ(read_text_file(school_.file("memory/" + content().id)), memory)
      << "what was refused is not remembered";
}

TEST_F(Cosigning, AnotherRootOfTheSameSizeIsRefused) {
  const Copy old = copy();
  add(2);
  ASSERT_TRUE(sign(cosign_request(content(), 0), school_key()).findings.empty());
  put_back(old);
  add(2);
  expect_kinds(sign(cosign_request(content(), 3)).findings, {Kind::rewritten});
}

TEST_F(Cosigning, ASmallerOneIsRefused) {
  add(2);
  const Copy old = copy();
  const std::string request = cosign_request(content(), 0);
  add(1);
  ASSERT_TRUE(sign(cosign_request(content(), 0), school_key()).findings.empty());
  expect_finding(sign(request).findings, Kind::older_copy, {"3", "4"});
  put_back(old);
  expect_finding(sign(cosign_request(content(), 3)).findings, Kind::older_copy, {"3", "4"});
}

TEST_F(Cosigning, TrustsNoKeyThatTheFileItselfNames) {
  const std::string request = cosign_request(content(), 0);
  const auto why = [&](const std::string& text, const std::string& key = "") {
    return code_of([&] { static_cast<void>(sign(text, key)); });
  };
  EXPECT_EQ(why(request), LedgerError::unknown);
  expect_kinds(sign(request, std::string(64, 'a')).findings,
               {Kind::signature_invalid});  // not signed by that key
  ASSERT_TRUE(sign(request, school_key()).findings.empty());
  EXPECT_EQ(why(request, std::string(64, 'a')), LedgerError::another_key)
      << "than that by which it was cosigned before";
  EXPECT_EQ(why(request), LedgerError::another_state)
      << "the proof has to begin where this cosigner stopped";
  const std::string path = school_.file("memory/" + content().id);
  std::string memory = read_text_file(path);
  memory.replace(memory.find("\n1\n"), 3, "\n0\n");
  write_text_file(path, memory);
  const auto changed = thrown_by([&] { static_cast<void>(sign(cosign_request(content(), 1))); });
  EXPECT_EQ(code_of(changed), LedgerError::another_state) << "somebody has put its memory back";
  EXPECT_TRUE(tells(changed, path));
  for (const char* bad :
       {"", "old 0\n", "old x\n\n", "old 01\n\nx", "new 0\n\nx", "old 0\nAAAA\n\nx"})
    EXPECT_THROW(static_cast<void>(sign(bad, school_key())), Error) << bad;
}

TEST_F(Cosigning, AMemoryThatWasPutBackIsNotNoticed) {
  ASSERT_TRUE(sign(cosign_request(content(), 0), school_key()).findings.empty());
  const std::string path = school_.file("memory/" + content().id), memory = read_text_file(path);
  const Copy old = copy();
  add(2);
  ASSERT_TRUE(sign(cosign_request(content(), 1)).findings.empty());
  put_back(old);
  add(3);
  expect_kinds(sign(cosign_request(content(), 3)).findings, {Kind::rewritten});
  write_text_file(path, memory);
  EXPECT_TRUE(sign(cosign_request(content(), 1)).findings.empty())
      << "its own backups are the cosigner's affair";
}

TEST_F(Cosigning, AnyBytesAreAnsweredWithAnErrorOrAFindingAndNeverSigned) {
  add(4);
  const Cosigned sound = sign(cosign_request(content(), 0), school_key());
  ASSERT_TRUE(sound.findings.empty());
  add(3);
  const LedgerContent c = content();
  const std::string request = cosign_request(c, 5), memory_path = school_.file("memory/" + c.id),
                    memory = read_text_file(memory_path);
  const std::string key = key_line(known()[0]);
  std::mt19937_64 draw(testing_basics::drawn_seed("cosign"));
  const auto changed = [&](std::string text) {
    const std::string before = text;
    while (text == before)
      for (auto n = 1 + draw() % 3; n > 0; --n) {
        const std::size_t at = draw() % (text.size() + 1), length = draw() % 40;
        switch (text.empty() ? 1 : draw() % 4) {
          case 0:
            text.erase(at, length);
            break;
          case 1:
            text.insert(at, before.substr(draw() % before.size(), length));
            break;
          case 2:
            text.resize(at);
            break;
          default:
            text[draw() % text.size()] = static_cast<char>(draw() % 256);
        }
      }
    return text;
  };
  const auto answer = [](const std::function<void()>& ask) {
    try {
      ask();
    } catch (const Error&) {
    }
  };
  for (int i = 0; i < k_changes; ++i) {
    answer([&] {
      EXPECT_FALSE(sign(changed(request)).findings.empty())
          << "a request that was changed, however little, is not signed";
    });
    const auto note = check_cosigned(changed(sound.note), known(), c);
    if (note.checkpoint) {
      EXPECT_EQ(note.checkpoint->root, c.checkpoints.at(4).root);
    }
    answer([&] { EXPECT_NE(key_line(parse_key_line(changed(key), "key")), key); });
    answer([&] {
      write_text_file(school_.file("cosigners"), changed("# a comment\n" + key + "\n"));
      static_cast<void>(read_cosigners(school_.file("cosigners")));
    });
  }
  EXPECT_EQ(read_text_file(memory_path), memory);
  EXPECT_TRUE(sign(request).findings.empty());
}

/// The rows of the page about rollback: by which means each is seen.
TEST_F(Cosigning, ALedgerPutBackWithItsWitnessIsFoundByACosignedNoteOrAReceiptAndByNothingElse) {
  add(1);
  const Copy old = copy();
  add(1);
  const Cosigned cosigned = sign(cosign_request(content(), 0), school_key());
  ASSERT_TRUE(cosigned.findings.empty());
  Ledger(school_.ledger_folder(), School::key())
      .keep_cosignatures(3, check_cosigned(cosigned.note, known(), content()).cosignatures);
  EXPECT_EQ(last_cosigned(content()), 3u);
  const json receipt = make_receipt(content(), 2);
  put_back(old);
  EXPECT_TRUE(check_ledger(school_.places(), false).findings.empty())
      << "the cosignature in the ledger went with it";
  expect_finding(check_cosigned(cosigned.note, known(), content()).findings, Kind::older_copy,
                 {"2", "3"});
  LedgerContent now = content();
  expect_finding(check_receipt(receipt, school_key(), &now), Kind::older_copy, {"2", "3"});
  add(3);
  EXPECT_TRUE(check_ledger(school_.places(), false).findings.empty());
  expect_kinds(check_cosigned(cosigned.note, known(), content()).findings, {Kind::rewritten});
  now = content();
  expect_kinds(check_receipt(receipt, school_key(), &now), {Kind::rewritten});
  std::filesystem::remove(witness_path(now.id));
  EXPECT_TRUE(check_ledger(school_.places(), false).findings.empty());
  expect_kinds(check_ledger(school_.places(), false).not_checked,
               {Kind::older_copy});  // there is no witness
}

TEST_F(Cosigning, ANoteThatNobodyKnownCosignedIsNotTakenForOne) {
  const Cosigned cosigned = sign(cosign_request(content(), 0), school_key());
  const auto unknown = check_cosigned(cosigned.note, {}, content());
  EXPECT_TRUE(unknown.findings.empty() && unknown.cosignatures.empty());
  expect_kinds(unknown.not_checked, {Kind::cosignature_unknown});
  SignedNote changed = parse_note(cosigned.note, "note");
  changed.signatures.at(1).signature[20] ^= 1;
  expect_finding(check_cosigned(write_note(changed), known(), content()).findings,
                 Kind::cosignature_invalid, {"cosigner.example/one"});
  changed = parse_note(cosigned.note, "note");
  changed.signatures.erase(changed.signatures.begin());
  expect_kinds(check_cosigned(write_note(changed), known(), content()).findings,
               {Kind::signature_invalid});
  changed = parse_note(cosigned.note, "note");
  changed.signatures.at(0).signature[20] ^= 1;
  expect_kinds(check_cosigned(write_note(changed), known(), content()).findings,
               {Kind::signature_invalid});
  expect_kinds(check_cosigned("no note", known(), content()).findings, {Kind::malformed});
}

TEST_F(Cosigning, WhatIsKeptStandsInReceiptsAndIsChecked) {
  const auto check =
      check_cosigned(sign(cosign_request(content(), 0), school_key()).note, known(), content());
  {
    Ledger ledger = school_.ledger();
    ledger.keep_cosignatures(1, check.cosignatures);
    ledger.keep_cosignatures(1, check.cosignatures);
    ASSERT_EQ(ledger.content().cosignatures.size(), 1u) << "once";
  }
  const std::string note = make_receipt(content(), 0).at("checkpoint");
  EXPECT_EQ(check_note(parse_note(note, "receipt"), known()[0]), NoteVerdict::holds);
  Findings findings, not_checked;
  check_cosignatures(content(), known(), findings, not_checked);
  EXPECT_TRUE(findings.empty() && not_checked.empty());
  check_cosignatures(content(), {}, findings, not_checked);
  expect_kinds(not_checked, {Kind::cosignature_unknown});
  NoteSignature other = check.cosignatures[0];
  other.signature[30] ^= 1;
  Ledger(school_.ledger_folder(), School::key()).keep_cosignatures(1, {{other}});
  check_cosignatures(content(), known(), findings, not_checked);
  expect_finding(findings, Kind::cosignature_invalid, {"cosigner.example/one"});
  Ledger(school_.ledger_folder(), School::key()).keep_cosignatures(7, check.cosignatures);
  check_cosignatures(content(), known(), findings, not_checked);
  expect_finding(findings, Kind::cosignature_invalid, {"7"});
}

TEST_F(Cosigning, AnEarlierBeginningIsProvedAndNoOther) {
  add(6);
  const LedgerContent c = content();
  for (std::uint64_t from = 1; from <= 7; ++from) {
    const json r = make_receipt(c, 4, from);
    EXPECT_TRUE(check_receipt(r, school_key(), nullptr).empty()) << from;
    json other = r;
    other["consistency"]["from"] =
        make_receipt(c, 4, from == 7 ? 6 : from + 1)["consistency"]["from"];
    expect_kinds(check_receipt(other, school_key(), nullptr), {Kind::tree_differs});
    other = r;
    other["consistency"]["proof"].push_back(std::string(64, '0'));
    expect_kinds(check_receipt(other, school_key(), nullptr), {Kind::tree_differs});
  }
  EXPECT_THROW(static_cast<void>(make_receipt(c, 4, 8)), std::out_of_range);
}

TEST_F(Cosigning, TheWitnessRemembersWhatWasSigned) {
  add(2);
  const std::string path = witness_path(content().id);
  const std::string sound = read_text_file(path);
  // a line of somebody else's making accuses nobody
  write_text_file(path,
                  sound + "9 " + std::string(64, '1') + " 1 " + to_base64(Bytes(64, 7)) + "\n");
  expect_finding(content().findings, Kind::witness_changed, {"9", path});
  // a line that a power cut left short, and what was told after it
  write_text_file(path, sound.substr(0, sound.size() - 40));
  EXPECT_TRUE(content().findings.empty());
  add(1);
  Findings findings;
  const auto seen = read_witness(content().id, findings);
  ASSERT_EQ(seen.size(), 3u);
  EXPECT_EQ(seen.back().size, 4u);
  EXPECT_TRUE(is_signed_by_school(content().id, school_key(), seen.back()));
  EXPECT_TRUE(content().findings.empty() && findings.empty());
}

}  // namespace
}  // namespace cavum::records
