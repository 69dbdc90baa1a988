// `cavum ledger backup | restore`: a copy while the ledger is in use, and going on from one.

#include "engine/session/session.h"
#include "grading/records/backup.h"
#include "ui/cli/ledger_verbs_parts.h"
#include "ui/parts/print_json.h"
#include "ui/parts/say.h"

namespace cavum::ui {

using nlohmann::json;

int ledger_backup(const LedgerOptions& o) {
  const records::Backup b = records::back_up({o.folder}, o.out, o.with_identities);
  if (o.as_json) {
    print_json(json{{"ledger", b.ledger_id},
                    {"entries", b.checkpoint.size},
                    {"root", to_hex(b.checkpoint.root)},
                    {"sessions", b.sessions},
                    {"copied", b.copied},
                    {"missing", b.missing},
                    {"identities", b.identities}});
  } else {
    const std::string when = utc_text(b.checkpoint.utc_ns);
    say(b.identities ? msg("{}: {} entries up to {}, {} sessions ({} copied now), identities",
                           o.out, b.checkpoint.size, when, b.sessions, b.copied)
        : b.older_identities
            ? msg("{}: {} entries up to {}, {} sessions ({} copied now), no identities now; those of an earlier backup stay in it, without who was "
                  "forgotten",
                  o.out, b.checkpoint.size, when, b.sessions, b.copied)
            : msg("{}: {} entries up to {}, {} sessions ({} copied now), no identities", o.out,
                  b.checkpoint.size, when, b.sessions, b.copied));
    for (const auto& m : b.missing)
      say(msg("- session {}: its file is gone or was changed, and is not in the backup", m), 2);
  }
  return b.missing.empty() ? 0 : 1;
}

int ledger_restore(const LedgerOptions& o) {
  const records::RestorePlan plan = records::plan_restore(o.folder, o.receipts, o.cosigned);
  const bool refused = !plan.findings.empty() || (plan.last_seen && o.accept_loss.empty());
  if (!refused) records::restore(o.folder, o.out, plan, o.accept_loss, key_of(o));
  if (o.as_json) {
    print_json(json{{"restored", !refused},
                    {"entries", plan.content.entries.size()},
                    {"findings", plan.findings},
                    {"lost", plan.lost_entries},
                    {"missing_sessions", plan.missing_sessions},
                    {"identities", plan.identities},
                    {"compared", plan.compared}});
    return refused ? 1 : 0;
  }
  const auto n = static_cast<std::int64_t>(plan.content.entries.size());
  say(msgn("{}: a backup of {} entry", "{}: a backup of {} entries", n, o.folder, n));
  for (const auto& f : plan.findings) say(msg("- {}", f.message()), 2);
  for (const auto& l : plan.lost_entries) say(msg("- lost: {}", l), 2);
  for (const auto& m : plan.missing_sessions)
    say(msg("- session {}: its file is not in the backup, or was changed", m), 2);
  if (!plan.identities)
    say(msg("not in it: who is behind the pseudonyms; copy identities.db from where it is kept"),
        2);
  if (plan.identities && (plan.last_seen || !plan.compared))
    say(msg("whoever was forgotten after it was taken is known in it: forget them again"), 2);
  if (!plan.compared)
    say(msg("not checked: whether entries are lost, for this computer has no witness of the ledger; name receipts or cosigned notes"),
        2);
  if (!refused)
    say(msg("restored: {}, entry {} says so", o.out, n));
  else
    say(plan.findings.empty()
            ? msg("NOT RESTORED: --accept-loss REASON goes on without what is lost, and enters that")
            : msg("NOT RESTORED"));
  return refused ? 1 : 0;
}

}  // namespace cavum::ui
