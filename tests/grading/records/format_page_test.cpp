// The page that specifies the ledger's files says what the program does: its tables to the letter,
// and its worked example, which another program made.
#include <sodium.h>

#include "grading/records/entry_text.h"
#include "grading/records/exports.h"
#include "grading/records/ledger_file.h"
#include "grading/records/ledger_schema.h"
#include "tests/grading/records/school.h"

namespace cavum::records {
namespace {

using namespace testing_ledger;

std::string page() {
  return read_text_file(std::string(CAVUM_SOURCE_DIR) + "/docs/formats/ledger.md");
}

SigningKey key_of_bytes_from(std::uint8_t first) {
  std::array<std::uint8_t, crypto_sign_SEEDBYTES> seed{};
  for (auto& b : seed) b = first++;
  SigningKey key;
  crypto_sign_seed_keypair(key.public_key.data(), key.secret_key.data(), seed.data());
  return key;
}

TEST(LedgerFormatPage, HoldsTheTablesToTheLetter) {
  const std::string text = page();
  EXPECT_NE(text.find("```sql\n" + std::string(k_ledger_schema) + "\n```"), std::string::npos);
  EXPECT_NE(text.find("`user_version` " + std::to_string(k_ledger_format)), std::string::npos);
}

TEST(LedgerFormatPage, ItsExampleIsWhatTheProgramSigns) {
  const std::string text = page();
  const auto line_after = [&](const std::string& begin) {
    const auto from = text.find("    " + begin);
    return text.substr(from + 4, text.find('\n', from) - from - 4);
  };
  const std::string first = line_after("{\"body\":{\"ledger\""),
                    second = line_after("{\"body\":{\"candidate\"");
  for (const std::string& line : {first, second})
    EXPECT_EQ(entry_text(read_entry(line, "the page")), line) << "keys in order, no spaces";
  const std::vector<Sha256> leaves{leaf_hash(ledger_bytes(first)), leaf_hash(ledger_bytes(second))};
  const auto has = [&](const std::string& what) {
    EXPECT_NE(text.find(what), std::string::npos) << what;
  };
  has("leaf 0  " + to_hex(leaves[0]));
  has("leaf 1  " + to_hex(leaves[1]));
  has("root    " + to_hex(merkle_root(leaves)));
  const SigningKey school = key_of_bytes_from(0), other = key_of_bytes_from(32);
  const std::string id = nlohmann::json::parse(first)["body"]["ledger"];
  const Checkpoint p =
      sign_checkpoint(id, 2, merkle_root(leaves),
                      nlohmann::json::parse(second)["utc_ns"].get<std::int64_t>(), school);
  const std::string name = "cosigner.example/one";
  const NoteSignature cosigned = cosign_note(checkpoint_text(id, p), name, other, 1795426400);
  has("```\n" + checkpoint_note(id, to_hex(school.public_key), p, {&cosigned, 1}) + "```");
  has("    " + key_line({name, NoteKind::cosignature, other.public_key}) + "\n");
}

TEST(LedgerFormatPage, SignedResultsAreCheckedAsItSays) {
  const School school{false};
  const Ledger ledger = school.ledger();
  const std::string line = signed_results(read_registry(ledger.content()), ledger);
  const auto facts = nlohmann::json::parse(line);
  constexpr std::size_t k_member = 143;
  const std::string message = "CVRESULT" + line.substr(0, line.size() - k_member - 1) + "}";
  EXPECT_TRUE(is_signed_by(ledger.content().public_key,
                           {reinterpret_cast<const std::uint8_t*>(message.data()), message.size()},
                           facts["signature"]));
  EXPECT_TRUE(facts["checkpoint"].is_string());
}

}  // namespace
}  // namespace cavum::records
