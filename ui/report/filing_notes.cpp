#include <cmath>

#include "engine/base/text.h"
#include "ui/language/say.h"
#include "ui/report/motion_charts.h"
#include "ui/report/report_document.h"

namespace cavum::report {
namespace {

/// Whether the marks changed by more than they do by themselves.
Paragraph progress_words(const ReportFiling& f) {
  const auto paragraph = [](const char* id, const std::string& words) {
    return Paragraph{words, "", Paragraph::Kind::normal, id};
  };
  if (!f.scatter)
    return paragraph(
        "change_unknown",
        tr("How much marks vary from one attempt to the next is not known yet: that takes {} further attempts of {} candidates or more.",
           cohort::k_min_steps, cohort::k_min_repeaters));
  if (!f.progress) return paragraph("first_attempt", tr("This is the first attempt that counts."));
  const cohort::Progress& p = *f.progress;
  const Message by_chance =
      msg("up to {} may be chance, as {} steps of {} candidates from one attempt to the next show",
          as_percent(p.bound_percent), f.scatter->steps, f.scatter->candidates);
  if (!p.told())
    return paragraph(
        "no_change",
        tr("Over {} attempts no change can be told from chance: {}, and {}.", p.attempts,
           Number{p.change_percent, Unit::percent, 0, 0, true}, by_chance));
  const Number by = as_percent(std::fabs(p.change_percent));
  return p.change_percent > 0
             ? paragraph("rose",
                         tr("Over {} attempts the mark rose by {}: more than chance explains ({}).",
                            p.attempts, by, by_chance))
             : paragraph("fell",
                         tr("Over {} attempts the mark fell by {}: more than chance explains ({}).",
                            p.attempts, by, by_chance));
}

}  // namespace

void add_filing_notes(Document& d, const ReportSource& s) {
  const auto note = [&](const std::string& id, const std::string& lead, const std::string& text) {
    d.blocks.push_back(Paragraph{one_line(text), lead, Paragraph::Kind::note, id});
  };
  if (!s.integrity.findings.empty() && (!s.filing || s.filing->findings.empty())) {
    const Message& first = s.integrity.findings.front();
    note(
        "does_not_hold", tr("Does not hold"),
        s.integrity.findings.size() > 1
            ? tr("This session does not hold, and its result is no sound one: {}; and more, under \"What is proved\"",
                 first)
            : tr("This session does not hold, and its result is no sound one: {}", first));
  }
  if (!s.filing) return;
  if (const auto& r = s.filing->regrade; r && !r->person.empty()) {
    const Term verdict = word_of(r->verdict);
    const Message decided =
        s.reader == ReportReader::student
            ? msg("{}: {} (entry {} of the ledger, {})", verdict, r->reason, r->entry, r->date)
            : msg("{}, by {}: {} (entry {} of the ledger, {})", verdict, r->person, r->reason,
                  r->entry, r->date);
    note("decided", tr("Decided by a person"),
         r->by_program == grading::verdict_name(grading::Verdict::review)
             ? tr("{}. The program had left it to a person", decided)
             : tr("{}. The program's own verdict was {}", decided, Term{r->by_program}));
  } else if (r)
    note("regraded", tr("Why it was regraded"),
         tr("{} (entry {} of the ledger, {}). The result below is the one that counts",
            as_is(r->reason), r->entry, as_is(r->date)));
  if (!s.filing->not_filed.empty())
    note("not_the_ledgers_result", tr("Not the ledger's result"), tr(s.filing->not_filed));
  if (!s.filing->findings.empty())
    note("in_doubt", tr("In doubt"),
         tr("The result of this session does not stand as sound. {}",
            List{s.filing->findings, true}));
}

std::string attempt_verdict(const ReportAttempt& a) {
  const Message verdict = a.verdict ? msg("{}", word_of(*a.verdict)) : msg("no verdict");
  List out{{a.doubt.empty() ? verdict : msg("in doubt ({})", verdict)}, false};
  if (a.regraded) out.items.push_back(msg("regraded"));
  if (a.simulated) out.items.push_back(msg("simulated operator"));
  return tr("{}", out);
}

std::string attempt_remark(const ReportAttempt& a) {
  List out;
  if (a.this_one) out.items.push_back(msg("this report"));
  if (!a.released) out.items.push_back(msg("not released"));
  if (!a.doubt.empty()) out.items.push_back(a.doubt);
  return tr("{}", out);
}

void add_attempts(Document& d, const ReportSource& s) {
  d.blocks.push_back(Heading{tr("Attempts over time")});
  if (!s.filing) {
    d.blocks.push_back(Paragraph{
        tr("This report was made from one session alone; earlier attempts are known to the school's ledger."),
        ""});
    return;
  }
  const bool all = s.reader == ReportReader::instructor;
  ReportTable t{{{tr("Attempt"), true, 1},
                 {tr("Filed (UTC)"), false, 3},
                 {tr("Verdict"), false, 1.5},
                 {tr("Points"), true, 2},
                 {tr("Entry"), true, 1},
                 {"", false, 2.5}},
                {},
                tr("Attempts"),
                0,
                "attempts"};
  std::vector<ReportAttempt> shown;
  for (const auto& a : s.filing->attempts) {
    if (!all && !a.released) continue;
    shown.push_back(a);
    t.rows.push_back({{{std::to_string(shown.size())},
                       {a.date},
                       {attempt_verdict(a)},
                       {points_of(a.points, a.max)},
                       {std::to_string(a.entry)},
                       {attempt_remark(a)}},
                      !a.doubt.empty(),
                      std::string(a.doubt.empty() ? "sound" : "in_doubt") +
                          (a.regraded ? " regraded" : "") + (a.simulated ? " simulated" : "") +
                          (a.released ? "" : " unreleased")});
  }
  d.blocks.push_back(Pictures{{attempts_chart(shown, s.result.pass_percent)}});
  d.blocks.push_back(progress_words(*s.filing));
  d.blocks.push_back(std::move(t));
}

void add_regrade(Document& d, const grading::Comparison& c) {
  d.blocks.push_back(Heading{tr("Beside the sealed result")});
  ReportTable t{{{"", false, 2},
                 {tr("Sealed"), true, 1.5},
                 {tr("Regrade"), true, 1.5},
                 {tr("Change"), true, 1},
                 {tr("What changed"), false, 5}},
                {},
                tr("Sealed result and regrade"),
                0,
                "regrade"};
  t.rows.push_back({{{tr("verdict")},
                     {tr("{}", Term{c.before.verdict})},
                     {tr("{}", Term{c.verdict})},
                     {""},
                     {tr(grading::all_of(c.rules))}}});
  t.rows.push_back({{{tr("points")},
                     {points_of(c.before.points, c.before.max)},
                     {points_of(c.points, c.max)},
                     {figure(grading::signed_points(c.points - c.before.points))},
                     {""}}});
  if (std::fabs(c.before.max - c.max) > 1e-9) {  // two scales: what is left of each
    const double before = c.before.max > 0 ? 100 * c.before.points / c.before.max : 0,
                 now = c.max > 0 ? 100 * c.points / c.max : 0;
    t.rows.push_back({{{tr("of its own scale")},
                       {figure(as_percent(before, 1))},
                       {figure(as_percent(now, 1))},
                       {figure({now - before, Unit::percent, 1, 0, true})},
                       {""}}});
  }
  for (const auto& k : c.criteria) {
    t.rows.push_back({{{k.id},
                       {points_of(k.old_points, k.old_max)},
                       {points_of(k.new_points, k.new_max)},
                       {figure(grading::signed_points(k.difference()))},
                       {tr(grading::all_of(k.why))}}});
  }
  d.blocks.push_back(std::move(t));
}

}  // namespace cavum::report
