// `cavum ledger backup | restore`: a copy while the ledger is in use, and going on from one.
#include <fmt/core.h>

#include <iostream>

#include "engine/base/text.h"
#include "engine/session/session.h"
#include "grading/ledger/backup.h"
#include "ui/parts/print_json.h"
#include "ui/verbs/ledger_verbs_parts.h"

namespace cavum::ui {

using nlohmann::json;

int ledger_backup(const LedgerOptions& o) {
  const ledger::Backup b = ledger::back_up({o.folder}, o.out, o.with_identities);
  if (o.as_json) {
    print_json(json{{"ledger", b.ledger_id},
                    {"entries", b.checkpoint.size},
                    {"root", to_hex(b.checkpoint.root)},
                    {"sessions", b.sessions},
                    {"copied", b.copied},
                    {"missing", b.missing},
                    {"identities", b.identities}});
  } else {
    std::cout << o.out << ": " << b.checkpoint.size << " entries up to " << utc_text(b.checkpoint.utc_ns) << ", " << b.sessions << " sessions ("
              << b.copied << " copied now), "
              << (b.identities         ? "identities"
                  : b.older_identities ? "no identities now; those of an earlier backup stay in it, without who was forgotten"
                                       : "no identities")
              << "\n";
    for (const auto& m : b.missing) std::cout << "  - session " << m << ": its file is gone or was changed, and is not in the backup\n";
  }
  return b.missing.empty() ? 0 : 1;
}

int ledger_restore(const LedgerOptions& o) {
  const ledger::RestorePlan plan = ledger::plan_restore(o.folder, o.receipts, o.cosigned);
  const bool refused = !plan.findings.empty() || (plan.last_seen && o.accept_loss.empty());
  if (!refused) ledger::restore(o.folder, o.out, plan, o.accept_loss, key_of(o));
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
  std::cout << o.folder
            << (plan.content.entries.size() == 1 ? ": a backup of one entry\n"
                                                 : fmt::format(": a backup of {} entries\n", plan.content.entries.size()));
  for (const auto& f : plan.findings) std::cout << "  - " << one_line(f) << "\n";
  for (const auto& l : plan.lost_entries) std::cout << "  - lost: " << one_line(l) << "\n";
  for (const auto& m : plan.missing_sessions) std::cout << "  - session " << m << ": its file is not in the backup, or was changed\n";
  if (!plan.identities) std::cout << "  not in it: who is behind the pseudonyms; copy identities.db from where it is kept\n";
  if (plan.identities && (plan.last_seen || !plan.compared))
    std::cout << "  whoever was forgotten after it was taken is known in it: forget them again\n";
  if (!plan.compared)
    std::cout << "  not checked: whether entries are lost, for this computer has no witness of the ledger; name receipts or cosigned notes\n";
  if (refused)
    std::cout << "NOT RESTORED" << (plan.findings.empty() ? ": --accept-loss REASON goes on without what is lost, and enters that" : "") << "\n";
  else
    std::cout << "restored: " << o.out << ", entry " << plan.content.entries.size() << " says so\n";
  return refused ? 1 : 0;
}

}  // namespace cavum::ui
