// `cavum ledger`: the names and options of its verbs.
#include <CLI/CLI.hpp>
#include <functional>
#include <memory>

#include "ui/cli/grant_options.h"
#include "ui/cli/ledger_verbs_parts.h"
#include "ui/cli/verbs.h"
#include "ui/language/say.h"
#include "ui/parts/option_checks.h"

namespace cavum::ui {
namespace {

using LedgerRun = std::function<int(const LedgerOptions&)>;

/// Of a verb that either does its work or throws Error.
LedgerRun done(void (*run)(const LedgerOptions&)) {
  return [run](const LedgerOptions& options) {
    run(options);
    return 0;
  };
}

/// `cavum ledger` while its verbs are added: they all fill the same options.
class LedgerCommand {
 public:
  LedgerCommand(CLI::App& app, int& exit_code)
      : app_(app.add_subcommand(
            "ledger",
            tr("Tickets, filed exams, results and their release, kept so that no change goes unseen"))),
        exit_code_(exit_code) {
    app_->require_subcommand(1);
  }
  /// A verb that signs nothing with the school's key; `folder` says what its first argument is.
  CLI::App* keyless(const char* name, const std::string& what, const std::string& folder,
                    const LedgerRun& run) {
    auto* v = app_->add_subcommand(name, what);
    v->add_option("folder", options->folder, folder)->required();
    v->callback([o = options, run, name, &exit_code = exit_code_] {
      if (o->folder.empty())
        throw Error(msg("cavum ledger {}", name), msg("no folder named"),
                    msg("name the ledger's folder"));
      exit_code = run(*o);
    });
    return v;
  }
  CLI::App* verb(const char* name, const std::string& what, const LedgerRun& run,
                 const std::string& folder = tr("the ledger's folder")) {
    auto* v = keyless(name, what, folder, run);
    v->add_option("--key", options->key,
                  tr("the school's signing key (default: $CAVUM_HOME/school.key)"));
    return v;
  }
  void json_flag(CLI::App* v) {
    v->add_flag("--json", options->as_json, tr("one JSON object on stdout"));
  }

  const std::shared_ptr<LedgerOptions> options = std::make_shared<LedgerOptions>();

