// Every route of the office's server, in one table: what is asked for, who may ask, how much may be
// sent, whether a reason and a code of the second factor go with it, and the types of request and
// answer. The server puts a handler behind each row (office.cpp: one that is missing does not
// compile), and the build makes the pages' paths and types from it (routes_ts.cpp).
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>

#include "ui/office/pieces.h"
#include "ui/office/wire.h"

namespace cavum::office {

/// "officer" and so on.
[[nodiscard]] std::string_view name_of(Role role) noexcept;
/// None for another word.
[[nodiscard]] std::optional<Role> role_named(std::string_view name) noexcept;
[[nodiscard]] std::span<const Role> all_roles() noexcept;

/// Who has to be known before a route is gone: nobody, a person who signed in, or an enrolled
/// station that signed the request. One who came from a learning platform has a cookie of his own;
/// a form that a platform's page sends is let in as it is, and its handler checks it.
enum class Asks { nobody, person, station, came, form };
struct Who {
  Asks asks;
  unsigned roles = 0;  ///< bits by Role, where a person is asked for
};
template <class... Roles>
requires(sizeof...(Roles) > 0) consteval Who people(Roles... roles) {
  return {Asks::person, (0U | ... | (1U << static_cast<unsigned>(roles)))};
}

/// What a request bears beside its wish.
enum class Needs { nothing, reason, reason_and_code, code };

struct Route {
  std::string_view name, method;
  std::string_view path;  ///< to the letter; `*` at its end stands for 64 hexadecimal digits
  Asks asks;
  unsigned roles;
  std::uint64_t largest_bytes;  ///< of the body
  Needs needs;
  [[nodiscard]] constexpr bool lets(Role role) const noexcept {
    return (roles & (1U << static_cast<unsigned>(role))) != 0;
  }
  /// A person's request that changes something: it needs the token of the sign-in.
  [[nodiscard]] constexpr bool changes() const noexcept { return method != "GET"; }
  [[nodiscard]] constexpr bool needs_code() const noexcept {
    return needs == Needs::code || needs == Needs::reason_and_code;
  }
  [[nodiscard]] constexpr bool needs_reason() const noexcept {
    return needs == Needs::reason || needs == Needs::reason_and_code;
  }
  /// Its path, with this in the place of `*`.
  [[nodiscard]] std::string path_of(std::string_view tail = {}) const;
};
[[nodiscard]] std::span<const Route> routes() noexcept;
/// The route of a request; null when there is none.
[[nodiscard]] const Route* route_for(std::string_view method, std::string_view path) noexcept;
/// What stands for `*` in the path of a route.
[[nodiscard]] std::string_view tail_of(const Route& route, std::string_view path) noexcept;

// Bodies that are no struct.
struct Nothing {};  ///< none is read; {} is answered
struct Raw {};      ///< the handler reads it, or writes it, as it is
struct InParts {};  ///< taken part by part, for what is too large to be held
template <class T>
struct EventsOf {};  ///< server-sent events, each a T

inline constexpr Who k_anybody{Asks::nobody}, k_station{Asks::station}, k_came{Asks::came},
    k_form{Asks::form},
    k_officer = people(Role::officer), k_examiner = people(Role::examiner),
    k_staff = people(Role::officer, Role::examiner),
    k_hall = people(Role::officer, Role::invigilator),
    k_results = people(Role::officer, Role::examiner, Role::reader),
    k_all = people(Role::officer, Role::examiner, Role::invigilator, Role::reader);
inline constexpr std::uint64_t k_none = 0, k_small = 16U << 10, k_launch = 128U << 10,
                               k_rubric = 512U << 10, k_seats = 1U << 20, k_roster = 4U << 20;

// clang-format off
#define CAVUM_ROUTES(ROUTE) \
  ROUTE(page,            GET,  "/",                        k_anybody,  k_none,            nothing,         Nothing, Raw) \
  ROUTE(page_script,     GET,  "/office.js",               k_anybody,  k_none,            nothing,         Nothing, Raw) \
  ROUTE(page_style,      GET,  "/office.css",              k_anybody,  k_none,            nothing,         Nothing, Raw) \
  ROUTE(words,           GET,  "/api/words",               k_anybody,  k_none,            nothing,         Nothing, Words) \
  ROUTE(sign_in,         POST, "/api/sign-in",             k_anybody,  k_small,           nothing,         SignIn, Me) \
  ROUTE(sign_in_by_proxy, POST, "/api/sign-in/proxy",       k_anybody,  k_small,           nothing,         Nothing, Me) \
  ROUTE(sign_out,        POST, "/api/sign-out",            k_all,      k_small,           nothing,         Nothing, Nothing) \
  ROUTE(me,              GET,  "/api/me",                  k_all,      k_none,            nothing,         Nothing, Me) \
  ROUTE(exams,           GET,  "/api/exams",               k_officer,  k_none,            nothing,         Nothing, Exams) \
  ROUTE(preview,         POST, "/api/roster/preview",      k_officer,  k_roster,          nothing,         ClassList, Preview) \
  ROUTE(issue,           POST, "/api/roster/issue",        k_officer,  k_roster,          reason,          Issue, Issued) \
  ROUTE(tickets,         GET,  "/api/tickets",             k_hall,     k_none,            nothing,         Nothing, Tickets) \
  ROUTE(cancel_ticket,   POST, "/api/tickets/cancel",      k_officer,  k_small,           reason,          CancelTicket, Entered) \
  ROUTE(make_up,         POST, "/api/tickets/makeup",      k_officer,  k_small,           reason,          MakeUp, MadeUp) \
  ROUTE(board,           GET,  "/api/board",               k_hall,     k_none,            nothing,         Nothing, BoardShown) \
  ROUTE(board_events,    GET,  "/api/board/events",        k_hall,     k_none,            nothing,         Nothing, EventsOf<BoardShown>) \
  ROUTE(invite_station,  POST, "/api/stations/invite",     k_officer,  k_small,           nothing,         Invite, InviteCode) \
  ROUTE(revoke_station,  POST, "/api/stations/revoke",     k_officer,  k_small,           reason,          RevokeStation, Entered) \
  ROUTE(place_station,   POST, "/api/stations/room",       k_officer,  k_small,           nothing,         PlaceStation, Entered) \
  ROUTE(seats,           POST, "/api/seats",               k_officer,  k_seats,           nothing,         SeatThem, Seated) \
  ROUTE(attendance,      GET,  "/api/attendance",          k_hall,     k_none,            nothing,         Nothing, Attendance) \
  ROUTE(cards,           GET,  "/api/cards.pdf",           k_officer,  k_none,            nothing,         Nothing, Raw) \
  ROUTE(sign_in_sheet,   GET,  "/api/sign-in-sheet.pdf",   k_hall,     k_none,            nothing,         Nothing, Raw) \
  ROUTE(announce,        POST, "/api/announce",            k_hall,     k_small,           nothing,         Announce, Entered) \
  ROUTE(hold,            POST, "/api/hold",                k_hall,     k_small,           reason,          Hold, Entered) \
  ROUTE(go_on,           POST, "/api/go-on",               k_hall,     k_small,           reason,          GoOn, Entered) \
  ROUTE(incidents,       GET,  "/api/incidents",           k_hall,     k_none,            nothing,         Nothing, Incidents) \
  ROUTE(note_incident,   POST, "/api/incidents",           k_hall,     k_small,           nothing,         NoteIncident, Entered) \
  ROUTE(queue,           GET,  "/api/queue",               k_staff,    k_none,            nothing,         Nothing, Queue) \
  ROUTE(decide,          POST, "/api/decide",              k_examiner, k_small,           reason,          Decide, Entered) \
  ROUTE(results,         GET,  "/api/results",             k_results,  k_none,            nothing,         Nothing, Results) \
  ROUTE(release,         POST, "/api/release",             k_officer,  k_small,           reason_and_code, ReleaseResults, Released) \
  ROUTE(retract,         POST, "/api/retract",             k_officer,  k_small,           reason_and_code, Retract, Entered) \
  ROUTE(regrade,         GET,  "/api/regrade",             k_staff,    k_none,            nothing,         Nothing, RegradeAll) \
  ROUTE(regrade_events,  GET,  "/api/regrade/events",      k_staff,    k_none,            nothing,         Nothing, EventsOf<RegradeShown>) \
  ROUTE(begin_regrade,   POST, "/api/regrade/begin",       k_examiner, k_rubric,          nothing,         BeginRegrade, RegradeId) \
  ROUTE(count_regrade,   POST, "/api/regrade/count",       k_examiner, k_small,           reason_and_code, CountRegrade, RegradeCounted) \
  ROUTE(drop_regrade,    POST, "/api/regrade/drop",        k_examiner, k_small,           nothing,         RegradeId, Nothing) \
  ROUTE(appeals,         GET,  "/api/appeals",             k_staff,    k_none,            nothing,         Nothing, Appeals) \
  ROUTE(open_appeal,     POST, "/api/appeals/open",        k_officer,  k_small,           reason,          OpenAppeal, Entered) \
  ROUTE(answer_appeal,   POST, "/api/appeals/answer",      k_examiner, k_small,           reason,          AnswerAppeal, Entered) \
  ROUTE(trail,           POST, "/api/trail",               k_results,  k_small,           nothing,         AskTrail, TrailPage) \
  ROUTE(report,          GET,  "/api/report/*",            k_staff,    k_none,            nothing,         Nothing, Raw) \
  ROUTE(gradebook,       GET,  "/api/gradebook.csv",       k_officer,  k_none,            nothing,         Nothing, Raw) \
  ROUTE(criteria,        GET,  "/api/criteria.csv",        k_results,  k_none,            nothing,         Nothing, Raw) \
  ROUTE(lti,             GET,  "/api/lti",                 k_officer,  k_none,            nothing,         Nothing, LtiSetUp) \
  ROUTE(set_platform,    POST, "/api/lti/set",             k_officer,  k_seats,           code,            SetPlatform, LtiSetUp) \
  ROUTE(remove_platform, POST, "/api/lti/remove",          k_officer,  k_small,           code,            RemovePlatform, LtiSetUp) \
  ROUTE(link_person,     POST, "/api/lti/link",            k_officer,  k_small,           code,            LinkPerson, LtiSetUp) \
  ROUTE(new_key,         POST, "/api/lti/new-key",         k_officer,  k_small,           code,            WithCode, LtiSetUp) \
  ROUTE(send_scores,     POST, "/api/lti/send",            k_officer,  k_small,           nothing,         Nothing, Nothing) \
  ROUTE(lti_keys,        GET,  k_lti_keys,                 k_anybody,  k_none,            nothing,         Nothing, Raw) \
  ROUTE(lti_login,       GET,  k_lti_login,                k_anybody,  k_none,            nothing,         Nothing, Raw) \
  ROUTE(lti_login_form,  POST, k_lti_login,                k_form,     k_small,           nothing,         Raw, Raw) \
  ROUTE(lti_launch,      POST, k_lti_launch,               k_form,     k_launch,          nothing,         Raw, Raw) \
  ROUTE(own_results,     GET,  "/lti/result",              k_came,     k_none,            nothing,         Nothing, Raw) \
  ROUTE(own_report,      GET,  "/lti/report/*",            k_came,     k_none,            nothing,         Nothing, Raw) \
  ROUTE(hello,           GET,  "/station/hello",           k_anybody,  k_none,            nothing,         Nothing, Hello) \
  ROUTE(enrol,           POST, "/station/enrol",           k_anybody,  k_small,           nothing,         Raw, Enrolled) \
  ROUTE(station_tickets, GET,  "/station/tickets",         k_station,  k_none,            nothing,         Nothing, StationTickets) \
  ROUTE(begin_exam,      POST, "/station/begin",           k_station,  k_small,           nothing,         AskBegin, WordToBegin) \
  ROUTE(station_report,  POST, "/station/report",          k_station,  k_small,           nothing,         StationReport, OfficeWord) \
  ROUTE(add_piece,       PUT,  "/station/pieces/*",        k_station,  k_largest_piece,   nothing,         Raw, HandInState) \
  ROUTE(pieces_had,      GET,  "/station/pieces/*",        k_station,  k_none,            nothing,         Nothing, HandInState) \
  ROUTE(hand_in,         PUT,  "/station/sessions/*",      k_station,  k_largest_session, nothing,         InParts, HandInState) \
  ROUTE(handed_in,       GET,  "/station/sessions/*",      k_station,  k_none,            nothing,         Nothing, HandInState)
// clang-format on

template <class Request>
concept BearsReason = requires(Request asked) {
  { asked.reason } -> std::same_as<Reason&>;
};
template <class Request>
concept BearsCode = requires(Request asked) {
  { asked.code } -> std::same_as<Code&>;
};

/// A type for each row: its handler is answer(route::NAME, …).
namespace route {
#define CAVUM_ROUTE_TYPE(NAME, METHOD, PATH, WHO, LARGEST, NEEDS, REQUEST, ANSWER) \
  struct NAME {                                                                    \
    using Request = office::REQUEST;                                               \
    using Answer = office::ANSWER;                                                 \
    static constexpr Route row{#NAME,       #METHOD, PATH,        (WHO).asks,      \
                               (WHO).roles, LARGEST, Needs::NEEDS};                \
    static_assert(!JsonStruct<Request> || is_limited<Request>(),                   \
                  "a field of the request has no limit");                          \
    static_assert(row.needs_reason() == BearsReason<Request> &&                    \
                  row.needs_code() == BearsCode<Request>);                         \
  };
CAVUM_ROUTES(CAVUM_ROUTE_TYPE)
#undef CAVUM_ROUTE_TYPE
}  // namespace route

/// with(route::NAME()) for each row.
template <class With>
void each_route(const With& with) {
#define CAVUM_WITH(NAME, ...) with(route::NAME());
  CAVUM_ROUTES(CAVUM_WITH)
#undef CAVUM_WITH
}

}  // namespace cavum::office
