// Signed notes against what others publish: the note of Go's reference implementation
// (golang.org/x/mod/sumdb/note, note_test.go), keys and times of
// github.com/transparency-dev/formats (note_cosigv1_test.go), and a checkpoint of a public log that
// a public witness cosigned.
#include "grading/records/signed_note.h"

#include <gtest/gtest.h>
#include <sodium.h>

#include "engine/base/hash.h"
#include "engine/base/text.h"

namespace cavum::records {
namespace {

const std::string k_text =
    "If you think cryptography is the answer to your problem,\nthen you don't know what your problem is.\n";
const std::string k_peter = "PeterNeumann+c74f20a3+ARpc2QcUPDhMQegwxbzhKqiBfsVkmqq/LDE4izWy10TW",
                  k_enoch = "EnochRoot+af0cfe78+ATtqJ7zOtqQtYqOo0CpvDXNlMhV3HeJDpjrASKGLWdop";
const std::string
    k_peter_signs =
        "— PeterNeumann x08go/ZJkuBS9UG/SffcvIAQxVBtiFupLLr8pAcElZInNIuGUgYN1FFYC2pZSNXgKvqfqdngotpRZb6KE6RyyBwJnAM=\n",
    k_enoch_signs =
        "— EnochRoot rwz+eBzmZa0SO3NbfRGzPCpDckykFXSdeX+MNtCOXm2/5n2tiOHp+vAF1aGrQ5ovTG01oOTGwnWLox33WWd1RvMc+QQ=\n";

/// The private key that Go's test publishes: "PRIVATE+KEY+PeterNeumann+c74f20a3+AYEK…", a kind and
/// a seed.
SigningKey peters_key() {
  const auto seed = from_base64("AYEKFALVFGyNhPJEMzD1QIDr+Y7hfZx09iUvxdXHKDFz");
  SigningKey key;
  crypto_sign_seed_keypair(key.public_key.data(), key.secret_key.data(), seed->data() + 1);
  return key;
}

TEST(SignedNote, IsTheOneOfGosReference) {
  const SigningKey key = peters_key();
  EXPECT_EQ(key_line({"PeterNeumann", NoteKind::signature, key.public_key}), k_peter);
  EXPECT_EQ(write_note({k_text, {sign_note(k_text, "PeterNeumann", key)}}),
            k_text + "\n" + k_peter_signs);

  const SignedNote both = parse_note(k_text + "\n" + k_peter_signs + k_enoch_signs, "note");
  EXPECT_EQ(both.text, k_text);
  ASSERT_EQ(both.signatures.size(), 2u);
  const NoteKey peter = parse_key_line(k_peter, "key"), enoch = parse_key_line(k_enoch, "key");
  EXPECT_EQ(check_note(both, peter), NoteVerdict::holds);
  EXPECT_EQ(check_note(both, enoch), NoteVerdict::holds);
  EXPECT_EQ(check_note(parse_note(k_text + "\n" + k_enoch_signs, "note"), peter),
            NoteVerdict::absent);
  SignedNote changed = both;
  changed.text[0] = 'i';
  EXPECT_EQ(check_note(changed, peter), NoteVerdict::broken);
  changed = both;
  changed.signatures.push_back(changed.signatures[0]);
  changed.signatures.back().signature[5] ^= 1;
  EXPECT_EQ(check_note(changed, peter), NoteVerdict::broken)
      << "one that holds does not excuse one that does not";
}

TEST(SignedNote, RefusesWhatGosReferenceRefuses) {
  const std::string head = k_text + "\n";
  std::string many;
  for (int i = 0; i < 101; ++i) many += k_peter_signs;
  for (
      const std::string& bad :
      {k_text, head, head + k_peter_signs.substr(0, k_peter_signs.size() - 1),
       "\x01" + head + k_peter_signs, "\xff" + head + k_peter_signs,
       head +
           "— Bad Name x08go/ZJkuBS9UG/SffcvIAQxVBtiFupLLr8pAcElZInNIuGUgYN1FFYC2pZSNXgKvqfqdngotpRZb6KE6RyyBwJnAM=",
       head + k_peter_signs + "Unexpected line.\n", head + many, std::string(), std::string("\n\n"),
       head + "— a+b ABCDABCD\n", head + "— a ABCD\n", head + "— a\xc2\xa0z ABCDABCD\n",
       head + "- PeterNeumann ABCDABCD\n"})
    EXPECT_THROW(static_cast<void>(parse_note(bad, "note")), Error) << one_line(bad).substr(0, 200);
  EXPECT_NO_THROW(
      static_cast<void>(parse_note(head + many.substr(0, 16 * k_peter_signs.size()), "note")));
}

TEST(SignedNote, AKeyLineThatIsCutOrChangedIsNone) {
  for (std::size_t from = 0; from <= k_peter.size(); ++from)
    for (std::size_t to = from; to <= k_peter.size(); ++to)
      if (from != 0 || to != k_peter.size()) {
        EXPECT_THROW(static_cast<void>(parse_key_line(k_peter.substr(from, to - from), "key")),
                     Error);
      }
  for (std::size_t i = 0; i < k_peter.size(); ++i) {
    std::string other = k_peter;
    ++other[i];
    EXPECT_THROW(static_cast<void>(parse_key_line(other, "key")), Error) << other;
  }
  for (const char* bad :
       {"PeterNeumann+cc469956+ARpc2QcUPDhMQegwxbzhKqiBfsVkmqq/LDE4izWy10TWBADKEY==",  // as Go's
                                                                                       // test has
                                                                                       // them: too
                                                                                       // long
        "PeterNeumann+173116ae+ZRpc2QcUPDhMQegwxbzhKqiBfsVkmqq/LDE4izWy10TW"})  // and of an unknown
                                                                                // kind
    EXPECT_THROW(static_cast<void>(parse_key_line(bad, "key")), Error) << bad;
  for (const char* good : {"TEST+7997405c+AQcC+FTVKf0jlTdHDY3rbevmnKxxPjigCXlVtGe6RIr6",
                           "remora.n621.de+da77ade7+BOvN63jn/bLvkieywe8R6UYAtVtNbZpXh34x7onlmtw2"})
    EXPECT_EQ(key_line(parse_key_line(good, "key")), good);
}

TEST(Cosignature, OfAPublicWitnessHolds) {
  // Google's log coachandhorses2026h1 (staging), cosigned by the witness navigli of Geomys. The
  // log's own signature is of a kind that is not looked at.
  const std::string note =
      "coachandhorses2026h1.staging.certificate.transparency.goog\n185550722\nYXAM0VmnrfvLaBCOOYSJhCaE5F10oGBOo+hkbDa1kng=\n\n"
      "— coachandhorses2026h1.staging.certificate.transparency.goog "
      "MpXgsHy8ZwxXnO+WjtVrPxAzL49Rs1gWTkNVNeEa//5peAzaocRCB3qt3EaibjzY5GILLtGgBP7dBhgcSHy+JQh0OAc=\n"
      "— witness.navigli.sunlight.geomys.org "
      "o+AP4gAAAABqb7DzNrGFRJnQ9vrJ8xpnwZytnr/ZYczDIsvwvouiSjwOjn7a72ccxBk+lKnZ7dKqkYKER1s/KxLTaVwQD7lJZTC/CQ==\n";
  const NoteKey witness = parse_key_line(
      "witness.navigli.sunlight.geomys.org+a3e00fe2+BNy/co4C1Hn1p+INwJrfUlgz7W55dSZReusH/GhUhJ/G",
      "key");
  SignedNote read = parse_note(note, "note");
  EXPECT_EQ(write_note(read), note);
  EXPECT_EQ(check_note(read, witness), NoteVerdict::holds);
  EXPECT_EQ(cosigned_at(read.signatures.at(1)), 1785704691u);
  EXPECT_FALSE(cosigned_at(read.signatures.at(0))) << "no cosignature";
  read.signatures[1].signature[7] ^= 1;  // another time
  EXPECT_EQ(check_note(read, witness), NoteVerdict::broken);
}

TEST(Cosignature, BearsItsTime) {
  const NoteSignature s = parse_signature_line(
      "— x ZGhGuQAAAABm/qTPeyKXD+R2rzyQsxPiP8mXum7qq/iF0u4vanlqJyocWODBt97w9uL+8qT7S5gxEHWWOworDcFiEBYJXORmnFBOBA==\n",
      "line");
  EXPECT_EQ(cosigned_at(s), 1727964367u);
  const SigningKey key = peters_key();
  const NoteSignature own = cosign_note(k_text, "w", key, 1679315147);
  const NoteKey as_cosigner{"w", NoteKind::cosignature, key.public_key},
      as_signer{"w", NoteKind::signature, key.public_key};
  EXPECT_TRUE(holds(own, as_cosigner, k_text));
  EXPECT_FALSE(holds(own, as_signer, k_text));
  EXPECT_NE(key_id_of(as_cosigner), key_id_of(as_signer));
}

TEST(Base64, IsCanonicalOrNone) {
  for (const char* bad : {"A", "AA", "AAA", "AA=", "AB==", "AAB=", "AAAA\n", " AAAA", "AA-_",
                          "AAAA=", "====", "AAA\x93",
                          "\xd2"
                          "AAA"})
    EXPECT_FALSE(from_base64(bad)) << bad;
  for (const char* good : {"", "AA==", "AAE=", "AAEC", "+/+/"})
    EXPECT_EQ(to_base64(*from_base64(good)), good);
}

}  // namespace
}  // namespace cavum::records
