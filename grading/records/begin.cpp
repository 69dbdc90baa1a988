#include "grading/records/begin.h"

#include <algorithm>
#include <filesystem>

#include "engine/base/json_fields.h"
#include "engine/base/json_reader.h"
#include "engine/base/text.h"
#include "grading/records/entry_text.h"
#include "grading/records/ledger_error.h"
#include "grading/records/registry.h"

namespace cavum::records {
namespace {

using nlohmann::json;

Bytes message_of(const Begin& b) {
  const std::string text = "CVLETBEG" + json_of(b).dump();
  return {text.begin(), text.end()};
}

}  // namespace

std::string begin_text(const BeginEntry& e) {
  return json{{"begin", json_of(e.begin)}, {"signature", e.signature}}.dump();
}

void require_signed(const Begin& b, const std::string& signature, const std::string& public_key,
                    const Where& where) {
  if (!public_key.empty() && b.public_key != public_key)
    throw Error(where, msg("is of another school"), msg("ask this school's office"));
  if (!is_signed_by(b.public_key, message_of(b), signature))
    throw Error(LedgerError::bad_signature, where, msg("was changed after the school signed it"),
                msg("ask the office again"));
}

Begin parse_begin(const std::string& text, const std::string& public_key, const Where& where) {
  const json j = parse_json_or_null(text);
  if (!member_of(j, "begin").is_object())
    throw Error(where, msg("is not the ledger's word to begin"),
                msg("name a file that `cavum ledger begin` wrote"));
  auto b = value_in<Begin>(j["begin"], where);
  require_signed(b, text_in(j, "signature"), public_key, where);
  return b;
}

namespace {

Message begun_before(const Registry& registry, const LedgerEntry& begin) {
  const Station* at = registry.stations.of(begin.by.station);
  if (at == nullptr) return msg("was let begin before, by entry {}", begin.seq);
  return msg("was let begin before, at {}, by entry {}", at->name, begin.seq);
}

}  // namespace

std::string let_begin(Ledger& ledger, const std::string& nonce, const std::string& again) {
  const auto& entered = ledger.append(
      [&](const LedgerContent& now) {
        const Registry& registry = ledger.registry();
        const std::int64_t utc_ns = read_clocks().utc_ns;
        const auto t =
            std::find_if(registry.tickets.begin(), registry.tickets.end(),
                         [&](const IssuedTicket& issued) { return issued.ticket.nonce == nonce; });
        const auto refuse = [](LedgerError code, const Message& why, const Message& advice) {
          throw Error(code, msg("the ticket"), why, advice);
        };
        if (t == registry.tickets.end())
          refuse(LedgerError::unknown, msg("was not issued by this ledger"),
                 msg("name a ticket of it"));
        if (t->cancelled_by)
          refuse(LedgerError::ended, msg("was cancelled by entry {}", *t->cancelled_by),
                 msg("give the candidate another"));
        if (t->made_up_by)
          refuse(LedgerError::contested, msg("was made up by entry {}", *t->made_up_by),
                 msg("the makeup's ticket is good"));
        if (t->used_by)
          refuse(LedgerError::used, msg("was used: its exam is filed as entry {}", *t->used_by),
                 msg("give the candidate another"));
        if (utc_ns < t->ticket.not_before_utc_ns || utc_ns > t->ticket.not_after_utc_ns)
          refuse(LedgerError::not_now,
                 msg("is good from {} to {}", utc_text(t->ticket.not_before_utc_ns),
                     utc_text(t->ticket.not_after_utc_ns)),
                 msg("wait, or give another"));
        if (!t->begins.empty() && again.empty())
          refuse(
              LedgerError::twice, begun_before(registry, now.entries.at(t->begins.back().seq)),
              msg("only the exam that bears the last word counts: say with --again why it begins anew"));
        BeginEntry entry{
            {now.id, nonce, random_hex(16), utc_ns, now.public_key}, {}, !t->begins.empty()};
        entry.signature = to_hex(ledger.key().sign(message_of(entry.begin)));
        return entry;
      },
      one_line(again));
  return begin_text(*entered.as<BeginEntry>());
}

std::string begin_path(const std::string& ticket_path) {
  return std::filesystem::path(ticket_path).replace_extension(".begin").string();
}

}  // namespace cavum::records
