#include "grading/records/explain_session.h"

#include <filesystem>

#include "engine/base/file.h"
#include "engine/device/selfcheck/check_note.h"
#include "engine/session/chain.h"
#include "engine/session/clock_check.h"
#include "engine/session/lock_event.h"
#include "engine/session/session_reader.h"
#include "engine/session/station_check.h"
#include "engine/session/verify.h"
#include "grading/marking/school_mark.h"
#include "grading/records/ticket.h"
#include "scenarios/exam/exam.h"

namespace cavum::records {

namespace {

/// `say` may find the session too damaged to be asked: that is a finding, too.
template <class Say>
void or_damage(SessionExplanation& e, const Say& say, FindingKind kind = FindingKind::recording_unsound) {
  try {
    say();
  } catch (const Error& damage) {
    e.findings.push_back({kind, damage.message()});
  }
}

/// What the chain of the recording and the replay of its motion prove.
void say_replay(SessionExplanation& e, const SessionReader& session, const grading::SchoolMark& mark) {
  const VerifyReport& report = mark.replay;
  if (report.intact) {
    e.proved.push_back({FindingKind::unchanged,
                        report.closed ? msg("nothing in the file was changed since station {} signed it: {} seconds linked by SHA-256, each with its "
                                            "motion, forces, events and clocks",
                                            report.station_key, session.chunks().size())
                                      : msg("nothing in the file was changed since it was recorded: {} seconds linked by SHA-256, each with its "
                                            "motion, forces, events and clocks",
                                            session.chunks().size())});
    e.proved.push_back(
        {FindingKind::motion_gives_forces,
         msg("the motion gives the recorded forces, removed leaves and tooth again, bit for bit: {} ticks simulated", report.ticks_replayed)});
  }
  if (report.intact && session.closed() && mark.findings().empty() && mark.result.is_object())
    e.proved.push_back({FindingKind::motion_gives_events, mark.sealed_otherwise.is_null()
                                                              ? msg("the motion gives the recorded events and the sealed result again")
                                                              : msg("the motion gives the recorded events again")});
}

/// When and by whom the recording was closed.
void say_closing(SessionExplanation& e, const SessionReader& session, const VerifyReport& report) {
  if (report.closed && report.intact)
    e.proved.push_back(
        {FindingKind::closed_by,
         session.fact(k_station_fact) == report.station_key
             ? msg("closed on {} by station {}, which signed its beginning, too", utc_text(session.seal()->clocks.utc_ns), report.station_key)
             : msg("closed on {} by station {}", utc_text(session.seal()->clocks.utc_ns), report.station_key)});
}

/// What the school promised, and whether this is it.
void say_ticket(SessionExplanation& e, const SessionReader& session, const SessionSetup& setup, const std::string& ticket_text,
                const std::string& school_key) {
  const Ticket ticket = parse_ticket(ticket_text, school_key, msg("the session's ticket"));
  Findings wrong = check_ticket(ticket, setup, session.created().utc_ns);
  append(wrong,
         findings_of(FindingKind::exam_differs, scenarios::check_servo(setup.servo_toml, scenarios::exam_task(setup, "scenario.toml").scenario)));
  append(e.findings, wrong);
  if (wrong.empty())
    e.proved.push_back({FindingKind::promised, msg("the school with key {} promised this exam to candidate {}: scenario, tooth, rubric and "
                                                   "accommodations are those of the ticket, and it "
                                                   "began within its time",
                                                   ticket.public_key, ticket.candidate)});
  if (school_key.empty())
    e.remarks.push_back(
        {FindingKind::school_not_compared,
         msg("whether the key {}… is your school's was not compared: name it with --school-key, or put its school.pub into the station's folder",
             ticket.public_key.substr(0, 16))});
}

/// Of a session in which no ticket was found.
void say_no_ticket(SessionExplanation& e, bool readable, bool needed) {
  if (!readable)
    e.remarks.push_back({FindingKind::ticket_not_read, msg("whether the session holds a ticket could not be read for certain")});
  else if (needed)
    e.findings.push_back({FindingKind::ticket_missing, msg("the session holds no ticket: nobody promised this exam")});
  else
    e.remarks.push_back({FindingKind::no_ticket, msg("there is no ticket: that this exam was asked for, and of whom, is not shown")});
}

/// What was tried to leave a locked exam.
void say_attempts(SessionExplanation& e, const SessionReader& session) {
  for (const LockSummary& s : lock_summary(session.events()))
    e.remarks.push_back({FindingKind::tried_to_leave,
                         msgn("during the exam, {} after its beginning: {}", "during the exam, {} after its beginning: {} ({} times in all)", s.times,
                              as_s(static_cast<double>(s.first_tick) * 1e-3, 1), lock_words(s.first), s.times)});
}

/// Where it was recorded, how the clocks ran, and what lies beside the file.
void say_circumstances(SessionExplanation& e, const SessionReader& session, const std::string& path) {
  for (const auto& event : session.events())
    if (event.as<RecordingMoved>() != nullptr)
      e.remarks.push_back(
          {FindingKind::moved,
           msg("from {} on it was recorded at another place, for the first one refused: what lies there is the beginning of this exam",
               as_s(static_cast<double>(event.tick) * 1e-3, 1))});
  say_attempts(e, session);
  for (const auto& r : check_clocks(session))
    e.remarks.push_back({FindingKind::clock, msg("from tick {} ({}): {}", r.first_tick, as_s(static_cast<double>(r.first_tick) * 1e-3, 1), r.what)});
  if (std::error_code none; std::filesystem::exists(path + "-wal", none) && std::filesystem::file_size(path + "-wal", none) > 0)
    e.remarks.push_back(
        {FindingKind::log_beside,
         msg("a log lies beside the file ({}-wal) and was read with it: when something does not hold, look at the file without it", path)});
}

/// What no file can show.
void say_limits(SessionExplanation& e, bool closed, const std::string& station_key) {
  if (closed)
    e.remarks.push_back(
        {FindingKind::station_not_known,
         msg("whether station {}… is one of the school's is known to its ledger only: anybody can sign a recording with a key of their own",
             station_key.substr(0, 16))});
  e.remarks.push_back(
      {FindingKind::hand_not_shown,
       msg("not shown by any file: whose hand held the stylus, and whether the station's own key or program was in the wrong hands")});
  e.remarks.push_back(
      {FindingKind::earlier_end_not_shown,
       msg("not shown by any file: that it was not ended before, where the station's memory was put back as it was, or its key was used by another "
           "program")});
  e.remarks.push_back({FindingKind::other_exam_not_shown, msg("that no other exam was sat with the same ticket is known to the ledger only")});
}

}  // namespace

SessionExplanation explain_session(const std::string& path, const std::string& school_key, bool ticket_needed) {
  grading::ExamContexts grounds;
  return explain_session(path, school_key, ticket_needed, grounds);
}

SessionExplanation explain_session(const std::string& path, const std::string& school_key, bool ticket_needed, grading::ExamContexts& grounds) {
  SessionExplanation e;
  e.file = path;
  const SessionReader session(path);
  const grading::SchoolMark mark =
      session.closed() ? grading::mark_again(session, grounds) : grading::SchoolMark{verify_session(path), {}, {}, {}, {}};
  e.findings = findings_of(mark);
  say_replay(e, session, mark);
  or_damage(e, [&] { append(e.findings, findings_of(FindingKind::station_changed, check_stations(session))); });
  say_closing(e, session, mark.replay);
  or_damage(e, [&] {
    const SessionCheckFindings check = check_of_session(session);
    append(e.findings, findings_of(FindingKind::self_check, check.findings));
    append(e.remarks, findings_of(FindingKind::self_check, check.remarks));
  });

  std::string ticket_text;
  SessionSetup setup;
  or_damage(e, [&] {
    setup = session.setup();
    for (const auto& [key, value] : setup.notes)
      if (key == k_ticket_note) ticket_text = value;
  });
  if (!ticket_text.empty())
    or_damage(
        e, [&] { say_ticket(e, session, setup, ticket_text, school_key); }, FindingKind::ticket_invalid);
  else
    say_no_ticket(e, session.findings().empty(), !school_key.empty() && ticket_needed);
  say_circumstances(e, session, path);
  say_limits(e, session.closed(), mark.replay.station_key);
  e.holds = mark.replay.verified && e.findings.empty();
  e.interrupted = !session.closed() && mark.replay.intact && e.findings.size() == 1;
  return e;
}

Lines to_text(const SessionExplanation& e) {
  Lines out;
  out.add(e.holds         ? msg("{}: holds", e.file)
          : e.interrupted ? msg("{}: INTERRUPTED: what is recorded holds, and can be taken up or closed with `cavum exam --resume`", e.file)
                          : msg("{}: DOES NOT HOLD", e.file));
  const auto list = [&](const Message& title, const Findings& facts) {
    if (facts.empty()) return;
    out.add(title);
    for (const Finding& f : facts) out.add(msg("- {}", f.what), 2);
  };
  list(e.interrupted ? msg("what is missing") : msg("what does not hold"), e.findings);
  list(msg("what is proved"), e.proved);
  list(msg("to be known"), e.remarks);
  return out;
}

}  // namespace cavum::records
