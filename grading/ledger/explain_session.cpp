#include "grading/ledger/explain_session.h"

#include <filesystem>

#include "engine/base/file.h"
#include "engine/base/text.h"
#include "engine/session/chain.h"
#include "engine/session/clock_check.h"
#include "engine/session/session_reader.h"
#include "engine/session/station_check.h"
#include "engine/session/verify.h"
#include "grading/ledger/ticket.h"
#include "grading/school_mark.h"
#include "grading/session_input.h"
#include "scenarios/exam/exam.h"

namespace cavum {

SessionExplanation explain_session(const std::string& path, const std::string& school_key, bool ticket_needed) {
  SessionExplanation e;
  e.file = path;
  const SessionReader session(path);
  ExamGrounds grounds;
  const SchoolMark mark = session.closed() ? mark_again(session, grounds) : SchoolMark{verify_session(path), {}, {}, {}, {}};
  const VerifyReport& report = mark.replay;
  e.findings = session.closed() ? mark.findings : report.findings;
  if (report.intact) {
    e.proved.push_back("nothing in the file was changed since " +
                       (report.closed ? "station " + report.station_key + " signed it" : "it was recorded") + ": " +
                       std::to_string(session.chunks().size()) + " seconds linked by SHA-256, each with its motion, forces, events and clocks");
    e.proved.push_back("the motion gives the recorded forces, removed leaves and tooth again, bit for bit: " + std::to_string(report.ticks_replayed) +
                       " ticks simulated");
  }
  if (report.intact && session.closed() && mark.findings.empty() && mark.result.is_object())
    e.proved.emplace_back(mark.sealed_otherwise.is_null() ? "the motion gives the recorded events and the sealed result again"
                                                          : "the motion gives the recorded events again");
  for (const auto& r : mark.remarks) e.remarks.push_back(r);
  try {
    for (auto& f : check_stations(session)) e.findings.push_back(std::move(f));
  } catch (const Error& damage) {
    e.findings.emplace_back(damage.what());
  }
  if (report.closed && report.intact)
    e.proved.push_back("closed on " + utc_text(session.seal()->clocks.utc_ns) + " by station " + report.station_key +
                       (session.fact(k_station_fact) == report.station_key ? ", which signed its beginning, too" : ""));

  std::string ticket_text;
  SessionSetup setup;
  try {
    setup = session.setup();
    for (const auto& [key, value] : setup.notes)
      if (key == k_ticket_note) ticket_text = value;
  } catch (const Error& damage) {
    e.findings.emplace_back(damage.what());
  }
  if (!ticket_text.empty()) {
    try {
      const Ticket ticket = parse_ticket(ticket_text, school_key, "the session's ticket");
      auto wrong = check_ticket(ticket, setup, session.created().utc_ns);
      for (auto& f : check_servo(setup.servo_toml, scenario_in(setup, "the session"))) wrong.push_back(std::move(f));
      e.findings.insert(e.findings.end(), wrong.begin(), wrong.end());
      if (wrong.empty())
        e.proved.push_back("the school with key " + ticket.public_key + " promised this exam to candidate " + ticket.candidate +
                           ": scenario, tooth, rubric and accommodations are those of the ticket, and it began within its time");
      if (school_key.empty())
        e.remarks.push_back("whether the key " + ticket.public_key.substr(0, 16) +
                            "… is your school's was not compared: name it with --school-key, or put its school.pub into the station's folder");
    } catch (const Error& damage) {
      e.findings.emplace_back(damage.what());
    }
  } else if (!session.findings().empty()) {
    e.remarks.emplace_back("whether the session holds a ticket could not be read for certain");
  } else if (!school_key.empty() && ticket_needed) {
    e.findings.emplace_back("the session holds no ticket: nobody promised this exam");
  } else {
    e.remarks.emplace_back("there is no ticket: that this exam was asked for, and of whom, is not shown");
  }
  for (const auto& event : session.events())
    if (event.kind == "moved")
      e.remarks.push_back("from " + fixed(static_cast<double>(event.tick) * 1e-3, 1) +
                          " s on it was recorded at another place, for the first one refused: what lies there is the beginning of this exam");
  for (const auto& r : check_clocks(session))
    e.remarks.push_back("from tick " + std::to_string(r.first_tick) + " (" + fixed(static_cast<double>(r.first_tick) * 1e-3, 1) + " s): " + r.what);
  if (std::error_code none; std::filesystem::exists(path + "-wal", none) && std::filesystem::file_size(path + "-wal", none) > 0)
    e.remarks.push_back("a log lies beside the file (" + path +
                        "-wal) and was read with it: when something does not hold, look at the file without it");
  if (session.closed())
    e.remarks.push_back("whether station " + report.station_key.substr(0, 16) +
                        "… is one of the school's is known to its ledger only: anybody can sign a recording with a key of their own");
  e.remarks.emplace_back("not shown by any file: whose hand held the stylus, and whether the station's own key or program was in the wrong hands");
  e.remarks.emplace_back(
      "not shown by any file: that it was not ended before, where the station's memory was put back as it was, or its key was used by another "
      "program");
  e.remarks.emplace_back("that no other exam was sat with the same ticket is known to the ledger only");
  e.holds = report.verified && e.findings.empty();
  return e;
}

std::string to_text(const SessionExplanation& e) {
  std::string out = one_line(e.file) + ": " + (e.holds ? "holds" : "DOES NOT HOLD") + "\n";
  const auto list = [&](const char* title, const std::vector<std::string>& lines) {
    if (lines.empty()) return;
    out += std::string(title) + "\n";
    for (const auto& l : lines) out += "  - " + one_line(l) + "\n";
  };
  list("what does not hold", e.findings);
  list("what is proved", e.proved);
  list("to be known", e.remarks);
  return out;
}

}  // namespace cavum
