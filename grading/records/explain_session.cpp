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
template <FindingKind kind = FindingKind::recording_unsound, class Say>
void or_damage(SessionExplanation& e, const Say& say) {
  try {
    say();
  } catch (const Error& damage) {
    e.findings.push_back(finding<kind>(damage.message()));
  }
}

/// What the chain of the recording and the replay of its motion prove.
void say_replay(SessionExplanation& e, const SessionReader& session,
                const grading::SchoolMark& mark) {
  const VerifyReport& report = mark.replay;
  if (report.intact) {
    const std::size_t seconds = session.chunks().size();
    e.proved.push_back(report.closed ? finding<FindingKind::unchanged>(report.station_key, seconds)
                                     : finding<FindingKind::unchanged_open>(seconds));
    e.proved.push_back(finding<FindingKind::motion_gives_forces>(report.ticks_replayed));
  }
  if (report.intact && session.closed() && mark.findings().empty() && mark.result.is_object())
    e.proved.push_back(mark.sealed_otherwise.is_null()
                           ? finding<FindingKind::motion_gives_result>()
                           : finding<FindingKind::motion_gives_events>());
}

/// When and by whom the recording was closed.
void say_closing(SessionExplanation& e, const SessionReader& session, const VerifyReport& report) {
  if (!report.closed || !report.intact) return;
  const std::string utc = utc_text(session.seal()->clocks.utc_ns);
  e.proved.push_back(session.fact(k_station_fact) == report.station_key
                         ? finding<FindingKind::closed_by_beginner>(utc, report.station_key)
                         : finding<FindingKind::closed_by>(utc, report.station_key));
}

/// What the school promised, and whether this is it.
void say_ticket(SessionExplanation& e, const SessionReader& session, const SessionSetup& setup,
                const std::string& ticket_text, const std::string& school_key) {
  const Ticket ticket = parse_ticket(ticket_text, school_key, msg("the session's ticket"));
  Findings wrong = check_ticket(ticket, setup, session.created().utc_ns);
  for (const Message& why : scenarios::check_servo(
           setup.servo_toml, scenarios::exam_task(setup, "scenario.toml").scenario))
    wrong.push_back(finding<FindingKind::exam_differs>(why));
  append(e.findings, wrong);
  if (wrong.empty())
    e.proved.push_back(finding<FindingKind::promised>(ticket.public_key, ticket.candidate));
  if (school_key.empty())
    e.remarks.push_back(finding<FindingKind::school_not_compared>(ticket.public_key.substr(0, 16)));
}

/// Of a session in which no ticket was found.
void say_no_ticket(SessionExplanation& e, bool readable, bool needed) {
  if (!readable)
    e.remarks.push_back(finding<FindingKind::ticket_not_read>());
  else if (needed)
    e.findings.push_back(finding<FindingKind::ticket_missing>());
  else
    e.remarks.push_back(finding<FindingKind::no_ticket>());
}

/// What was tried to leave a locked exam.
void say_attempts(SessionExplanation& e, const SessionReader& session) {
  for (const LockSummary& s : lock_summary(session.events()))
    e.remarks.push_back(finding<FindingKind::tried_to_leave>(
        as_s(static_cast<double>(s.first_tick) * 1e-3, 1), lock_words(s.first), s.times));
}

/// Where it was recorded, how the clocks ran, and what lies beside the file.
void say_circumstances(SessionExplanation& e, const SessionReader& session,
                       const std::string& path) {
  for (const auto& event : session.events())
    if (event.as<RecordingMoved>() != nullptr)
      e.remarks.push_back(
          finding<FindingKind::moved>(as_s(static_cast<double>(event.tick) * 1e-3, 1)));
  say_attempts(e, session);
  for (const auto& r : check_clocks(session)) e.remarks.push_back(static_cast<const Damage&>(r));
  if (std::error_code none; std::filesystem::exists(path + "-wal", none) &&
                            std::filesystem::file_size(path + "-wal", none) > 0)
    e.remarks.push_back(finding<FindingKind::log_beside>(path));
}

/// What no file can show.
void say_limits(SessionExplanation& e, bool closed, const std::string& station_key) {
  if (closed)
    e.remarks.push_back(finding<FindingKind::station_not_known>(station_key.substr(0, 16)));
  e.remarks.push_back(finding<FindingKind::hand_not_shown>());
  e.remarks.push_back(finding<FindingKind::earlier_end_not_shown>());
  e.remarks.push_back(finding<FindingKind::other_exam_not_shown>());
}

}  // namespace

SessionExplanation explain_session(const std::string& path, const std::string& school_key,
                                   bool ticket_needed) {
  grading::ExamContexts grounds;
  return explain_session(path, school_key, ticket_needed, grounds);
}

SessionExplanation explain_session(const std::string& path, const std::string& school_key,
                                   bool ticket_needed, grading::ExamContexts& grounds) {
  SessionExplanation e;
  e.file = path;
  const SessionReader session(path);
  const grading::SchoolMark mark = session.closed()
                                       ? grading::mark_again(session, grounds)
                                       : grading::SchoolMark{verify_session(path), {}, {}, {}};
  append(e.findings, mark.findings());
  say_replay(e, session, mark);
  or_damage(e, [&] { append(e.findings, check_stations(session)); });
  say_closing(e, session, mark.replay);
  or_damage(e, [&] {
    const SessionCheckFindings check = check_of_session(session);
    for (const Message& what : check.findings)
      e.findings.push_back(finding<FindingKind::self_check>(what));
    for (const Message& what : check.remarks)
      e.remarks.push_back(finding<FindingKind::self_check>(what));
  });

  std::string ticket_text;
  SessionSetup setup;
  or_damage(e, [&] {
    setup = session.setup();
    for (const auto& [key, value] : setup.notes)
      if (key == k_ticket_note) ticket_text = value;
  });
  if (!ticket_text.empty())
    or_damage<FindingKind::ticket_invalid>(
        e, [&] { say_ticket(e, session, setup, ticket_text, school_key); });
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
  out.add(
      e.holds ? msg("{}: holds", e.file)
      : e.interrupted
          ? msg("{}: INTERRUPTED: what is recorded holds, and can be taken up or closed with `cavum exam --resume`",
                e.file)
          : msg("{}: DOES NOT HOLD", e.file));
  const auto list = [&](const Message& title, const Findings& facts) {
    if (facts.empty()) return;
    out.add(title);
    for (const Finding& f : facts) out.add(msg("- {}", f.message()), 2);
  };
  list(e.interrupted ? msg("what is missing") : msg("what does not hold"), e.findings);
  list(msg("what is proved"), e.proved);
  list(msg("to be known"), e.remarks);
  return out;
}

}  // namespace cavum::records
