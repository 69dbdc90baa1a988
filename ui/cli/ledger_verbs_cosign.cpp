// `cavum ledger checkpoint | cosign | add-cosignature`: other parties sign what the school signs of
// its ledger.
#include <fmt/core.h>

#include <filesystem>

#include "engine/base/file.h"
#include "engine/base/json_fields.h"
#include "engine/base/json_reader.h"
#include "engine/session/session.h"
#include "grading/records/cosign.h"
#include "ui/cli/ledger_verbs_parts.h"
#include "ui/parts/distinct_paths.h"
#include "ui/parts/print_json.h"
#include "ui/parts/say.h"

namespace cavum::ui {

using nlohmann::json;

std::vector<records::NoteKey> cosigners_of(const LedgerOptions& o) {
  if (!o.cosigners.empty() && !std::filesystem::exists(o.cosigners))
    throw Error(Name{"--cosigners " + o.cosigners}, msg("is not there"),
                msg("name a file with a cosigner's key on each line"));
  return records::read_cosigners(o.cosigners.empty() ? records::known_cosigners_path()
                                                     : o.cosigners);
}

void ledger_checkpoint(const LedgerOptions& o) {
  const records::Ledger ledger(o.folder, key_of(o), records::LedgerUse::tell);
  if (o.since < -1)
    throw Error(Name{fmt::format("--since {}", o.since)}, msg("is no number of entries"),
                msg("give 0 for a cosigner who has signed nothing yet"));
  const std::uint64_t since =
      o.since < 0 ? records::last_cosigned(ledger.content()) : static_cast<std::uint64_t>(o.since);
  const std::string request = records::cosign_request(ledger.content(), since);
  require_new(o, o.out);
  write_text_file(o.out, request);
  say(msg("written: {}, {} entries, proved since {}", o.out, ledger.content().entries.size(),
          since));
  say(msg("for `cavum ledger cosign`; the school's public key: {}", ledger.content().public_key));
}

int ledger_cosign(const LedgerOptions& o) {
  records::Cosigner cosigner;
  cosigner.memory = o.state.empty() ? records::cosigner_memory_path() : o.state;
  cosigner.school_key = o.school_key.empty() ? "" : parse_public_key(o.school_key, "--school-key");
  for (const auto& path : o.key_receipts) {
    const json receipt = parse_json_or_null(read_text_file(path));
    cosigner.key_entries.push_back(text_in(receipt, "entry"));
    if (cosigner.key_entries.back().empty())
      throw Error(Name{path}, msg("is no receipt"),
                  msg("name the receipt of the entry by which the school replaced its key"));
  }
  const std::string request = read_text_file(o.folder);
  require_distinct_paths({{"--out " + o.out, o.out}}, {{"", o.folder}, {"", o.key}});
  if (!o.overwrite && std::filesystem::exists(o.out))
    throw Error(Name{"--out " + o.out}, msg("is there already"),
                msg("name another file, or add --overwrite"));
  cosigner.key = load_signing_key(o.key.empty() ? station_path("cosigner.key") : o.key, "cosigner");
  cosigner.name = o.name_of_cosigner.empty()
                      ? "cavum.cosigner/" + to_hex(cosigner.key.public_key).substr(0, 16)
                      : o.name_of_cosigner;
  constexpr std::int64_t k_ns = 1'000'000'000;
  const records::Cosigned cosigned = records::cosign(
      cosigner, request, o.folder, static_cast<std::uint64_t>(read_clocks().utc_ns / k_ns));
  const std::string key =
      records::key_line({cosigner.name, records::NoteKind::cosignature, cosigner.key.public_key});
  if (cosigned.findings.empty()) write_text_file(o.out, cosigned.note);
  if (o.as_json) {
    print_json(json{{"cosigned", cosigned.findings.empty()},
                    {"ledger", cosigned.ledger_id},
                    {"entries", cosigned.size},
                    {"cosigner", key},
                    {"findings", cosigned.findings}});
  } else if (cosigned.findings.empty()) {
    say(msg("cosigned: {} entries of ledger {}", cosigned.size, cosigned.ledger_id));
    say(msg("written: {}", o.out));
    say(msg("this cosigner's key line, for $CAVUM_HOME/cosigners at the school: {}", key));
  } else {
    say(msg("{}: NOT COSIGNED", o.folder));
    for (const auto& f : cosigned.findings) say(msg("- {}", f.message()), 2);
  }
  return cosigned.findings.empty() ? 0 : 1;
}

int ledger_add_cosignature(const LedgerOptions& o) {
  records::Ledger ledger(o.folder, key_of(o));
  const auto cosigners = cosigners_of(o);
  bool all = true;
  for (const auto& path : o.cosigned) {
    auto note = records::check_cosigned(read_text_file(path), cosigners, ledger.content());
    if (note.findings.empty() && note.cosignatures.empty())
      throw Error(Name{path}, msg("bears no cosignature of a cosigner that is known here"),
                  msg("put the key line that `cavum ledger cosign` shows into {}",
                      (o.cosigners.empty() ? records::known_cosigners_path() : o.cosigners)));
    if (!note.findings.empty()) say(msg("{}: NOT KEPT", path));
    for (const auto& f : note.findings) say(msg("- {}", f.message()), 2);
    all = all && note.findings.empty();
    if (!note.findings.empty()) continue;
    ledger.keep_cosignatures(note.checkpoint->size, note.cosignatures);
    const auto n = static_cast<std::int64_t>(note.cosignatures.size());
    say(msgn("{}: kept: {} cosignature under {} entries",
             "{}: kept: {} cosignatures under {} entries", n, path, n, note.checkpoint->size));
  }
  return all ? 0 : 1;
}

}  // namespace cavum::ui
