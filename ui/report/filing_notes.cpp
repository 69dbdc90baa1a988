#include "engine/base/text.h"
#include "ui/language/say.h"
#include "ui/report/report_document.h"

namespace cavum::report {

void add_filing_notes(Document& d, const ReportSource& s) {
  const auto note = [&](const std::string& id, const std::string& lead, const std::string& text) {
    d.blocks.push_back(Paragraph{one_line(text), lead, Paragraph::Kind::note, id});
  };
  if (!s.integrity.findings.empty() && (!s.filing || s.filing->findings.empty())) {
    const Message& first = s.integrity.findings.front();
    note("does_not_hold", tr("Does not hold"),
         s.integrity.findings.size() > 1
             ? tr("This session does not hold, and its result is no sound one: {}; and more, under \"What is proved\"", first)
             : tr("This session does not hold, and its result is no sound one: {}", first));
  }
  if (!s.filing) return;
  if (const auto& r = s.filing->regrade; r && !r->person.empty()) {
    const Term verdict{r->verdict};
    const Message decided = s.reader == ReportReader::student
                                ? msg("{}: {} (entry {} of the ledger, {})", verdict, r->reason, r->entry, r->date)
                                : msg("{}, by {}: {} (entry {} of the ledger, {})", verdict, r->person, r->reason, r->entry, r->date);
    note("decided", tr("Decided by a person"),
         r->by_program == grading::verdict_name(grading::Verdict::review) ? tr("{}. The program had left it to a person", decided)
                                                                          : tr("{}. The program's own verdict was {}", decided, Term{r->by_program}));
  } else if (r)
    note("regraded", tr("Why it was regraded"),
         tr("{} (entry {} of the ledger, {}). The result below is the one that counts", as_is(r->reason), r->entry, as_is(r->date)));
  if (!s.filing->not_filed.empty()) note("not_the_ledgers_result", tr("Not the ledger's result"), tr(s.filing->not_filed));
  if (!s.filing->findings.empty())
    note("in_doubt", tr("In doubt"), tr("The result of this session does not stand as sound. {}", List{s.filing->findings, true}));
}

std::string attempt_verdict(const ReportAttempt& a) {
  const Message verdict = a.verdict.empty() ? msg("no verdict") : msg("{}", Term{a.verdict});
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

}  // namespace cavum::report
