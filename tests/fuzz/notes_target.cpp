// Signed notes, by the first byte: a note, a key's line, a signature's line, a note that others
// cosigned, a request to cosign, and the same request with its checkpoint signed by the school.
// Behind each a byte that keeps the rest in place.
#include <algorithm>
#include <cstdlib>

#include "grading/records/checkpoint.h"
#include "grading/records/cosign.h"
#include "tests/fuzz/material.h"
#include "tests/fuzz/targets.h"

namespace cavum::fuzz {
namespace {

const std::vector<records::NoteKey>& known_cosigners() {
  static const std::vector<records::NoteKey> k_known{
      {"cosigner.example", records::NoteKind::cosignature, station_key().public_key}};
  return k_known;
}

records::Cosigner cosigner() {
  return {"cosigner.example", station_key(), work_folder() + "/cosigned",
          to_hex(school_key().public_key)};
}

/// The text of a note with the school's own signature under it, whatever it says.
std::string signed_by_school(const std::string& request) {
  const auto gap = request.find("\n\n"),
             end = request.find("\n\n", gap == std::string::npos ? gap : gap + 2);
  if (gap == std::string::npos || end == std::string::npos) return request;
  const std::string text = request.substr(gap + 2, end + 1 - gap - 2);
  return request.substr(0, gap + 2) +
         records::write_note({text,
                              {records::sign_note(text, records::ledger_origin(school_ledger().id),
                                                  school_key())}});
}

void try_to_cosign(const std::string& request) {
  const records::Cosigned made = records::cosign(cosigner(), request, "request", 1'800'000'000);
  // what was signed has the school's signature, and is taken by whoever knows the cosigner
  if (made.findings.empty() &&
      records::check_cosigned(made.note, known_cosigners(), school_ledger()).cosignatures.empty())
    std::abort();
}

}  // namespace

void fuzz_notes(Data data) {
  if (data.empty()) return;
  const std::string text = text_of(data.subspan(1)), school = to_hex(school_key().public_key);
  try {
    switch (data[0] % 6) {
      case 0: {
        const records::SignedNote note = records::parse_note(text, "note");
        if (records::write_note(records::parse_note(records::write_note(note), "note")) !=
            records::write_note(note))
          std::abort();
        static_cast<void>(
            records::check_note(note, records::checkpoint_key(school_ledger().id, school)));
        for (const auto& line : note.signatures) static_cast<void>(records::cosigned_at(line));
        break;
      }
      case 1:
        static_cast<void>(records::key_line(records::parse_key_line(text, "key")));
        break;
      case 2:
        static_cast<void>(records::signature_line(records::parse_signature_line(text, "line")));
        break;
      case 3:
        static_cast<void>(records::check_cosigned(text, known_cosigners(), school_ledger()));
        break;
      case 4:
        try_to_cosign(text);
        break;
      default:
        try_to_cosign(signed_by_school(text));
    }
  } catch (const Error&) {
  }
}

std::vector<Bytes> notes_seeds() {
  const records::LedgerContent& ledger = school_ledger();
  const auto with = [](char kind, const std::string& text) { return bytes_of(kind + text); };
  const std::string note =
      records::checkpoint_note(ledger.id, ledger.public_key, ledger.checkpoints.back());
  const std::string text = records::checkpoint_text(ledger.id, ledger.checkpoints.back());
  records::SignedNote cosigned = records::parse_note(note, "note");
  cosigned.signatures.push_back(
      records::cosign_note(text, "cosigner.example", station_key(), 1'800'000'000));
  std::vector<Bytes> seeds{
      with(0, note),
      with(0, records::write_note(cosigned)),
      with(1, records::key_line(known_cosigners()[0])),
      with(1, records::key_line(records::checkpoint_key(ledger.id, ledger.public_key))),
      with(2, records::signature_line(cosigned.signatures[1])),
      with(3, records::write_note(cosigned))};
  for (const char kind : {char{4}, char{5}})
    for (const std::uint64_t since : {std::uint64_t{0}, std::uint64_t{1}})
      seeds.push_back(with(kind, records::cosign_request(ledger, since)));
  return seeds;
}

}  // namespace cavum::fuzz
