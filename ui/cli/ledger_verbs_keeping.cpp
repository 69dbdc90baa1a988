// `cavum ledger forget | erase | key`: what the school keeps about people and for how long, and the
// key that it signs with.
#include <filesystem>

#include "engine/base/file.h"
#include "grading/records/candidate_id.h"
#include "grading/records/entry_text.h"
#include "grading/records/erasure.h"
#include "grading/records/school_keys.h"
#include "grading/records/ticket.h"
#include "ui/cli/ledger_verbs_parts.h"
#include "ui/parts/print_json.h"
#include "ui/parts/say.h"

namespace cavum::ui {

using nlohmann::json;

namespace {

void say_late(std::int64_t late) {
  say(msgn("{} identity removed that entries said was forgotten",
           "{} identities removed that entries said were forgotten", late, late));
}

}  // namespace

void ledger_forget(const LedgerOptions& o) {
  records::require_candidate_id("--candidate", o.candidate);
  records::Ledger ledger(o.folder, key_of(o));
  records::Identities identities(ledger.places().identities());
  if (const auto late = records::remove_forgotten(ledger.content(), identities); late > 0)
    say_late(late);
  std::vector<std::string> pseudonyms;
  for (const auto& i : identities.of_person(o.candidate)) pseudonyms.push_back(i.pseudonym);
  if (pseudonyms.empty())
    throw Error(Name{"--candidate " + o.candidate}, msg("is not among the identities"),
                msg("nothing is known of that candidate, or it was forgotten before"));
  records::forget(ledger, pseudonyms, {.motion = !o.keep_motion, .results = !o.keep_results});
  for (const auto& p : pseudonyms) {
    identities.forget(p);
    say(msg("{}: the identity is removed", p));
  }
  say(o.keep_motion
          ? msg("recordings are kept, with what they tell of accommodations, under pseudonyms that lead to nobody")
          : msg("recordings are erased"));
  say(o.keep_results
          ? msg("results are kept, with what they tell of accommodations, under pseudonyms that lead to nobody")
          : msg("results are erased"));
  say(msg("all proofs stay valid"));
  say(msg(
      "not reached from here: backups, exports, receipts and tickets that were given out, and recordings left on stations"));
}

void ledger_erase(const LedgerOptions& o) {
  records::Ledger ledger(o.folder, key_of(o));
  const bool names_some = !o.chosen_sessions.empty() || !o.before.empty();
  if (!names_some) {
    if (o.erase_motion || o.erase_results)
      throw Error(msg("ledger erase"), msg("needs to know of which sessions"),
                  msg("give --session for each, or --before"));
    ledger.wipe();
    const auto removed = records::remove_erased_recordings(ledger.content(), ledger.places());
    const auto n = static_cast<std::int64_t>(removed);
    say(msgn("{} recording removed that entries said was erased",
             "{} recordings removed that entries said were erased", n, n));
    if (std::filesystem::exists(ledger.places().identities())) {
      records::Identities identities(ledger.places().identities());
      const auto late = records::remove_forgotten(ledger.content(), identities);
      say_late(late);
    }
    return;
  }
  if (!o.erase_motion && !o.erase_results)
    throw Error(msg("ledger erase"), msg("needs to know what"),
                msg("give --motion, --results or both"));
  records::ErasureCommand wish{o.chosen_sessions, {}, o.erase_motion, o.erase_results};
  if (!o.before.empty()) wish.received_before = records::parse_utc(o.before, "--before");
  const auto erased = records::erase(ledger, wish, o.reason);
  if (o.as_json) {
    json list = json::array();
    for (const auto& one : erased)
      list.push_back({{"entry", one.entry}, {"what", records::word_of(one.what)}});
    return print_json(json{{"erased", list}});
  }
  if (erased.empty()) {
    say(msg("nothing is left to erase of these sessions"));
    return;
  }
  say(msg("entry {}: erased", ledger.content().entries.back().seq));
  for (const auto& one : erased)
    say(msg("entry {}: {}", one.entry, Term{records::word_of(one.what)}), 2);
}

void ledger_key(const LedgerOptions& o) {
  const std::string path = o.key.empty() ? records::school_key_path() : o.key;
  const std::int64_t until = o.until.empty() ? 0 : records::parse_utc(o.until, "--until");
  if (!o.replace && o.until.empty()) {
    for (const auto& k : records::read_ledger({o.folder}).keys) {
      const auto n = static_cast<std::int64_t>(k.first_size);
      say(k.until_utc_ns > 0 ? msgn("{} signs from {} entry on, good until {}",
                                    "{} signs from {} entries on, good until {}", n, k.public_key,
                                    n, utc_text(k.until_utc_ns))
                             : msgn("{} signs from {} entry on", "{} signs from {} entries on", n,
                                    k.public_key, n));
    }
    return;
  }
  if (!o.replace) {
    records::Ledger ledger(o.folder, key_of(o));
    records::limit_school_key(ledger, until, o.reason);
    say(msg("entry {}: the school's key is good until {}", ledger.content().entries.back().seq,
            utc_text(until)));
    return;
  }
  const std::string before = to_hex(records::load_school_key(path).public_key);
  const std::string now = records::replace_school_key(o.folder, path, until, o.reason,
                                                      records::school_public_key_path());
  say(msg("the school's key is now {}", now));
  say(msg("the one before it is kept as {}: other ledgers of the school still need it",
          records::old_key_path(path, before)));
  say(msg(
      "copy {} to each station; give cosigners the receipt of entry {} (`cavum ledger cosign --key-receipt`); back up the new key",
      records::school_public_key_path(),
      records::read_ledger({o.folder}).keys.back().first_size - 1));
}

}  // namespace cavum::ui
