// `cavum ledger release | regrade | decide | export | candidates`: what becomes of the results.
#include <fmt/core.h>

#include <algorithm>

#include "engine/base/file.h"
#include "engine/base/json_fields.h"
#include "engine/base/json_reader.h"
#include "grading/marking/session_input.h"
#include "grading/records/appeal.h"
#include "grading/records/candidate_id.h"
#include "grading/records/class_regrade.h"
#include "grading/records/decision.h"
#include "grading/records/entry_text.h"
#include "grading/records/erasure.h"
#include "grading/records/exports.h"
#include "grading/records/regrade.h"
#include "grading/records/release.h"
#include "grading/result/result_json.h"
#include "ui/cli/ledger_verbs_parts.h"
#include "ui/language/say.h"
#include "ui/parts/distinct_paths.h"
#include "ui/parts/option_checks.h"
#include "ui/parts/print_json.h"
#include "ui/parts/say.h"

namespace cavum::ui {

using nlohmann::json;

void ledger_release(const LedgerOptions& o) {
  if (!o.all && o.chosen.empty() && o.chosen_sessions.empty())
    throw Error(msg("ledger release"), msg("needs to know whose results"),
                msg("give --all, --candidate for each, or --session for each"));
  if (o.all && !(o.chosen.empty() && o.chosen_sessions.empty()))
    throw Error(Name{"--all"}, msg("is given with names"),
                msg("give either --all, or --candidate and --session"));
  records::Ledger ledger(o.folder, key_of(o));
  records::Identities identities = sound_identities(ledger);
  records::ReleaseCommand wish{o.all, o.with_findings, o.undecided, o.chosen, o.chosen_sessions};
  wish.candidates.clear();
  const records::Registry& filed = ledger.registry();
  for (const auto& who : o.chosen) {  // of a person all exams that are filed
    records::require_candidate_id("--candidate", who);
    const std::size_t before = wish.candidates.size();
    for (const auto& known : identities.of_id(who))
      if (std::any_of(
              filed.sessions.begin(), filed.sessions.end(),
              [&](const records::FiledSession& s) { return s.candidate == known.pseudonym; }))
        wish.candidates.push_back(known.pseudonym);
    if (wish.candidates.size() == before) wish.candidates.push_back(who);
  }
  const records::Release released = records::release_results(ledger, wish);
  if (o.as_json)
    return print_json(json{{"released", released.results.size()},
                           {"withheld", released.withheld},
                           {"to_decide", released.to_decide}});
  const auto n = static_cast<std::int64_t>(released.results.size());
  say(msgn("{} result released", "{} results released", n, n));
  if (released.withheld > 0)
    say(msg(
        "{} kept back: filed with findings or contested by another ending of the same exam (--candidate or --session with --with-findings "
        "releases one "
        "after an appeal), taken back, or filed after all of the exam was marked anew, and not marked so yet (--session releases one)",
        released.withheld));
  if (released.to_decide > 0)
    say(msg("{} kept back: a person has to decide (cavum ledger decide {})", released.to_decide,
            o.folder));
}

/// "pass, 80.8 of 100"
Message in_words(const json& result) {
  if (!result.is_object()) return msg("no result");
  const json& score = result.at("score");
  return msg("{}, {} of {}", Term{result.value("verdict", "")},
             as_points(score.at("points").get<double>()), as_number(score.at("max").get<double>()));
}

void regrade_session(const LedgerOptions& o) {
  records::Ledger ledger(o.folder, key_of(o));
  const records::Registry registry = records::read_registry(ledger.content());
  const records::FiledSession* found = registry.session(static_cast<std::uint64_t>(o.session_seq));
  if (found == nullptr)
    throw Error(Name{fmt::format("--session {}", o.session_seq)}, msg("is no session's entry"),
                msg("see `cavum ledger show {}`", o.folder));
  const records::RegradeBasis basis = records::read_basis(o.rubric, o.scenario);
  const auto graded = grading::load_for_grading(records::recording_of(ledger.places(), *found));
  if (auto scenario = records::scenario_of(basis, o.scenario)) {
    grading::use_scenario(*graded, std::move(*scenario), o.another_task);
    grading::use_rubric(*graded, graded->scenario.rubric);
  }
  if (auto rubric = records::rubric_of(basis, o.rubric))
    grading::use_rubric(*graded, std::move(*rubric));
  const json result = grading::to_json(grading::grade(graded->input(), graded->rubric));
  const auto& entry = records::enter_regrade(ledger, found->seq, result, basis, o.reason);
  if (o.as_json)
    print_json(json{{"seq", entry.seq},
                    {"before", member_of(*found->result, "score")},
                    {"verdict_before", text_in(*found->result, "verdict")},
                    {"after", result.at("score")},
                    {"verdict", result.at("verdict")}});
  else
    say(found->shown->is_null()
            ? msg("entry {}: {} before; {} now", entry.seq, in_words(*found->result),
                  in_words(result))
            : msg("entry {}: {} before; {} now; the old result stands until the new one is released",
                  entry.seq, in_words(*found->result), in_words(result)));
}

/// A whole exam: nothing is entered before each session of it is marked.
int regrade_exam(const LedgerOptions& o) {
  records::Ledger ledger(o.folder, key_of(o),
                         o.preview ? records::LedgerUse::tell : records::LedgerUse::add);
  records::ClassRegrade plan = records::plan_class_regrade(
      ledger.registry(), o.exam, records::read_basis(o.rubric, o.scenario));
  pool::Work work = records::work_of(plan, o.folder);
  work.another_task = o.another_task;
  records::take_lines(plan, make_lines(work, o.pool).lines, o.folder);
  std::size_t other_verdict = 0, other_points = 0;
  json table = json::array();
  Lines rows;
  for (const auto& s : plan.sessions) {
    other_verdict += s.other_verdict() ? 1 : 0;
    other_points += s.other_points() ? 1 : 0;
    table.push_back({{"session", s.session},
                     {"candidate", s.candidate},
                     {"before", member_of(*s.before, "score")},
                     {"verdict_before", text_in(*s.before, "verdict")},
                     {"after", member_of(s.after, "score")},
                     {"verdict", text_in(s.after, "verdict")}});
    if (s.other_verdict() || s.other_points())
      rows.row({msg("{}", s.session), Name{s.candidate},
                msg("{} before; {} now", in_words(*s.before), in_words(s.after))},
               2);
  }
  const std::size_t entered = o.preview ? 0 : records::enter_class_regrade(ledger, plan, o.reason);
  if (o.as_json) {
    print_json(json{{"sessions", table},
                    {"other_verdict", other_verdict},
                    {"other_points", other_points},
                    {"entered", entered},
                    {"left_out", plan.left_out}});
    return 0;
  }
  say(rows);
  say(msg("{} sessions: {} with another verdict, {} with other points", plan.sessions.size(),
          other_verdict, other_points));
  say(o.preview ? msg("nothing was entered")
                : msg("{} entered, which wait for their release", entered));
  if (plan.left_out > 0)
    say(msg("{} left out, for their recording or result is erased", plan.left_out));
  return 0;
}

int ledger_regrade(const LedgerOptions& o) {
  if (o.rubric.empty() && o.scenario.empty())
    throw Error(msg("ledger regrade"), msg("needs to know by what"),
                msg("give --rubric R.toml or --scenario S.toml"));
  if (o.exam.empty() == (o.session_seq < 0))
    throw Error(msg("ledger regrade"), msg("needs to know what"),
                msg("give --session, or --exam for all of an exam"));
  if (o.reason.empty() && !o.preview)
    throw Error(Name{"--reason"}, msg("is no line of text"),
                msg("say in one line of UTF-8 why the result changes"));
  if (!o.exam.empty()) return regrade_exam(o);
  if (o.preview)
    throw Error(Name{"--preview"}, msg("is of a whole exam"), msg("give it with --exam"));
  regrade_session(o);
  return 0;
}

void ledger_decide(const LedgerOptions& o) {
  if (o.session_seq < 0) {
    const records::LedgerContent content = records::read_ledger({o.folder});
    if (!content.findings.empty())
      throw Error(Name{o.folder}, msg("does not hold ({})", content.findings.front().message()),
                  msg("see `cavum ledger verify {}`", o.folder));
    const auto queue = records::review_queue(records::read_registry(content));
    json list = json::array();
    Lines rows;
    for (const auto& d : queue) {
      list.push_back({{"session", d.session},
                      {"candidate", d.candidate},
                      {"scenario", d.scenario_id},
                      {"points", d.points},
                      {"max", d.max},
                      {"reasons", d.reasons}});
      rows.row({msg("{}", d.session), Name{d.candidate}, Name{d.scenario_id},
                msg("{} of {}", as_points(d.points), as_number(d.max))},
               2);
      for (const auto& reason : d.reasons) rows.add(msg("{}", reason.what()), 10);
    }
    if (o.as_json) return print_json(json{{"to_decide", list}});
    say(rows);
    const auto n = static_cast<std::int64_t>(queue.size());
    say(msgn("{} result waits for a person's decision", "{} results wait for a person's decision",
             n, n));
    return;
  }
  if (o.verdict.empty() || o.person.empty() || o.reason.empty())
    throw Error(msg("ledger decide --session"), msg("needs verdict, person and reason"),
                msg("give --verdict pass or fail, --person and --reason"));
  records::Ledger ledger(o.folder, key_of(o));
  const auto& entry =
      records::enter_decision(ledger, static_cast<std::uint64_t>(o.session_seq),
                              {records::decided_verdict(o.verdict), o.person, o.reason});
  if (o.as_json)
    print_json(json{{"seq", entry.seq},
                    {"session", o.session_seq},
                    {"verdict", o.verdict},
                    {"person", o.person}});
  else
    say(msg("entry {}: {}, decided by {}; it waits for its release", entry.seq, Term{o.verdict},
            o.person));
}

void ledger_retract(const LedgerOptions& o) {
  records::Ledger ledger(o.folder, key_of(o));
  const auto& entry = records::retract_results(ledger, o.chosen_sessions, o.reason);
  const std::size_t taken = o.chosen_sessions.size();
  if (o.as_json)
    print_json(json{{"seq", entry.seq}, {"retracted", taken}});
  else
    say(msgn(
        "entry {}: {} result taken back; what was exported or handed out before is still there",
        "entry {}: {} results taken back; what was exported or handed out before is still there",
        static_cast<std::int64_t>(taken), entry.seq, taken));
}

namespace {

/// The list of all appeals.
void print_appeals(const LedgerOptions& o) {
  const records::LedgerContent content = records::read_ledger({o.folder});
  if (!content.findings.empty())
    throw Error(Name{o.folder}, msg("does not hold ({})", content.findings.front().message()),
                msg("see `cavum ledger verify {}`", o.folder));
  json list = json::array();
  Lines rows;
  std::int64_t open = 0;
  for (const auto& s : records::read_registry(content).sessions)
    for (const auto& a : s.appeals) {
      open += a.closed_by ? 0 : 1;
      list.push_back({{"entry", a.seq},
                      {"session", s.seq},
                      {"candidate", s.candidate},
                      {"reason", a.reason},
                      {"outcome", a.closed_by ? json(records::word_of(a.outcome)) : json()},
                      {"answer", a.closed_by ? json(a.answer) : json()}});
      rows.row({msg("{}", s.seq), Name{s.candidate}, Name{a.reason}}, 2);
      rows.add(a.closed_by ? msg("{}: {}", Term{records::word_of(a.outcome)}, a.answer)
                           : msg("not answered yet"),
               10);
    }
  if (o.as_json) return print_json(json{{"appeals", list}});
  say(rows);
  say(msgn("{} appeal is open", "{} appeals are open", open, open));
}

}  // namespace

void ledger_appeal(const LedgerOptions& o) {
  if (o.session_seq < 0) return print_appeals(o);
  if (o.reason.empty())
    throw Error(msg("ledger appeal --session"), msg("needs a reason"), msg("give --reason"));
  records::Ledger ledger(o.folder, key_of(o));
  const auto session = static_cast<std::uint64_t>(o.session_seq);
  const auto& entry =
      o.outcome.empty() ? records::open_appeal(ledger, session, o.reason)
                        : records::answer_appeal(
                              ledger, session,
                              records::of_word<records::Outcome>(o.outcome, "--outcome"), o.reason);
  if (o.as_json)
    print_json(json{{"seq", entry.seq},
                    {"session", session},
                    {"outcome", o.outcome.empty() ? json() : json(o.outcome)}});
  else
    say(o.outcome.empty()
            ? msg("entry {}: the appeal is open", entry.seq)
            : msg("entry {}: the appeal is answered: {}", entry.seq, Term{o.outcome}));
}

void ledger_export(const LedgerOptions& o) {
  const records::Ledger ledger(o.folder, key_of(o), records::LedgerUse::tell);
  records::Identities identities = sound_identities(ledger);
  const records::Registry registry = records::read_registry(ledger.content());
  const records::Wording in_words = [](const Message& m) { return tr(m); };
  int left_out = 0;
  std::string text;
  if (o.format == "moodle")
    text = records::moodle_csv(registry, identities, left_out, in_words, o.with_simulated);
  if (o.format == "lti")
    text = records::lti_scores(registry, identities, in_words, o.with_simulated).dump(2) + "\n";
  if (o.format == "json") text = records::signed_results(registry, ledger) + "\n";
  if (o.format == "csv") text = records::tidy_csv(registry);
  require_distinct_paths({{"--out " + o.out, o.out}},
                         {{"", ledger.places().database()}, {"", ledger.places().identities()}});
  require_new(o, o.out);
  write_school_file(o, o.out, text);
  say(msg("written: {}", o.out));
  if (std::none_of(registry.sessions.begin(), registry.sessions.end(),
                   [](const records::FiledSession& s) { return s.shown->is_object(); }))
    say(msgn("no result is released; {} is pending", "no result is released; {} are pending",
             static_cast<std::int64_t>(registry.sessions.size()), registry.sessions.size()));
  if (const auto simulated = records::released_simulated(registry);
      simulated > 0 && (o.format == "moodle" || o.format == "lti"))
    say(o.with_simulated
            ? msgn(
                  "{} released result of a simulated operator is in it, marked SIMULATED, under no student's number",
                  "{} released results of simulated operators are in it, marked SIMULATED, under no student's number",
                  static_cast<std::int64_t>(simulated), simulated)
            : msgn(
                  "{} released result of a simulated operator is left out (--with-simulated writes it, marked)",
                  "{} released results of simulated operators are left out (--with-simulated writes them, marked)",
                  static_cast<std::int64_t>(simulated), simulated));
  if (left_out > 0)
    say(msgn("left out, for nobody is known by name behind it: {} released result",
             "left out, for nobody is known by name behind them: {} released results", left_out,
             left_out));
}

void ledger_candidates(const LedgerOptions& o) {
  const records::Ledger ledger(o.folder, key_of(o), records::LedgerUse::tell);
  records::Identities identities = sound_identities(ledger);
  json all = json::array();
  Lines rows;
  for (const auto& i : identities.all()) {
    all.push_back({{"candidate", i.pseudonym}, {"exam", i.exam}, {"id", i.id}, {"name", i.name}});
    rows.row({Name{i.pseudonym}, i.exam.empty() ? msg("any exam") : msg("{}", i.exam),
              i.name.empty() ? msg("{}", i.id) : msg("{}, {}", i.id, i.name)});
  }
  if (o.as_json)
    print_json(json{{"candidates", all}});
  else
    say(rows);
}

}  // namespace cavum::ui
