#include "ui/report/integrity.h"

#include <fmt/core.h>

#include <filesystem>

#include "engine/base/file.h"
#include "engine/base/text.h"
#include "engine/base/version.h"
#include "engine/language/say.h"
#include "engine/selfcheck/check_note.h"
#include "engine/session/chain_check.h"
#include "engine/session/session_reader.h"
#include "grading/ledger/explain_session.h"
#include "ui/report/report_document.h"

namespace cavum::report {

namespace {

ReportIntegrity read_seal(const std::string& path, const SessionReader& session) {
  ReportIntegrity i;
  i.file = one_line(std::filesystem::path(path).filename().string());
  i.file_sha256 = to_hex(sha256(read_file(path)));
  if (const auto& seal = session.seal()) {
    i.chain_sha256 = to_hex(seal->chain_sha256);
    i.final_tooth_sha256 = to_hex(seal->final_tooth_sha256);
    i.result_sha256 = to_hex(seal->result_sha256);
    i.station_key = to_hex(seal->public_key);
    i.closed_utc = utc_text(seal->clocks.utc_ns);
  }
  return i;
}

}  // namespace

ReportIntegrity read_integrity(const std::string& path) {
  const SessionReader session(path);
  ReportIntegrity i = read_seal(path, session);
  i.findings = check_chain(session);
  if (i.findings.empty())
    i.proved.push_back(
        fmt::format("nothing in the file was changed since it was recorded: {} seconds linked by SHA-256, each with its motion, forces, events and "
                    "clocks, and closed by the station's signature",
                    session.chunks().size()));
  SessionCheckFindings check = check_of_session(session);
  for (auto& finding : check.findings) i.findings.push_back(std::move(finding));
  i.remarks = std::move(check.remarks);
  i.remarks.emplace_back(said("the motion was not simulated again for this report; `cavum verify` does that"));
  return i;
}

ReportIntegrity replayed_integrity(const std::string& path, grading::ExamGrounds& grounds) {
  ReportIntegrity i = read_seal(path, SessionReader(path));
  ledger::SessionExplanation e = ledger::explain_session(path, "", true, grounds);
  i.replay = e.holds ? ReportIntegrity::Replay::agrees : ReportIntegrity::Replay::differs;
  i.proved = std::move(e.proved);
  i.findings = std::move(e.findings);
  i.remarks = std::move(e.remarks);
  return i;
}

void add_integrity(Document& d, const ReportSource& s) {
  using Replay = ReportIntegrity::Replay;
  const ReportIntegrity& i = s.integrity;
  d.blocks.push_back(Heading{tr("What is proved")});
  std::string promise;
  if (!i.findings.empty() || i.replay == Replay::differs)
    promise = tr("This session does not hold: see below.");
  else if (i.replay == Replay::agrees)
    promise = i.at_filing ? tr("This session is tamper-evident and replay-verified (when it was filed).")
                          : tr("This session is tamper-evident and replay-verified.");
  else
    promise = tr("This session is tamper-evident. It was not replayed for this report.");
  d.blocks.push_back(Paragraph{promise, ""});
  ReportTable t{{{tr("What"), false, 3}, {tr("Details"), false, 7}}, {}, tr("What is proved")};
  const auto row = [&](const std::string& what, const std::string& text) {
    if (!text.empty()) t.rows.push_back({{{what}, {text}}});
  };
  // a file is named by people, and the name may be the candidate's: a student's report does without
  const bool named = s.reader == ReportReader::instructor && !i.file.empty();
  row(tr("session file"), named ? tr("{}, SHA-256 {}", as_is(i.file), i.file_sha256) : "SHA-256 " + i.file_sha256);
  row(tr("chain of its seconds"), i.chain_sha256);
  row(tr("tooth as it was left"), i.final_tooth_sha256);
  row(tr("sealed result"), i.result_sha256);
  row(tr("closed"), i.closed_utc.empty() ? "" : tr("{}, signed by station {}", i.closed_utc, i.station_key));
  row(tr("replay"), i.replay == Replay::agrees    ? tr("simulated again from the motion: the same forces and the same tooth, bit for bit{}",
                                                    i.at_filing ? tr(", when the ledger took it in") : "")
                    : i.replay == Replay::differs ? tr("does not give what was recorded, or the file does not hold")
                                                  : tr("not done for this report"));
  if (const auto& f = s.filing) {
    row(tr("ledger"), tr("{} of {}, key {}", f->ledger, f->school, f->public_key));
    row(tr("receipt"),
        f->released ? tr("entry {}, filed {}, released", f->entry, f->date) : tr("entry {}, filed {}, not released", f->entry, f->date));
    row(tr("root"), tr("{} of the first {} entries", f->root, f->entries));
    for (const auto& finding : f->findings) row(tr("in doubt"), finding);
  }
  d.blocks.push_back(std::move(t));
  const auto list = [&](const std::string& title, const std::vector<std::string>& items) {
    if (items.empty()) return;
    d.blocks.push_back(Heading{title, 3});
    d.blocks.push_back(Bullets{items, true});
  };
  list(tr("What does not hold"), i.findings);
  if (s.reader == ReportReader::instructor) {
    list(tr("How that is known"), i.proved);
    list(tr("What else is to be known"), i.remarks);
  }
  d.footer.push_back(tr("Session {}SHA-256 {}…: {}{}", named ? i.file + ", " : std::string(), i.file_sha256.substr(0, 16),
                        !i.findings.empty() || i.replay == Replay::differs ? tr("does not hold")
                        : i.replay == Replay::agrees                       ? tr("tamper-evident and replay-verified")
                                                                           : tr("tamper-evident, not replayed for this report"),
                        s.filing ? tr("; ledger entry {}", s.filing->entry) : ""));
  d.footer.push_back(
      tr("Tooth {}, leaf {} mm. Definitions: docs/grading.md of Cavum {}.", s.facts.tooth_hash.substr(0, 16), fixed(s.result.leaf_mm, 3), version()));
}

}  // namespace cavum::report
