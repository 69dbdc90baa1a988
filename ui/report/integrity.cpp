#include "ui/report/integrity.h"

#include <fmt/core.h>

#include <filesystem>

#include "engine/base/file.h"
#include "engine/base/text.h"
#include "engine/base/version.h"
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
  i.remarks.emplace_back("the motion was not simulated again for this report; `cavum verify` does that");
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
  d.blocks.push_back(Heading{"What is proved"});
  std::string promise;
  if (!i.findings.empty() || i.replay == Replay::differs)
    promise = "This session does not hold: see below.";
  else if (i.replay == Replay::agrees)
    promise = fmt::format("This session is tamper-evident and replay-verified{}", i.at_filing ? " (when it was filed)." : ".");
  else
    promise = "This session is tamper-evident. It was not replayed for this report.";
  d.blocks.push_back(Paragraph{promise, ""});
  ReportTable t{{{"What", false, 3}, {"Details", false, 7}}, {}, "What is proved"};
  const auto row = [&](const char* what, const std::string& text) {
    if (!text.empty()) t.rows.push_back({{{what}, {text}}});
  };
  // a file is named by people, and the name may be the candidate's: a student's report does without
  const bool named = s.reader == ReportReader::instructor && !i.file.empty();
  row("session file", (named ? i.file + ", SHA-256 " : "SHA-256 ") + i.file_sha256);
  row("chain of its seconds", i.chain_sha256);
  row("tooth as it was left", i.final_tooth_sha256);
  row("sealed result", i.result_sha256);
  row("closed", i.closed_utc.empty() ? "" : fmt::format("{}, signed by station {}", i.closed_utc, i.station_key));
  row("replay", i.replay == Replay::agrees    ? fmt::format("simulated again from the motion: the same forces and the same tooth, bit for bit{}",
                                                         i.at_filing ? ", when the ledger took it in" : "")
                : i.replay == Replay::differs ? "does not give what was recorded, or the file does not hold"
                                              : "not done for this report");
  if (const auto& f = s.filing) {
    row("ledger", fmt::format("{} of {}, key {}", f->ledger, f->school, f->public_key));
    row("receipt", fmt::format("entry {}, filed {}{}", f->entry, f->date, f->released ? ", released" : ", not released"));
    row("root", fmt::format("{} of the first {} entries", f->root, f->entries));
    for (const auto& finding : f->findings) row("in doubt", finding);
  }
  d.blocks.push_back(std::move(t));
  const auto list = [&](const char* title, const std::vector<std::string>& items) {
    if (items.empty()) return;
    d.blocks.push_back(Heading{title, 3});
    d.blocks.push_back(Bullets{items, true});
  };
  list("What does not hold", i.findings);
  if (s.reader == ReportReader::instructor) {
    list("How that is known", i.proved);
    list("What else is to be known", i.remarks);
  }
  d.footer.push_back(fmt::format("Session {}SHA-256 {}…: {}{}", named ? i.file + ", " : std::string(), i.file_sha256.substr(0, 16),
                                 !i.findings.empty() || i.replay == Replay::differs ? "does not hold"
                                 : i.replay == Replay::agrees                       ? "tamper-evident and replay-verified"
                                                                                    : "tamper-evident, not replayed for this report",
                                 s.filing ? fmt::format("; ledger entry {}", s.filing->entry) : ""));
  d.footer.push_back(fmt::format("Tooth {}, leaf {} mm. Definitions: docs/grading.md of Cavum {}.", s.facts.tooth_hash.substr(0, 16),
                                 fixed(s.result.leaf_mm, 3), version()));
}

}  // namespace cavum::report