 private:
  CLI::App* app_;
  int& exit_code_;
};

void add_init(LedgerCommand& ledger) {
  const auto& o = ledger.options;
  auto* v = ledger.verb("init", tr("Make a new ledger"), done(ledger_init));
  v->add_option("--school", o->school, tr("name of the school, entered first"))
      ->capture_default_str();
  ledger.json_flag(v);
}

void add_station(LedgerCommand& ledger) {
  const auto& o = ledger.options;
  auto* v =
      ledger.verb("station", tr("List the stations whose exams count; invite, enrol or revoke one"),
                  done(ledger_station));
  auto* invite =
      v->add_option("--invite", o->invite, tr("make a one-time code for a station of this name"));
  auto* enrol =
      v->add_option(
           "--enrol", o->enrol,
           tr("enter the station whose request this file is (`cavum station --enrol | --replace-key` wrote it)"))
          ->excludes(invite);
  v->add_option("--revoke", o->revoke,
                tr("its public key: nothing that it signs and that comes in from now on counts"))
      ->excludes(invite)
      ->excludes(enrol);
  v->add_option(
      "--until", o->until,
      tr("with --invite: until when the code is good (else a week); with --enrol: until when the key is (else without end)"));
  v->add_option("--reason", o->reason, tr("with --revoke: why, in one line; it is kept for ever"));
  ledger.json_flag(v);
}

void add_ticket(LedgerCommand& ledger) {
  const auto& o = ledger.options;
  auto* v = ledger.verb("ticket", tr("Promise an exam to a candidate, or to a list of them"),
                        ledger_ticket);
  v->add_option("scenario", o->scenario, tr("scenario file (.toml)"))->required();
  v->add_option("--candidate", o->candidate,
                tr("matriculation number or mail address; kept with the identities only"));
  v->add_option("--name", o->name, tr("for people; kept with the identities only"));
  v->add_option(
      "--candidates", o->candidates,
      tr("CSV for a whole class, with columns id, name, extra_time_percent, extra_time_s, left_handed, high_contrast; --out is then a folder"));
  v->add_option("--ignore-column", o->passed_over,
                tr("a column of that file that is not needed; any other unknown one is refused"));
  v->add_option("--from", o->from,
                tr("first moment at which the exam may begin, UTC: 2026-11-21T09:00Z"))
      ->required();
  v->add_option("--until", o->until, tr("last moment at which it may begin"))->required();
  v->add_option("--tooth", o->tooth, tr("another tooth than the scenario's"));
  v->add_option("--model", o->model, tr("force model"))->capture_default_str();
  v->add_option("--rubric", o->rubric,
                tr("mark by this rubric (TOML) instead of the scenario's own"));
  add_grant_options(v, o->grant);
  v->add_flag(
      "--another", o->another,
      tr("also to a candidate who has a ticket for this exam that is still good, or has sat it"));
  v->add_flag("--begin-at-ledger", o->begin_at_ledger,
              tr("the exam counts only when the ledger let it begin (`cavum ledger begin`)"));
  v->add_option("--out", o->out, tr("ticket to write, or the folder for a class"))->required();
  v->add_flag("--overwrite", o->overwrite, tr("write over a file that is there"));
  ledger.json_flag(v);
}

void add_tickets(LedgerCommand& ledger) {
  auto* v = ledger.keyless("tickets", tr("List the tickets and what became of them"),
                           tr("the ledger's folder"), done(ledger_tickets));
  ledger.json_flag(v);
}

void add_cancel(LedgerCommand& ledger) {
  const auto& o = ledger.options;
  auto* v = ledger.verb("cancel", tr("Cancel a ticket that was not used"), done(ledger_cancel));
  v->add_option("--ticket", o->ticket_entry, tr("its entry"))->required();
  v->add_option("--reason", o->reason, tr("why, in one line; it is kept for ever, so no names"))
      ->required();
}

void add_begin(LedgerCommand& ledger) {
  const auto& o = ledger.options;
  auto* v = ledger.verb("begin",
                        tr("Let the exam of a ticket begin now: by the ledger's clock, and once"),
                        done(ledger_begin));
  v->add_option("--ticket", o->ticket_file, tr("the ticket's file"))->required();
  v->add_option(
      "--again", o->again,
      tr("why an exam that was let begin before begins anew, in one line; only the last one counts"));
  v->add_option("--out", o->out, tr("file to write (default: beside the ticket, NAME.begin)"));
  v->add_flag("--overwrite", o->overwrite, tr("write over a file that is there"));
}

void add_add(LedgerCommand& ledger) {
  const auto& o = ledger.options;
  auto* v = ledger.verb(
      "add",
      tr("File finished exams: verified tick by tick, checked against their tickets, counter-signed"),
      ledger_add);
  v->add_option("sessions", o->sessions, tr(".cavum files, or folders of them"))->required();
  v->add_flag("--without-ticket", o->without_ticket, tr("also exams that nobody promised"));
  v->add_flag(
      "--simulated", o->simulated,
      tr("also what no candidate's hand moved: simulated operators, motion files, practice; it stays marked as that"));
  v->add_flag("--with-findings", o->with_findings,
              tr("also what does not hold, with what was found: for an appeal"));
  v->add_option("--receipts", o->receipts_folder,
                tr("folder for receipts: what a candidate can show without the ledger"));
  ledger.json_flag(v);
}

void add_release(LedgerCommand& ledger) {
  const auto& o = ledger.options;
  auto* v =
      ledger.verb("release", tr("Let results go to candidates and exports"), done(ledger_release));
  v->add_flag(
      "--all", o->all,
      tr("all that are filed without findings and not contested, what simulated operators sat, too: that is never written under a "
         "student's number"));
  v->add_option("--candidate", o->chosen,
                tr("pseudonym or the school's own number; may be repeated"));
  v->add_option(
      "--session", o->chosen_sessions,
      tr("its entry: chooses one of several endings of an exam, which then alone counts; may be repeated"));
  v->add_flag(
      "--with-findings", o->with_findings,
      tr("with --candidate or --session: also one that was filed with findings, with --session also one that is contested, after an appeal"));
  v->add_flag("--undecided", o->undecided,
              tr("also results that a person has yet to decide: they go out as `review`"));
  ledger.json_flag(v);
}

void add_regrade(LedgerCommand& ledger) {
  const auto& o = ledger.options;
  auto* v = ledger.verb(
      "regrade",
      tr("Mark a filed exam by another rubric or a corrected scenario: a new result beside the old"),
      ledger_regrade);
  auto* session = v->add_option("--session", o->session_seq, tr("its entry"));
  v->add_option(
       "--exam", o->exam,
       tr("all sessions of this scenario's id instead, or none where one cannot be marked"))
      ->excludes(session);
  v->add_flag("--preview", o->preview,
              tr("of --exam: only the table of what would change; nothing is entered"));
  v->add_option("--rubric", o->rubric, tr("rubric (TOML)"));
  v->add_option("--scenario", o->scenario, tr("corrected scenario (TOML)"));
  v->add_option("--reason", o->reason,
                tr("why, in one line; it is kept for ever, so no names and nothing personal"));
  v->add_flag("--another-task", o->another_task,
              tr("let --scenario be that of another task than the session's"));
  add_pool_options(*v, o->pool);
  ledger.json_flag(v);
}

void add_decide(LedgerCommand& ledger) {
  const auto& o = ledger.options;
  auto* v = ledger.verb(
      "decide",
      tr("Results that the program leaves to a person: the queue, and with --session one's decision"),
      done(ledger_decide));
  v->add_option("--session", o->session_seq, tr("its entry"));
  v->add_option("--verdict", o->verdict, tr("pass or fail"))->check(one_of({"pass", "fail"}));
  v->add_option("--person", o->person, tr("who decides, in one line; it is kept for ever"));
  v->add_option("--reason", o->reason,
                tr("why, in one line; it is kept for ever, so no names and nothing personal"));
  ledger.json_flag(v);
}

void add_retract(LedgerCommand& ledger) {
  const auto& o = ledger.options;
  auto* v = ledger.verb(
      "retract",
      tr("Take released results back: they stand in no export until something is released again"),
      done(ledger_retract));
  v->add_option("--session", o->chosen_sessions, tr("its entry; may be repeated"))->required();
  v->add_option("--reason", o->reason,
                tr("why, in one line; it is kept for ever, so no names and nothing personal"))
      ->required();
  ledger.json_flag(v);
}

void add_appeal(LedgerCommand& ledger) {
  const auto& o = ledger.options;
  auto* v = ledger.verb(
      "appeal",
      tr("Appeals against results: the list, and with --session a new one, or with --outcome its answer"),
      done(ledger_appeal));
  v->add_option("--session", o->session_seq, tr("its entry"));
  v->add_option(
       "--outcome", o->outcome,
       tr("answers the open appeal: stands, or changed when another result was entered since"))
      ->check(one_of({"stands", "changed"}));
  v->add_option(
      "--reason", o->reason,
      tr("what is objected to, or the answer, in one line; it is kept for ever, so no names and nothing personal"));
  ledger.json_flag(v);
}

void add_verify(LedgerCommand& ledger) {
  const auto& o = ledger.options;
  auto* v = ledger.verb("verify", tr("Check every entry, signature, ticket and filed session"),
                        ledger_verify);
  v->add_flag("--replay", o->replay, tr("simulate every session again, too"));
  add_pool_options(*v, o->pool);
  v->add_option(
      "--receipt", o->receipts,
      tr("check this receipt, and that the ledger still begins with what it saw; may be repeated"));
  v->add_option(
      "--cosigned", o->cosigned,
      tr("check this note of a cosigner, and that the ledger still begins with what it saw; may be repeated"));
  v->add_option(
      "--cosigners", o->cosigners,
      tr("key lines of the cosigners whose word counts (default: $CAVUM_HOME/cosigners)"));
  v->add_option(
      "--results", o->results,
      tr("check this file of `export --format json`: signed by this school and unchanged"));
  ledger.json_flag(v);
}

void add_export(LedgerCommand& ledger) {
  const auto& o = ledger.options;
  auto* v = ledger.verb("export", tr("Write results for other systems"), done(ledger_export));
  v->add_option(
       "--format", o->format,
       tr("moodle (gradebook CSV), lti (scores of LTI Advantage), json (all results, signed), csv (a row for each criterion)"))
      ->required()
      ->check(one_of({"moodle", "lti", "json", "csv"}));
  v->add_option("--out", o->out, tr("file to write"))->required();
  v->add_flag(
      "--with-simulated", o->with_simulated,
      tr("moodle and lti: also what simulated operators sat, marked, under no student's number"));
  v->add_flag("--overwrite", o->overwrite, tr("write over a file that is there"));
}

void add_receipt(LedgerCommand& ledger) {
  const auto& o = ledger.options;
  auto* v = ledger.verb(
      "receipt",
      tr("Write an entry's receipt again: it proves without the ledger that the entry is in it"),
      done(ledger_receipt));
  v->add_option("--entry", o->entry, tr("its number"))->required();
  v->add_option(
      "--from-size", o->from_size,
      tr("prove also that the ledger's first entries, this many, are the beginning of it"));
  v->add_option("--out", o->out, tr("file to write"))->required();
  v->add_flag("--overwrite", o->overwrite, tr("write over a file that is there"));
}

void add_candidates(LedgerCommand& ledger) {
  auto* v =
      ledger.verb("candidates", tr("List who is behind which pseudonym"), done(ledger_candidates));
  ledger.json_flag(v);
}

void add_forget(LedgerCommand& ledger) {
  const auto& o = ledger.options;
  auto* v = ledger.verb(
      "forget",
      tr("Remove a candidate's identity and erase recordings and results; all proofs stay valid"),
      done(ledger_forget));
  v->add_option("--candidate", o->candidate,
                tr("one of the pseudonyms, or the school's own number"))
      ->required();
  v->add_flag(
      "--keep-motion", o->keep_motion,
      tr("keep the recordings, under pseudonyms that lead to nobody; they hold the accommodations"));
  v->add_flag("--keep-results", o->keep_results,
              tr("keep the results likewise; they tell of accommodations, too"));
}

void add_erase(LedgerCommand& ledger) {
  const auto& o = ledger.options;
  auto* v = ledger.verb(
      "erase",
      tr("Erase recordings or results; all proofs stay valid. Without more: remove what a crash left of it"),
      done(ledger_erase));
  v->add_option("--session", o->chosen_sessions, tr("its entry; may be repeated"));
  v->add_option("--before", o->before,
                tr("all that came in before this time, UTC: 2026-11-21T09:00Z"));
  v->add_flag("--motion", o->erase_motion,
              tr("the recording: motion, forces, ticket, accommodations"));
  v->add_flag("--results", o->erase_results,
              tr("the school's mark, all regrades, and what the station sealed"));
  v->add_option("--reason", o->reason, tr("why, in one line; it is kept for ever, so no names"));
  ledger.json_flag(v);
}

void add_key(LedgerCommand& ledger) {
  const auto& o = ledger.options;
  auto* v = ledger.verb(
      "key", tr("List the school's keys; replace the present one, or say until when it is good"),
      done(ledger_key));
  v->add_flag("--replace", o->replace,
              tr("draw a new one, which signs from now on; the old one is kept beside it"));
  v->add_option("--until", o->until,
                tr("until when the new one, or without --replace the present one, is good, UTC"));
  v->add_option("--reason", o->reason, tr("why, in one line; it is kept for ever"));
}

void add_checkpoint(LedgerCommand& ledger) {
  const auto& o = ledger.options;
  auto* v = ledger.verb(
      "checkpoint",
      tr("Write what the school signs of the ledger, for a cosigner: with the proof that it goes on from what he signed before"),
      done(ledger_checkpoint));
  v->add_option(
      "--since", o->since,
      tr("entries that the cosigner signed before (default: those of the last cosignature in the ledger)"));
  v->add_option("--out", o->out, tr("file to write"))->required();
  v->add_flag("--overwrite", o->overwrite, tr("write over a file that is there"));
}

void add_cosign(LedgerCommand& ledger) {
  const auto& o = ledger.options;
  auto* v = ledger.keyless(
      "cosign",
      tr("For another party, on another computer: sign a ledger's checkpoint, if it goes on from the one that was signed before"),
      tr("what `cavum ledger checkpoint` wrote"), ledger_cosign);
  v->add_option(
      "--key", o->key,
      tr("the cosigner's own key, made when there is none (default: $CAVUM_HOME/cosigner.key)"));
  v->add_option(
      "--name", o->name_of_cosigner,
      tr("name that stands in the signature (default: cavum.cosigner/ and the key's first digits)"));
  v->add_option(
      "--school-key", o->school_key,
      tr("the school's public key, the first time: 64 hexadecimal digits, from the school itself"));
  v->add_option(
      "--key-receipt", o->key_receipts,
      tr("receipt of the entry by which the school replaced its key (`cavum ledger receipt`); may be repeated"));
  v->add_option("--state", o->state,
                tr("folder that remembers what was signed (default: $CAVUM_HOME/cosigned)"));
  v->add_option("--out", o->out, tr("the note with the cosignature, to write"))->required();
  v->add_flag("--overwrite", o->overwrite, tr("write over a file that is there"));
  ledger.json_flag(v);
}

void add_add_cosignature(LedgerCommand& ledger) {
  const auto& o = ledger.options;
  auto* v = ledger.verb("add-cosignature",
                        tr("Keep what a cosigner has signed, so that receipts show it"),
                        ledger_add_cosignature);
  v->add_option("note", o->cosigned, tr("what `cavum ledger cosign` wrote"))->required();
  v->add_option(
      "--cosigners", o->cosigners,
      tr("key lines of the cosigners whose word counts (default: $CAVUM_HOME/cosigners)"));
}

void add_backup(LedgerCommand& ledger) {
  const auto& o = ledger.options;
  auto* v = ledger.keyless(
      "backup",
      tr("Copy the ledger while it is in use: its entries at one moment, their checkpoint, the filed sessions"),
      tr("the ledger's folder"), ledger_backup);
  v->add_option(
       "--out", o->out,
       tr("folder: a new one, or an earlier backup of the ledger, which is brought up to date"))
      ->required();
  v->add_flag("--with-identities", o->with_identities,
              tr("also who is behind the pseudonyms: then keep the backup as you keep names"));
  ledger.json_flag(v);
}

void add_restore(LedgerCommand& ledger) {
  const auto& o = ledger.options;
  auto* v = ledger.verb("restore",
                        tr("Go on from a backup: checks it, says what is missing, and enters that"),
                        ledger_restore, tr("the backup's folder"));
  v->add_option("--out", o->out, tr("folder of the ledger to make"))->required();
  v->add_option("--receipt", o->receipts,
                tr("a receipt at hand: shows entries that the backup lacks; may be repeated"));
  v->add_option("--cosigned", o->cosigned,
                tr("a cosigned note at hand, for the same; may be repeated"));
  v->add_option(
      "--accept-loss", o->accept_loss,
      tr("why the school goes on without entries that are lost, in one line; it is kept for ever, so no names"));
  ledger.json_flag(v);
}

void add_show(LedgerCommand& ledger) {
  auto* v = ledger.verb("show", tr("List what is filed"), ledger_show);
  ledger.json_flag(v);
}

}  // namespace

void add_ledger_verbs(CLI::App& app, int& exit_code) {
  LedgerCommand ledger(app, exit_code);
  for (auto* add :
       {add_init,   add_station,    add_ticket,  add_tickets,         add_cancel,  add_begin,
        add_add,    add_release,    add_regrade, add_decide,          add_retract, add_appeal,
        add_verify, add_export,     add_receipt, add_candidates,      add_forget,  add_erase,
        add_key,    add_checkpoint, add_cosign,  add_add_cosignature, add_backup,  add_restore,
        add_show})
    add(ledger);
}

}  // namespace cavum::ui
