// `cavum report` and `cavum ledger report`: reports of recorded exams, for instructors and for
// students.
#include <fmt/core.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <filesystem>
#include <memory>
#include <optional>

#include "engine/base/error.h"
#include "engine/base/file.h"
#include "engine/base/file_name.h"
#include "engine/base/scratch_folder.h"
#include "engine/session/session_reader.h"
#include "grading/records/regrade.h"
#include "ui/cli/marked_session.h"
#include "ui/cli/solved_exam.h"
#include "ui/cli/verbs.h"
#include "ui/language/say.h"
#include "ui/parts/distinct_paths.h"
#include "ui/parts/option_checks.h"
#include "ui/parts/say.h"
#include "ui/report/figures/section_pictures.h"
#include "ui/report/integrity.h"
#include "ui/report/ledger_facts.h"
#include "ui/report/report.h"

namespace cavum::ui {
namespace {

constexpr char k_expert[] = "expert";  // of --compare

struct ReportArguments {
  std::string session, out, reader = "instructor", ledger, beside;
  MarkingOptions marking;
  bool overwrite = false, with_name = false, no_replay = false, pdf = false;
  [[nodiscard]] report::ReportReader for_whom() const {
    return reader == "student" ? report::ReportReader::student : report::ReportReader::instructor;
  }
};

/// What is proved of the session. One that the ledger took in without findings was replayed then,
/// and its file is the same.
report::ReportIntegrity integrity_of(const std::string& path, const ReportArguments& o,
                                     const records::FiledSession* filed,
                                     grading::ExamContexts& grounds) {
  const bool replayed_then = filed != nullptr && filed->findings.empty();
  report::ReportIntegrity i = o.no_replay || replayed_then
                                  ? report::read_integrity(path)
                                  : report::replayed_integrity(path, grounds);
  if (replayed_then && i.findings.empty()) {
    i.replay = report::ReportIntegrity::Replay::agrees;
    i.at_filing = true;
    i.remarks = {msg(
        "the motion was simulated again when the ledger took the session in, and the file is the same since then")};
  }
  return i;
}

/// What the ledger kept of a regrade, to mark by. Throws Error when it kept nothing: such a regrade
/// is older than that.
Marking marking_of(const report::ReportLedger& ledger, const records::FiledSession& session,
                   const records::Regrade& regrade) {
  const std::string entry = fmt::format("entry {}", regrade.seq);
  const auto basis = records::kept_basis(ledger.content, regrade);
  if (!basis && !regrade.person.empty())
    return {};  // a decision on the first mark: the exam's own rubric
  if (!basis)
    throw Error(
        msg("entry {}", regrade.seq),
        msg("is a regrade of entry {} by a rubric that the ledger did not keep then", session.seq),
        msg("name it with `cavum report --rubric` or --scenario, or enter the regrade again: it is kept from now on"));
  Marking m;
  m.scenario = records::scenario_of(*basis, entry + ": scenario.toml");
  m.rubric = records::rubric_of(*basis, entry + ": rubric.toml");
  m.another_task = true;  // was allowed when it was entered
  m.entry = regrade.seq;
  return m;
}

/// Another session of the same exam, and all that its report would be made of.
struct Beside {
  ScratchFolder scratch;
  MarkedSession marked;
  std::optional<grading::GradeInput> input;
  std::optional<report::ReportSource> source;
  std::string name;
};

/// The built-in expert sits the exam of the session.
void sit_by_expert(const std::string& session, const std::string& out) {
  const auto setup = scenarios::prepare_exam(SessionReader(session).setup());
  auto expert = scenarios::make_simulated_candidate(*setup, k_expert, 1, OmniModel{});
  static_cast<void>(sat_by(*setup, expert, out));
}

/// What `--compare` names. Throws Error when it is no session of the same task on the same tooth,
/// or, in a student's report, another student's.
std::unique_ptr<Beside> adjacent_of(const ReportArguments& o, const MarkedSession& own,
                                    const std::string& session, const report::ReportLedger* ledger,
                                    grading::ExamContexts& grounds) {
  auto b = std::make_unique<Beside>();
  const bool expert = o.beside == k_expert;
  const std::string file = expert ? b->scratch.file("expert.cavum") : o.beside;
  if (expert) sit_by_expert(session, file);
  b->marked = marked_session(file, o.marking, grounds);
  const grading::ReportFacts &mine = own.session->facts, &other = b->marked.session->facts;
  if (mine.tooth_hash != other.tooth_hash ||
      own.session->scenario.id != b->marked.session->scenario.id)
    throw Error(Name{"--compare " + o.beside}, msg("is of another task or tooth"),
                msg("name a session of the same exam, or `expert`"));
  if (o.for_whom() == report::ReportReader::student && !expert && mine.candidate != other.candidate)
    throw Error(Name{"--compare " + o.beside},
                msg("is another candidate's, which a student's report does not show"),
                msg("name an attempt of the same candidate, or `expert`"));
  if (o.for_whom() == report::ReportReader::student && !expert && ledger != nullptr)
    report::require_released_result(ledger->session(to_hex(sha256(read_file(o.beside))), o.beside),
                                    b->marked.result);
  b->input.emplace(b->marked.session->input());
  b->source.emplace(report::report_source(b->marked.result, *b->input, other, b->marked.rubric));
  const Number points = as_points(b->marked.result.points),
               most = as_points(b->marked.result.max_points);
  b->name = expert ? tr("the built-in expert, {} of {} points", points, most)
                   : tr("candidate {}, {}, {} of {} points", as_is(other.candidate),
                        as_is(other.created), points, most);
  return b;
}

bool is_practice(const grading::GradedSession& s) {
  return std::any_of(s.session.notes.begin(), s.session.notes.end(),
                     [](const auto& note) { return note.first == "practice"; });
}

/// The report of one session, as a file of that name holds it.
struct MadeReport {
  std::string text;
  Message verdict;  ///< a person's, where one decided
  Message finding;  ///< the first of what does not hold; empty: nothing
};

/// `filed` and `ledger` are null without a ledger. Tooth and zones come out of `grounds`.
MadeReport made_report(const std::string& session, const std::string& out, const ReportArguments& o,
                       const report::ReportLedger* ledger, const records::FiledSession* filed,
                       grading::ExamContexts& grounds) {
  const records::Regrade* regrade =
      filed != nullptr && !o.marking.anew() ? report::regrade_for(*filed, o.for_whom()) : nullptr;
  const MarkedSession m =
      regrade != nullptr ? marked_session(session, marking_of(*ledger, *filed, *regrade), grounds)
                         : marked_session(session, o.marking, grounds);
  const grading::GradeInput input = m.session->input();
  if (out.ends_with(".svg")) return {report::sections_svg(m.result, input), {}, {}};
  if (filed != nullptr && o.for_whom() == report::ReportReader::student)
    report::require_released_result(*filed, m.result);
  if (filed == nullptr && o.for_whom() == report::ReportReader::student &&
      m.session->scenario.hold_results && !is_practice(*m.session))
    throw Error(Name{session}, msg("its scenario holds results until the school releases them"),
                msg("name the ledger that holds it: --ledger"));
  report::ReportSource source = report::report_source(m.result, input, m.session->facts, m.rubric);
  if (m.regrade) source.regrade = &*m.comparison;
  source.reader = o.for_whom();
  std::unique_ptr<Beside> beside;
  if (!o.beside.empty()) {
    beside = adjacent_of(o, m, session, ledger, grounds);
    source.beside.emplace(report::ComparedReport{*beside->source, beside->name});
  }
  if (filed != nullptr) {
    source.filing = report::filing_of(*ledger, *filed, source.reader, o.with_name);
    source.filing->not_filed = report::not_the_filed_result(*filed, m.result, source.reader);
    if (!source.filing->not_filed.empty())
      source.filing->regrade.reset();  // this report is of something else
  }
  source.integrity = integrity_of(session, o, filed, grounds);
  const bool decided =
      source.filing && source.filing->regrade && !source.filing->regrade->person.empty();
  return {out.ends_with(".pdf") ? report::report_pdf(source) : report::report_html(source),
          msg("{}", grading::word_of(decided ? source.filing->regrade->verdict : m.result.verdict)),
          source.integrity.findings.empty() ? Message() : source.integrity.findings.front()};
}

void write_report(const std::string& session, const std::string& out, const ReportArguments& o,
                  const report::ReportLedger* ledger, const records::FiledSession* filed,
                  grading::ExamContexts& grounds) {
  const MadeReport made = made_report(session, out, o, ledger, filed, grounds);
  write_text_file(out, made.text);
  if (out.ends_with(".svg")) return;
  if (!made.finding.empty()) say_error(msg("notice: {}: does not hold: {}", session, made.finding));
  say(made.finding.empty()
          ? msg("written: {} ({})", out, made.verdict)
          : msg("written: {} ({}, of a session that does not hold)", out, made.verdict));
}

void run_report(const ReportArguments& o) {
  const bool picture = o.out.ends_with(".svg");
  if (o.with_name && o.ledger.empty())
    throw Error(Name{"--with-name"}, msg("names are known to a ledger only"),
                msg("add --ledger with its folder"));
  if (picture && !o.beside.empty())
    throw Error(Name{"--compare " + o.beside},
                msg("is shown in a report, not in a picture of sections"),
                msg("use a name ending in .html or .pdf"));
  report::require_report_path(o.out, o.overwrite, true);
  require_distinct_paths({{"--out " + o.out, o.out}},
                         {{"session", o.session}, {"--compare", o.beside}});
  require_sound_marking(o.marking);
  grading::ExamContexts grounds;
  if (o.ledger.empty()) return write_report(o.session, o.out, o, nullptr, nullptr, grounds);
  const report::ReportLedger ledger(o.ledger);
  const records::FiledSession& filed =
      ledger.session(to_hex(sha256(read_file(o.session))), o.session);
  if (!picture)
    static_cast<void>(report::filing_of(ledger, filed, o.for_whom(),
                                        o.with_name));  // refused before the work begins
  write_report(o.session, o.out, o, &ledger, &filed, grounds);
}

/// A student's report for each released session.
int run_all(const ReportArguments& o) {
  const report::ReportLedger ledger(o.ledger);
  std::error_code failed_to_make;
  std::filesystem::create_directories(o.out, failed_to_make);
  if (failed_to_make)
    throw Error(Name{"--out " + o.out}, msg("cannot be made ({})", failed_to_make.message()),
                msg("name a folder that you may write to"));
  ReportArguments each = o;
  each.reader = "student";
  grading::ExamContexts grounds;  // of the class
  int written = 0, failed = 0;
  for (const auto& s : ledger.registry.sessions) {
    if (s.shown->is_null()) continue;
    each.out = fmt::format("{}/{}-{}{}", o.out, file_name_of(s.candidate), s.seq,
                           o.pdf ? ".pdf" : ".html");
    try {
      report::require_report_path(each.out, each.overwrite);
      write_report(records::recording_of(ledger.places, s), each.out, each, &ledger, &s, grounds);
      ++written;
    } catch (const Error& e) {
      ++failed;
      say_error(e.message());
    }
  }
  say(msgn("{} report written", "{} reports written", written, written));
  if (failed > 0) say(msgn("{} report not written", "{} reports not written", failed, failed));
  return failed > 0 ? 1 : 0;
}

}  // namespace

std::string filed_report(const std::string& ledger_folder, const std::string& recording,
                         const std::string& reader) {
  ReportArguments o;
  o.reader = reader;
  o.session = recording;
  o.ledger = ledger_folder;
  const report::ReportLedger ledger(ledger_folder);
  const records::FiledSession& filed =
      ledger.session(to_hex(sha256(read_file(recording))), recording);
  grading::ExamContexts grounds;
  return made_report(recording, ".html", o, &ledger, &filed, grounds).text;
}

void add_report_verbs(CLI::App& app, int& exit_code) {
  const auto o = std::make_shared<ReportArguments>();
  auto* one = app.add_subcommand(
      "report", tr("Write the report of a recorded exam, or its sections as a picture"));
  one->add_option("session", o->session, tr("session file (.cavum)"))->required();
  one->add_option("--out", o->out,
                  tr("file to write: .html or .pdf for the report, .svg for three sections alone"))
      ->required();
  one->add_option(
         "--for", o->reader,
         tr("instructor: every figure; student: the verdict, the criteria, and where each point went"))
      ->check(one_of({"student", "instructor"}))
      ->capture_default_str();
  one->add_option(
      "--compare", o->beside,
      tr("another session of the same exam, or `expert`: its cavity and its replay beside this one's"));
  one->add_option("--ledger", o->ledger,
                  tr("the ledger that holds the session: other attempts, release, receipt"));
  one->add_flag("--with-name", o->with_name,
                tr("with --ledger: also the candidate's name, once the result is released"));
  one->add_flag("--no-replay", o->no_replay, tr("do not simulate the exam again to prove it"));
  one->add_option("--rubric", o->marking.rubric,
                  tr("mark by this rubric (TOML) instead of the session's own"));
  one->add_option("--scenario", o->marking.scenario, tr("mark by this corrected scenario (TOML)"));
  one->add_flag("--another-task", o->marking.another_task,
                tr("let --scenario be that of another task than the session's"));
  one->add_flag("--overwrite", o->overwrite, tr("write over a file that is no report"));
  one->callback([o, &exit_code] {
    run_report(*o);
    exit_code = 0;
  });

  const auto a = std::make_shared<ReportArguments>();
  auto* all = app.get_subcommand("ledger")->add_subcommand(
      "report", tr("A student's report for each released result, named by pseudonym and entry"));
  all->add_option("folder", a->ledger, tr("the ledger's folder"))->required();
  all->add_option("--out", a->out, tr("folder for the reports"))->required();
  all->add_flag("--pdf", a->pdf, tr("as PDF instead of HTML"));
  all->add_flag("--with-name", a->with_name, tr("also the candidates' names"));
  all->add_flag("--overwrite", a->overwrite, tr("write over files that are no reports"));
  all->callback([a, &exit_code] { exit_code = run_all(*a); });
}

}  // namespace cavum::ui
