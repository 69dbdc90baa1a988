#include "ui/report/integrity.h"

#include <filesystem>

#include "engine/base/file.h"
#include "engine/base/text.h"
#include "engine/base/version.h"
#include "engine/device/selfcheck/check_note.h"
#include "engine/session/chain_check.h"
#include "engine/session/session_reader.h"
#include "grading/records/explain_session.h"
#include "ui/language/say.h"
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
  i.findings = words_of(check_chain(session));
  if (i.findings.empty())
    i.proved.push_back(msg(
        "nothing in the file was changed since it was recorded: {} seconds linked by SHA-256, each with its motion, forces, events and clocks, and "
        "closed by the station's signature",
        session.chunks().size()));
  const SessionCheckFindings check = check_of_session(session);
  for (const auto& f : check.findings) i.findings.push_back(msg("{}", f));
  for (const auto& r : check.remarks) i.remarks.push_back(msg("{}", r));
  i.remarks.push_back(
      msg("the motion was not simulated again for this report; `cavum verify` does that"));
  return i;
}

ReportIntegrity replayed_integrity(const std::string& path, grading::ExamContexts& grounds) {
  ReportIntegrity i = read_seal(path, SessionReader(path));
  const records::SessionExplanation e = records::explain_session(path, "", true, grounds);
  i.replay = e.holds ? ReportIntegrity::Replay::agrees : ReportIntegrity::Replay::differs;
  for (const auto& p : e.proved) i.proved.push_back(p.message());
  for (const auto& f : e.findings) i.findings.push_back(f.message());
  for (const auto& r : e.remarks) i.remarks.push_back(r.message());
  return i;
}

void add_integrity(Document& d, const ReportSource& s) {
  using Replay = ReportIntegrity::Replay;
  const ReportIntegrity& i = s.integrity;
  d.blocks.push_back(Heading{tr("What is proved")});
  std::string promise, id = "does_not_hold";
  if (!i.findings.empty() || i.replay == Replay::differs)
    promise = tr("This session does not hold: see below.");
  else if (i.replay == Replay::agrees)
    id = i.at_filing ? "replayed_at_filing" : "replayed",
    promise = i.at_filing
                  ? tr("This session is tamper-evident and replay-verified (when it was filed).")
                  : tr("This session is tamper-evident and replay-verified.");
  else
    id = "not_replayed",
    promise = tr("This session is tamper-evident. It was not replayed for this report.");
  d.blocks.push_back(Paragraph{promise, "", Paragraph::Kind::normal, id});
  ReportTable t{{{tr("What"), false, 3}, {tr("Details"), false, 7}},
                {},
                tr("What is proved"),
                0,
                "integrity"};
  const auto row = [&](const std::string& what, const std::string& text) {
    if (!text.empty()) t.rows.push_back({{{what}, {text}}});
  };
  // a file is named by people, and the name may be the candidate's: a student's report does without
  const bool named = s.reader == ReportReader::instructor && !i.file.empty();
  row(tr("session file"), named ? tr("{}, SHA-256 {}", as_is(i.file), as_is(i.file_sha256))
                                : "SHA-256 " + i.file_sha256);
  row(tr("chain of its seconds"), i.chain_sha256);
  row(tr("tooth as it was left"), i.final_tooth_sha256);
  row(tr("sealed result"), i.result_sha256);
  row(tr("closed"), i.closed_utc.empty() ? ""
                                         : tr("{}, signed by station {}", as_is(i.closed_utc),
                                              as_is(i.station_key)));
  row(tr("replay"),
      i.replay == Replay::agrees
          ? i.at_filing
                ? tr("simulated again from the motion when the ledger took it in: the same forces and the same tooth, bit for bit")
                : tr("simulated again from the motion: the same forces and the same tooth, bit for bit")
      : i.replay == Replay::differs
          ? tr("does not give what was recorded, or the file does not hold")
          : tr("not done for this report"));
  if (const auto& f = s.filing) {
    row(tr("ledger"),
        tr("{} of {}, key {}", as_is(f->ledger), as_is(f->school), as_is(f->public_key)));
    row(tr("receipt"), f->released
                           ? tr("entry {}, filed {}, released", f->entry, as_is(f->date))
                           : tr("entry {}, filed {}, not released", f->entry, as_is(f->date)));
    row(tr("root"), tr("{} of the first {} entries", as_is(f->root), f->entries));
    for (const auto& finding : f->findings) row(tr("in doubt"), tr(finding));
  }
  d.blocks.push_back(std::move(t));
  const auto list = [&](const std::string& title, const std::vector<Message>& items) {
    if (items.empty()) return;
    d.blocks.push_back(Heading{title, 3});
    Bullets bullets{{}, true};
    for (const Message& m : items) bullets.items.push_back(tr(m));
    d.blocks.push_back(std::move(bullets));
  };
  list(tr("What does not hold"), i.findings);
  if (s.reader == ReportReader::instructor) {
    list(tr("How that is known"), i.proved);
    list(tr("What else is to be known"), i.remarks);
  }
  const Message hash = msg("SHA-256 {}…", i.file_sha256.substr(0, 16)),
                session = named ? msg("{}, {}", i.file, hash) : hash,
                state = !i.findings.empty() || i.replay == Replay::differs ? msg("does not hold")
                        : i.replay == Replay::agrees
                            ? msg("tamper-evident and replay-verified")
                            : msg("tamper-evident, not replayed for this report");
  d.footer.push_back(s.filing
                         ? tr("Session {}: {}; ledger entry {}", session, state, s.filing->entry)
                         : tr("Session {}: {}", session, state));
  d.footer.push_back(tr("Tooth {}, leaf {}. Definitions: docs/grading.md of Cavum {}.",
                        as_is(s.facts.tooth_hash.substr(0, 16)), as_mm(s.result.leaf_mm, 3),
                        as_is(version())));
}

}  // namespace cavum::report
