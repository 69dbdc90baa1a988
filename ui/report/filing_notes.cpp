#include <fmt/core.h>

#include "engine/base/text.h"
#include "engine/language/say.h"
#include "ui/report/report_document.h"

namespace cavum::report {

void add_filing_notes(Document& d, const ReportSource& s) {
  const auto note = [&](const std::string& lead, const std::string& text) {
    d.blocks.push_back(Paragraph{one_line(text), lead, Paragraph::Kind::note});
  };
  if (!s.integrity.findings.empty() && (!s.filing || s.filing->findings.empty()))
    note(tr("Does not hold"), tr("This session does not hold, and its result is no sound one: {}{}", s.integrity.findings.front(),
                                 s.integrity.findings.size() > 1 ? tr("; and more, under \"What is proved\"") : ""));
  if (!s.filing) return;
  if (const auto& r = s.filing->regrade; r && !r->person.empty()) {
    const std::string decided =
        s.reader == ReportReader::student
            ? tr("{}: {} (entry {} of the ledger, {}).", shown(r->verdict), as_is(r->reason), r->entry, r->date)
            : tr("{}, by {}: {} (entry {} of the ledger, {}).", shown(r->verdict), as_is(r->person), as_is(r->reason), r->entry, r->date);
    note(tr("Decided by a person"),
         decided + " " +
             (r->by_program == grading::verdict_name(grading::Verdict::review) ? tr("The program had left it to a person")
                                                                               : tr("The program's own verdict was {}", shown(r->by_program))));
  } else if (r)
    note(tr("Why it was regraded"), tr("{} (entry {} of the ledger, {}). The result below is the one that counts", r->reason, r->entry, r->date));
  if (!s.filing->not_filed.empty()) note(tr("Not the ledger's result"), s.filing->not_filed);
  if (s.filing->findings.empty()) return;
  std::string all;
  for (const auto& f : s.filing->findings) all += (all.empty() ? "" : "; ") + shown(f);
  note(tr("In doubt"), tr("The result of this session does not stand as sound. {}", all));
}

std::string attempt_verdict(const ReportAttempt& a) {
  std::string out = a.doubt.empty() ? shown(a.verdict) : tr("in doubt ({})", a.verdict.empty() ? tr("no verdict") : a.verdict);
  if (a.regraded) out += tr(", regraded");
  if (a.simulated) out += tr(", simulated operator");
  return out;
}

std::string attempt_remark(const ReportAttempt& a) {
  std::string out;
  const auto say = [&](const std::string& what) { out += (out.empty() ? "" : ", ") + what; };
  if (a.this_one) say(tr("this report"));
  if (!a.released) say(tr("not released"));
  if (!a.doubt.empty()) say(shown(one_line(a.doubt)));
  return out;
}

}  // namespace cavum::report
