// What is asked of the office and what it answers: each body as a struct, from which the pages'
// types are made, too (routes.h). Times are UTC, as "2026-11-21T09:00:00Z" or in nanoseconds since
// 1970; `candidate` is a pseudonym, `id` and `name` are the school's own and are told to officers
// alone.
#pragma once

#include <array>
#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "engine/base/json_struct.h"
#include "engine/base/text.h"
#include "grading/records/finding.h"
#include "ui/office/lti/platforms.h"

namespace cavum::office {

template <class T>
using Maybe = std::optional<T>;
template <class T>
using List = std::vector<T>;
template <class T>
using ByName = std::map<std::string, T>;
using Texts = std::vector<std::string>;

/// What a person's account may be.
enum class Role : unsigned { officer, examiner, invigilator, reader };
[[nodiscard]] constexpr auto names_of(Role) {
  return std::array<std::string_view, 4>{noop("officer"), noop("examiner"), noop("invigilator"),
                                         noop("reader")};
}
enum class RegradeState { none, marking, ready, failed, counted, lost };
[[nodiscard]] constexpr auto names_of(RegradeState) {
  return std::array<std::string_view, 6>{"none", "marking", "ready", "failed", "counted", "lost"};
}
/// Of a makeup sitting: nothing, what the request says, or what the first ticket granted.
enum class Granting { none, these, as_before };
[[nodiscard]] constexpr auto names_of(Granting) {
  return std::array<std::string_view, 3>{"none", "these", "as before"};
}
enum class HandedState { unknown, waiting, filed, refused };
[[nodiscard]] constexpr auto names_of(HandedState) {
  return std::array<std::string_view, 4>{"unknown", "waiting", "filed", "refused"};
}

inline constexpr std::size_t k_longest_line = 2000, k_max_rows = 10'000;
using Line = Text<k_longest_line>;
using Lines = AtMost<std::vector<Line>, 1000>;
using AtOnce = Between<1, 10'000>;
using Minutes = Between<1, 10'080>;
/// Why: one line, kept for ever.
struct Reason : Line {
  using Line::Line;
  [[nodiscard]] Message problem() const {
    return is_seen_text(*this) ? Message() : msg("is no line of text");
  }
};
// clang-format off
/// Of the second factor.
using Code = Text<100>;
CAVUM_JSON(WithCode, (Code, code))
using Entries = AtMost<std::vector<std::uint64_t>, k_max_rows>;

// People.
CAVUM_JSON(SignIn, (Line, name, optional), (Line, password, optional))
/// `may`: "POST /api/release".
CAVUM_JSON(Me, (std::string, name), (Role, role), (std::string, token), (Texts, may), (std::string, school), (bool, rehearsal), (bool, second_factor))
/// `words`: by the English ones; `proxy`: the school's own accounts are good here, too.
CAVUM_JSON(Words, (std::string, language), (std::string, decimal_sign), (ByName<std::string>, words), (bool, proxy))
using Entered = Only<"entry", std::uint64_t>;

// Class lists and tickets.
/// `longest_s`: for who has most time; it may tell of health.
CAVUM_JSON(ExamFacts, (std::string, id), (std::string, title), (std::string, file), (std::int64_t, time_limit_s), (Maybe<std::int64_t>, longest_s))
using Exams = Only<"exams", std::vector<ExamFacts>>;
/// `answers`: for the columns, by their places.
CAVUM_JSON(ClassList, (Text<4U << 20>, base64), (Lines, answers, optional))
/// `use`: a name of records::people_columns(), k_pass_over, or empty: nobody has answered yet; `known`: by its heading; `samples`: its first values
/// that are not empty.
CAVUM_JSON(RosterColumn, (std::string, heading), (std::string, use), (bool, known), (Texts, samples))
CAVUM_JSON(ListedPerson, (std::string, id), (std::string, name), (std::string, station), (std::string, accommodations))
/// `longest_s`: of each exam, for who of the list has most time.
CAVUM_JSON(Preview, (bool, headed), (std::string, encoding), (std::string, separator), (std::size_t, rows), (List<RosterColumn>, columns),
           (List<ListedPerson>, people), (Texts, problems), (Texts, uses), (ByName<std::int64_t>, longest_s))
/// Sittings of `at_once` candidates follow each other `minutes_apart`. Of the list those from `first` on, `most` of them: a portion at a time, so
/// that stations are heard in between.
/// `another`: also to those who have a ticket that is good, or have sat the exam; `overlap`: one may begin while the last is still sat.
CAVUM_JSON_MORE(Issue, ClassList, (Line, exam), (Line, from), (Line, until), (Reason, reason), (bool, begin_at_office, optional),
           (bool, another, optional), (Maybe<AtOnce>, at_once, optional), (Maybe<Minutes>, minutes_apart, optional), (bool, overlap, optional),
           (std::size_t, first, optional), (Maybe<std::size_t>, most, optional))
CAVUM_JSON(IssuedTicket, (std::string, candidate), (std::string, id), (std::string, name), (std::string, station), (std::string, not_before),
           (std::string, not_after))
CAVUM_JSON(NotIssued, (std::string, id), (std::string, name), (std::string, why))
CAVUM_JSON(Issued, (List<IssuedTicket>, issued), (List<NotIssued>, refused), (std::size_t, done), (std::size_t, of))
/// `makeup`: what may have become of it that a makeup is given for; `accommodations`: as long as the ticket's file is kept.
CAVUM_JSON(TicketRow, (std::uint64_t, entry), (std::string, candidate), (std::string, id), (std::string, name), (std::string, exam),
           (std::string, not_before), (std::string, not_after), (std::string, state), (std::string, seat), (std::string, became), (std::string, why),
           (bool, live), (bool, at_station), (bool, grant_stored), (bool, begun), (Texts, makeup), (Maybe<std::string>, accommodations))
/// `exams`: of which tickets are good.
CAVUM_JSON(Tickets, (List<TicketRow>, tickets), (List<ExamFacts>, exams))
/// `begun`: it is known that the candidate has begun.
CAVUM_JSON(CancelTicket, (std::uint64_t, entry), (Reason, reason), (bool, begun, optional))
CAVUM_JSON(MakeUp, (std::uint64_t, ticket), (Line, became), (Line, from), (Line, until), (Granting, accommodations), (Reason, reason),
           (Maybe<double>, extra_time_percent, optional), (Maybe<double>, extra_time_s, optional), (bool, begin_at_office, optional),
           (bool, left_handed, optional), (bool, high_contrast, optional))
CAVUM_JSON(MadeUp, (std::uint64_t, entry), (std::string, candidate), (std::string, accommodations))

// The exam day.
enum class AtStation { free, check, briefing, exam, paused, ended };
[[nodiscard]] constexpr auto names_of(AtStation) { return std::array<std::string_view, 6>{"free", "check", "briefing", "exam", "paused", "ended"}; }
struct ShortLine : Text<200> {
  using Text<200>::Text;
  [[nodiscard]] Message problem() const { return is_plain_text(*this) ? Message() : msg("is no line of text"); }
};
using UpToADay = Between<-1, 86'400>;  ///< s
/// One report of a station.
/// `candidate`: pseudonym; empty: nobody sits; `step`: of the exam, for people; `alarm`: what an invigilator should see to; empty: nothing; `left_s`:
/// on the exam's clock; -1: no clock runs; `held`: the exam stands still because the office paused it; `heard`: entry of the last announcement that
/// was read; `here_s`: since the candidate signed in; -1: nobody did.
CAVUM_JSON(StationReport, (AtStation, state), (ShortLine, candidate, optional), (ShortLine, step, optional), (ShortLine, alarm, optional),
           (UpToADay, left_s, optional), (bool, held, optional), (std::uint64_t, heard, optional), (UpToADay, here_s, optional))
/// `refused`: the candidate whom it may not begin; `since_utc_ns`: when the candidate signed in; 0: nobody did.
CAVUM_JSON_MORE(StationStatus, StationReport, (std::string, refused), (std::int64_t, seen_utc_ns), (std::int64_t, since_utc_ns))
/// `hold`: entry of the pause; 0: it may run.
CAVUM_JSON(StationShown, (std::string, name), (std::string, public_key), (std::string, room), (std::uint64_t, entry), (std::uint64_t, hold),
           (bool, revoked), (std::size_t, unread), (Texts, twins), (Maybe<StationStatus>, report))
CAVUM_JSON(ToRead, (std::uint64_t, entry), (std::int64_t, utc_ns), (std::string, text))
/// A pause with its reason, or an announcement; `stations`: keys, none for all.
CAVUM_JSON_MORE(Notice, ToRead, (std::string, room), (Texts, stations))
/// `text`: in the office's language; for stations in English.
CAVUM_JSON(ShownFinding, (records::FindingKind, kind), (std::string, text))
CAVUM_JSON(RefusedExam, (std::string, sha256), (std::string, candidate), (std::string, station), (List<ShownFinding>, findings))
CAVUM_JSON(InboxShown, (std::size_t, waiting), (std::string, trouble), (List<RefusedExam>, refused))
/// `tickets`: how many, by name of their records::TicketStatus.
CAVUM_JSON(BoardShown, (std::int64_t, utc_ns), (List<StationShown>, stations), (ByName<std::size_t>, tickets), (List<Notice>, holds),
           (List<Notice>, announcements), (InboxShown, inbox))
using Invite = Only<"name", Line>;
CAVUM_JSON(InviteCode, (std::string, code), (std::string, until))
CAVUM_JSON(RevokeStation, (Line, public_key), (Reason, reason))
CAVUM_JSON(PlaceStation, (Line, public_key), (Line, room))
CAVUM_JSON(Sitting, (Line, exam), (Line, not_before), (Line, not_after))
/// A sitting, in a room where one is named; else one ticket, empty `station`: any.
CAVUM_JSON(SeatThem, (Maybe<Sitting>, sitting, optional), (Line, room, optional), (Maybe<std::uint64_t>, ticket, optional), (Line, station, optional))
CAVUM_JSON(Seated, (std::uint64_t, entry), (std::size_t, seated), (std::size_t, left))
CAVUM_JSON(MissingPerson, (std::string, candidate), (std::string, id), (std::string, name), (std::string, exam), (std::string, not_before),
           (std::string, not_after), (std::string, seat), (bool, no_show))
using Attendance = Only<"missing", std::vector<MissingPerson>>;
/// All stations, those of a room, or one, by its key.
CAVUM_JSON(ForWhom, (bool, all, optional), (Line, room, optional), (Line, station, optional))
CAVUM_JSON(Announce, (Line, text), (ForWhom, to))
CAVUM_JSON(Hold, (Reason, reason), (ForWhom, to))
CAVUM_JSON(GoOn, (std::uint64_t, hold), (Reason, reason))
CAVUM_JSON(NoteIncident, (Line, station, optional), (Line, candidate, optional), (Line, words))
CAVUM_JSON(IncidentRow, (std::uint64_t, entry), (std::string, utc), (std::string, by), (std::string, station), (std::string, candidate),
           (std::string, id), (std::string, name), (std::string, words), (bool, erased))
using Incidents = Only<"incidents", std::vector<IncidentRow>>;

// Results. `sha256` of the recording; empty where it was erased.
CAVUM_JSON(Decided, (std::uint64_t, entry), (std::string, by), (std::string, verdict), (std::string, reason), (bool, counts))
/// Of a candidate on the day.
CAVUM_JSON(Noted, (std::string, utc), (std::string, station), (std::string, words))
CAVUM_JSON(ToDecide, (std::uint64_t, session), (std::string, candidate), (std::string, exam), (double, points), (double, max), (Texts, reasons),
           (Maybe<Decided>, decided), (List<Noted>, noted), (std::string, sha256))
using Queue = Only<"queue", std::vector<ToDecide>>;
CAVUM_JSON(Decide, (std::uint64_t, session), (Line, verdict), (Reason, reason))
CAVUM_JSON(StillOut, (std::string, verdict), (Maybe<double>, points))
/// `result`: entry of the one that counts; `grade`: as the gradebook has what was released; `out`: what was released, where another
/// result has come since; `later`: the attempt that counts instead.
CAVUM_JSON(ResultRow, (std::uint64_t, session), (std::uint64_t, result), (std::string, candidate), (std::string, exam), (std::string, state),
           (std::string, verdict), (std::string, station), (std::string, seat), (std::string, why_back), (std::string, simulated),
           (std::string, sha256), (Maybe<std::string>, id), (Maybe<std::string>, name), (Maybe<double>, points), (Maybe<double>, max),
           (Maybe<double>, grade), (List<ShownFinding>, findings), (Maybe<Decided>, decided), (bool, shown), (bool, appeal), (Maybe<std::uint64_t>, makes_up),
           (Maybe<std::uint64_t>, made_up_by), (Maybe<StillOut>, out), (Maybe<std::uint64_t>, later))
using Results = Only<"results", std::vector<ResultRow>>;
/// All that is ready, sessions, or results as a page showed them, each by its entry.
CAVUM_JSON(ReleaseResults, (bool, all, optional), (bool, with_findings, optional), (Entries, sessions, optional), (Maybe<Entries>, results, optional),
           (Reason, reason), (Code, code))
CAVUM_JSON(Released, (std::size_t, released), (std::size_t, withheld), (std::size_t, to_decide))
CAVUM_JSON(Retract, (Entries, sessions), (Reason, reason), (Code, code))
CAVUM_JSON(AppealRow, (std::uint64_t, entry), (std::uint64_t, session), (std::string, utc), (std::string, candidate), (std::string, exam),
           (std::string, verdict), (std::string, sha256), (std::string, reason), (std::string, outcome), (std::string, answer),
           (Maybe<double>, points), (Maybe<double>, max), (Maybe<Decided>, decided), (List<Noted>, noted), (Maybe<std::uint64_t>, made_up_by),
           (bool, open), (bool, changed))
using Appeals = Only<"appeals", std::vector<AppealRow>>;
CAVUM_JSON(OpenAppeal, (std::uint64_t, session), (Reason, reason))
CAVUM_JSON(AnswerAppeal, (std::uint64_t, session), (Line, outcome), (Reason, reason))
/// Those of a pseudonym (or number, for an officer), and before an entry.
CAVUM_JSON(AskTrail, (Line, about, optional), (Maybe<std::uint64_t>, before, optional))
CAVUM_JSON(TrailPerson, (std::string, candidate), (Maybe<std::string>, id), (Maybe<std::string>, name))
/// `number`: of results, seats or erased parts; `count`: of people; `people`: who is asked for, or the only one.
CAVUM_JSON(TrailEntry, (std::uint64_t, entry), (std::string, utc), (std::string, what), (std::string, by), (std::string, why), (std::size_t, number),
           (std::size_t, count), (List<TrailPerson>, people))
/// `earlier`: the next `before`; none at the beginning.
CAVUM_JSON(TrailPage, (List<TrailEntry>, entries), (Maybe<std::uint64_t>, earlier))

// A new rubric over all of an exam.
CAVUM_JSON(RegradeShown, (RegradeState, state), (std::string, id), (std::string, exam), (std::string, by), (std::string, begun),
           (std::string, problem), (std::size_t, done), (std::size_t, of), (std::size_t, left_out), (Maybe<double>, left_s), (std::uint64_t, counted),
           (std::uint64_t, first_entry))
CAVUM_JSON(RegradeRow, (std::uint64_t, session), (std::string, candidate), (std::string, verdict_before), (std::string, verdict),
           (double, points_before), (double, max_before), (double, points), (double, max), (bool, other_verdict), (bool, other_points),
           (bool, decided), (bool, shown))
CAVUM_JSON(FiledExam, (std::string, id), (std::size_t, sessions))
/// `sessions`: once it is ready.
CAVUM_JSON_MORE(RegradeAll, RegradeShown, (Maybe<List<RegradeRow>>, sessions), (List<FiledExam>, exams))
/// `rubric`: TOML.
CAVUM_JSON(BeginRegrade, (Line, exam), (Text<200U << 10>, rubric))
using RegradeId = Only<"id", Line>;
CAVUM_JSON(CountRegrade, (Line, id), (Reason, reason), (Code, code))
CAVUM_JSON(RegradeCounted, (std::size_t, counted), (std::uint64_t, first_entry))

// Learning platforms.
CAVUM_JSON_MORE(PlatformShown, LtiPlatform, (LtiAddresses, addresses))
CAVUM_JSON(KeyShown, (std::string, kid), (std::string, made))
/// Numbers of scores of a course, and what keeps them back, in words.
CAVUM_JSON(ScoresOfCourse, (std::string, platform), (std::string, title), (std::string, exam), (std::string, item), (int, sent), (int, refused),
           (int, waiting), (int, unknown), (std::string, trouble))
CAVUM_JSON(LtiSetUp, (List<PlatformShown>, platforms), (List<KeyShown>, keys), (List<ScoresOfCourse>, progress))
CAVUM_JSON(SetPlatform, (LtiPlatform, platform), (Code, code))
CAVUM_JSON(RemovePlatform, (Line, issuer), (Line, client_id), (Code, code))
/// Whoever comes as `sub` is this account; empty: nobody's any more.
CAVUM_JSON(LinkPerson, (Line, issuer), (Line, client_id), (Line, sub), (Line, account), (Code, code))

// Stations.
CAVUM_JSON(Hello, (std::string, ledger), (std::string, public_key), (std::int64_t, utc_ns))
CAVUM_JSON(Enrolled, (std::uint64_t, entry), (std::string, name))
CAVUM_JSON(StationTicket, (std::string, candidate), (std::string, nonce), (std::string, text))
using StationTickets = Only<"tickets", std::vector<StationTicket>>;
using AskBegin = Only<"ticket", Line>;  ///< its nonce
using WordToBegin = Only<"begin", std::string>;
CAVUM_JSON(HoldHere, (std::uint64_t, entry), (std::string, reason))
/// `tickets`: another number: fetch them again.
CAVUM_JSON(OfficeWord, (std::int64_t, utc_ns), (std::size_t, tickets), (Maybe<HoldHere>, hold), (List<ToRead>, announcements))
/// Of a recording that is handed in; in pieces how much there is, until it is whole.
CAVUM_JSON(HandInState, (Maybe<HandedState>, state), (Maybe<std::uint64_t>, have), (Maybe<std::uint64_t>, of), (Maybe<std::uint64_t>, entry),
           (Maybe<nlohmann::json>, receipt), (Maybe<List<ShownFinding>>, findings))
// clang-format on

}  // namespace cavum::office
