// `cavum ledger init | add | receipt`: a ledger, and the exams that were sat.
#include <fmt/core.h>

#include <filesystem>

#include "engine/base/file.h"
#include "engine/base/memory_reserve.h"
#include "engine/base/message_from.h"
#include "engine/base/text.h"
#include "grading/records/filing.h"
#include "ui/cli/ledger_verbs_parts.h"
#include "ui/cli/session_files.h"
#include "ui/parts/print_json.h"
#include "ui/parts/say.h"

namespace cavum::ui {

using nlohmann::json;

SigningKey key_of(const LedgerOptions& o) {
  return records::load_school_key(o.key.empty() ? records::school_key_path() : o.key);
}

void require_new(const LedgerOptions& o, const std::string& path) {
  require_writable(path);
  const records::LedgerPaths places{o.folder};
  std::error_code none;
  for (const std::string& kept : {places.database(), places.identities(),
                                  records::school_key_path(), records::school_public_key_path(),
                                  o.key, station_path("station.key"), station_path("used_tickets")})
    if (!kept.empty() && std::filesystem::weakly_canonical(path, none) ==
                             std::filesystem::weakly_canonical(kept, none))
      throw Error(Name{"--out " + path}, msg("holds a key, identities or entries"),
                  msg("name another file: it is never written over"));
  if (!o.overwrite && std::filesystem::exists(path))
    throw Error(Name{"--out " + path}, msg("is there already"),
                msg("name another file, or add --overwrite"));
}

void write_school_file(const LedgerOptions& o, const std::string& path, const std::string& text) {
  write_text_file(path, text, {.is_private = true, .may_replace = o.overwrite});
}

bool has_content(const std::string& path) {
  std::error_code missing;
  const auto size = std::filesystem::file_size(path, missing);
  return !missing && size > 0;
}

/// A ledger that was made with this key and name, and whose identities were not.
bool was_cut_off(const records::LedgerPaths& places, const std::string& school,
                 const SigningKey& key) {
  std::error_code none;
  if (!std::filesystem::exists(places.database(), none) || has_content(places.identities()))
    return false;
  const records::LedgerContent c = records::read_ledger(places);
  return c.findings.empty() && c.entries.size() == 1 && c.school == school &&
         c.public_key == to_hex(key.public_key);
}

void ledger_init(const LedgerOptions& o) {
  constexpr std::size_t k_longest_school = 254;
  if (o.school.empty() || o.school.size() > k_longest_school || !is_plain_text(o.school))
    throw Error(Name{"--school"},
                o.school.empty() ? msg("names no school")
                : o.school.size() > k_longest_school
                    ? msg("is longer than {} bytes", k_longest_school)
                    : msg("holds a control character or bytes that are no UTF-8"),
                msg("give the school's name in one line of UTF-8"));
  const SigningKey key =
      records::load_school_key(o.key.empty() ? records::school_key_path() : o.key, true);
  if (!was_cut_off({o.folder}, o.school, key)) records::Ledger::create(o.folder, o.school, key);
  static_cast<void>(records::Identities(records::LedgerPaths{o.folder}.identities(), true));
  const std::string known = records::school_public_key_path();
  if (!std::filesystem::exists(known)) write_text_file(known, to_hex(key.public_key) + "\n");
  const records::LedgerContent content = records::read_ledger({o.folder});
  if (o.as_json) {
    print_json(
        json{{"ledger", content.id}, {"public_key", content.public_key}, {"folder", o.folder}});
    return;
  }
  say(msg("ledger {} in {}", content.id, o.folder));
  say(msg("the school's public key: {}", content.public_key));
  say(msg(
      "keep apart from it, and in a backup: {} (signs), {} (shows when an older copy is put back)",
      o.key.empty() ? records::school_key_path() : o.key, records::witness_path(content.id)));
  say(msg("to each station's own folder goes a copy of {}", known));
}

int ledger_add(const LedgerOptions& o) {
  records::Ledger ledger(o.folder, key_of(o));
  if (!o.receipts_folder.empty()) {  // before anything is entered: a receipt that cannot be written
                                     // is no receipt
    make_private_folder(o.receipts_folder);
    require_writable(o.receipts_folder + "/receipt.json");
  }
  json printed = json::array();
  bool all = true;
  grading::ExamContexts grounds;  // of the class
  for (const auto& path : session_files(o.sessions)) {
    records::Filing filing;
    keep_memory_reserve();
    try {
      filing = records::file_session(ledger, path, {o.without_ticket, o.simulated, o.with_findings},
                                     grounds);
    } catch (const DatabaseError&) {
      throw;  // the disk: what was acknowledged stands, and nothing more can be
    } catch (const Error& e) {
      if (o.sessions.size() == 1 && !std::filesystem::is_directory(o.sessions[0])) throw;
      filing.findings.push_back(records::finding<records::FindingKind::read_failed>(e.message()));
    } catch (const std::bad_alloc&) {
      throw;
    } catch (
        const std::exception& e) {  // of this one recording: those after it are filed all the same
      filing.findings.push_back(
          records::finding<records::FindingKind::file_unreadable>(message_from(e)));
    }
    all = all && filing.seq && filing.findings.empty();
    json one = {{"file", path}, {"filed", filing.seq.has_value()}, {"findings", filing.findings}};
    if (filing.seq) {
      one["receipt"] = ledger.receipt(*filing.seq);
      if (!o.receipts_folder.empty())
        write_private_text_file(fmt::format("{}/receipt-{}.json", o.receipts_folder, *filing.seq),
                                one["receipt"].dump(2) + "\n");
    }
    if (!o.as_json) {
      say(filing.seq ? msg("{}: entry {}", path, *filing.seq) : msg("{}: NOT FILED", path));
      for (const auto& f : filing.findings) say(msg("- {}", f.message()), 2);
    }
    printed.push_back(std::move(one));
  }
  if (o.as_json) print_json(json{{"sessions", printed}});
  return all ? 0 : 1;
}

void ledger_receipt(const LedgerOptions& o) {
  const records::Ledger ledger(o.folder, key_of(o), records::LedgerUse::tell);
  if (o.entry < 0 || o.entry >= static_cast<std::int64_t>(ledger.content().entries.size()))
    throw Error(Name{fmt::format("--entry {}", o.entry)}, msg("is no entry of this ledger"),
                msg("see `cavum ledger show {}`", o.folder));
  if (o.from_size < 0 || o.from_size > static_cast<std::int64_t>(ledger.content().entries.size()))
    throw Error(Name{fmt::format("--from-size {}", o.from_size)},
                msg("is no number of entries that this ledger has had"),
                msg("give 1 to {}", ledger.content().entries.size()));
  require_new(o, o.out);
  const json receipt = records::make_receipt(ledger.content(), static_cast<std::uint64_t>(o.entry),
                                             static_cast<std::uint64_t>(o.from_size));
  write_school_file(o, o.out, receipt.dump(2) + "\n");
  say(msg("written: {}", o.out));
}

}  // namespace cavum::ui
