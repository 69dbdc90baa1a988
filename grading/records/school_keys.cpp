#include "grading/records/school_keys.h"

#include <fmt/core.h>

#include <algorithm>
#include <filesystem>

#include "engine/base/write_file.h"
#include "engine/session/session.h"
#include "grading/records/entry_text.h"
#include "grading/records/identities.h"
#include "grading/records/ledger.h"
#include "grading/records/ledger_error.h"

namespace cavum::records {
namespace {

using nlohmann::json;
namespace fs = std::filesystem;

Bytes message_of(const std::string& ledger, const std::string& previous, const std::string& next,
                 std::int64_t until_utc_ns) {
  const std::string text = "CVKEYNEW" + json{{"ledger", ledger},
                                             {"previous", previous},
                                             {"public_key", next},
                                             {"until_utc_ns", until_utc_ns}}
                                            .dump();
  return {text.begin(), text.end()};
}

bool is_hex_key(const std::string& key) {
  return key.size() == 64 && key.find_first_not_of("0123456789abcdef") == std::string::npos;
}

bool is_signed_by_key_before(const KeyEntry& key, const std::string& ledger_id,
                             const std::string& before) {
  return is_hex_key(key.public_key) &&
         is_signed_by(before, message_of(ledger_id, before, key.public_key, key.until_utc_ns),
                      key.signature);
}

}  // namespace

const std::string& LedgerContent::key_of(std::uint64_t size) const {
  const SchoolKey* found = nullptr;
  for (const auto& k : keys)
    if (k.first_size <= size) found = &k;
  return found != nullptr ? found->public_key : public_key;
}

bool LedgerContent::has_key(const std::string& key) const {
  return std::any_of(keys.begin(), keys.end(),
                     [&](const SchoolKey& k) { return k.public_key == key; });
}

void read_school_keys(LedgerContent& c) {
  c.keys.assign(1, {1, c.entries.at(0).as<InitEntry>()->public_key, 0});
  for (const auto& e : c.entries) {
    if (const auto* key = e.as<KeyEntry>()) {
      if (is_signed_by_key_before(*key, c.id, c.keys.back().public_key))
        c.keys.push_back({e.seq + 1, key->public_key, key->until_utc_ns});
      else
        c.findings.push_back(finding<FindingKind::key_unsigned>().in_entry(e.seq));
    } else if (const SchoolKey& k = c.keys.back();
               k.until_utc_ns > 0 && e.utc_ns > k.until_utc_ns) {
      c.findings.push_back(
          finding<FindingKind::key_run_out>(utc_text(e.utc_ns), utc_text(k.until_utc_ns))
              .in_entry(e.seq));
    }
  }
  c.public_key = c.keys.back().public_key;
}

std::optional<std::string> successor_named_by(const std::string& entry_text,
                                              const std::string& ledger_id,
                                              const std::string& present) {
  const LedgerEntry entry = read_entry_or_none(entry_text);
  const auto* key = entry.as<KeyEntry>();
  return key != nullptr && is_signed_by_key_before(*key, ledger_id, present)
             ? std::optional(key->public_key)
             : std::nullopt;
}

void require_key_in_time(const LedgerContent& c, std::int64_t now_utc_ns) {
  const SchoolKey& k = c.keys.back();
  if (k.until_utc_ns > 0 && now_utc_ns > k.until_utc_ns)
    throw Error(LedgerError::ended, msg("the school's key"),
                msg("ran out on {}", utc_text(k.until_utc_ns)),
                msg("replace it: `cavum ledger key LEDGER --replace`"));
}

KeyEntry school_key_entry(const LedgerContent& c, const SigningKey& present, const SigningKey& next,
                          std::int64_t until_utc_ns) {
  const std::string next_key = to_hex(next.public_key);
  return {next_key, until_utc_ns,
          to_hex(present.sign(message_of(c.id, c.public_key, next_key, until_utc_ns)))};
}

std::string next_key_path(const std::string& path) { return path + ".next"; }

std::string old_key_path(const std::string& path, const std::string& public_key) {
  return fmt::format("{}.{}", path, public_key.substr(0, 8));
}

std::string replace_school_key(const std::string& folder, const std::string& path,
                               std::int64_t until_utc_ns, const std::string& reason,
                               const std::string& public_path) {
  const LedgerPaths places{folder};
  const SigningKey present = load_school_key(path);
  const std::string waiting = next_key_path(path), before = to_hex(present.public_key);
  const SigningKey next = load_school_key(waiting, true);  // on disk before anything depends on it
  const std::string now = to_hex(next.public_key);
  if (read_ledger(places).public_key !=
      now) {  // else it was entered before, and the rest was cut off
    Ledger ledger(folder, present);
    ledger.change_key(next, until_utc_ns, reason);
  }
  if (fs::exists(places.identities())) Identities(places.identities()).seal_again(present, next);
  const std::string kept = old_key_path(path, before);
  if (!fs::exists(kept)) fs::create_hard_link(path, kept);
  if (!public_path.empty())
    write_text_file(
        public_path,
        now + "\n");  // before the key takes its place: until then running it again goes on
  fs::rename(waiting, path);
  sync_folder_of(path);
  return now;
}

void limit_school_key(Ledger& ledger, std::int64_t until_utc_ns, const std::string& reason) {
  ledger.change_key(ledger.key(), until_utc_ns, reason);
}

}  // namespace cavum::records
