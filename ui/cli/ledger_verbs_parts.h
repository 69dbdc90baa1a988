// What the verbs of `cavum ledger` share: their options, and the functions behind them, by file:
// _filing (init, add, receipt), _ticket (ticket, tickets, cancel, begin), _results (release,
// regrade, decide, retract, appeal, export, candidates), _keeping (forget, erase, key), _check
// (verify, show), _station (station), _cosign (checkpoint, cosign, add-cosignature), _backup
// (backup, restore).
#pragma once

#include <string>
#include <vector>

#include "grading/records/identities.h"
#include "grading/records/ledger.h"
#include "scenarios/file/accommodations.h"
#include "ui/cli/pool_options.h"

namespace cavum::ui {

struct LedgerOptions {
  std::string folder, key, school = "school", scenario, candidate, name, candidates, from, until,
                           out, tooth, rubric, model = "consistent", format, results, reason,
                           invite, enrol, revoke, name_of_cosigner, state, school_key, cosigners,
                           accept_loss, again, before, verdict, person, outcome, exam, ticket_file,
                           receipts_folder;
  std::vector<std::string> sessions, chosen, receipts, key_receipts, cosigned, passed_over;
  scenarios::Grant grant;
  PoolOptions pool;
  std::vector<std::uint64_t> chosen_sessions;
  std::int64_t session_seq = -1, ticket_entry = -1, entry = -1, since = -1, from_size = 0;
  bool as_json = false, without_ticket = false, with_findings = false, simulated = false,
       all = false, replay = false, overwrite = false, another_task = false, with_simulated = false,
       with_identities = false, another = false, begin_at_ledger = false, keep_motion = false,
       keep_results = false, erase_motion = false, erase_results = false, replace = false,
       undecided = false, preview = false;
};

/// The school's key: --key, else the one in its place. Throws Error when there is none.
[[nodiscard]] SigningKey key_of(const LedgerOptions& options);
/// Throws Error when `path` cannot be written, holds a key, identities or entries, or is there
/// already and --overwrite does not allow it.
void require_new(const LedgerOptions& options, const std::string& path);
/// Writes what concerns the school alone, for its user alone; never over a file that came there
/// meanwhile unless --overwrite allows it.
void write_school_file(const LedgerOptions& options, const std::string& path,
                       const std::string& text);
/// Cosigners whose word counts: --cosigners, else those in their place. Throws Error when a file
/// that was named is not there.
[[nodiscard]] std::vector<records::NoteKey> cosigners_of(const LedgerOptions& options);

// Each runs a verb; those that return a number give the exit code, 0 or 1. They throw Error.
void ledger_init(const LedgerOptions& options);
int ledger_ticket(const LedgerOptions& options);
void ledger_tickets(const LedgerOptions& options);
void ledger_cancel(const LedgerOptions& options);
void ledger_begin(const LedgerOptions& options);
int ledger_add(const LedgerOptions& options);
void ledger_receipt(const LedgerOptions& options);
void ledger_release(const LedgerOptions& options);
int ledger_regrade(const LedgerOptions& options);
void ledger_decide(const LedgerOptions& options);
void ledger_retract(const LedgerOptions& options);
void ledger_appeal(const LedgerOptions& options);
void ledger_export(const LedgerOptions& options);
void ledger_candidates(const LedgerOptions& options);
void ledger_forget(const LedgerOptions& options);
void ledger_erase(const LedgerOptions& options);
void ledger_key(const LedgerOptions& options);
int ledger_verify(const LedgerOptions& options);
int ledger_show(const LedgerOptions& options);
void ledger_station(const LedgerOptions& options);
void ledger_checkpoint(const LedgerOptions& options);
int ledger_cosign(const LedgerOptions& options);
int ledger_add_cosignature(const LedgerOptions& options);
int ledger_backup(const LedgerOptions& options);
int ledger_restore(const LedgerOptions& options);

}  // namespace cavum::ui
