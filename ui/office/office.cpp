#include "ui/office/office.h"

#include <fmt/core.h>

#include <chrono>
#include <map>
#include <mutex>
#include <optional>
#include <regex>
#include <thread>

#include "engine/base/json_fields.h"
#include "engine/base/text.h"
#include "engine/session/session.h"
#include "ui/language/catalogue.h"
#include "ui/language/language.h"
#include "ui/language/say.h"
#include "ui/office/desk.h"
#include "ui/office/desk_parts.h"
#include "ui/office/lti_office.h"
#include "ui/office/one_time_code.h"
#include "ui/office/page_files.h"
#include "ui/office/pieces.h"
#include "ui/office/regrades.h"
#include "ui/office/reports.h"
#include "ui/office/site.h"

namespace cavum::office {
namespace {

/// As a station is told: it knows what to say in its own language of nothing but the state.
std::vector<ShownFinding> english_each(const records::Findings& findings) {
  std::vector<ShownFinding> told;
  for (const auto& f : findings) told.push_back({f.kind, english_text(f.message())});
  return told;
}

using nlohmann::json;

constexpr std::size_t k_tries_of_a_name = 5, k_tries_of_an_address = 20, k_tries_of_a_code = 5,
                      k_tries_of_enrolment = 10;
constexpr int k_patience_ms = 1000, k_silence_s = 15;
constexpr auto k_between_events = std::chrono::milliseconds(250);

std::int64_t steady_s() {
  return std::chrono::duration_cast<std::chrono::seconds>(
             std::chrono::steady_clock::now().time_since_epoch())
      .count();
}
std::int64_t utc_now_ns() { return read_clocks().utc_ns; }

std::string cookie_field(const std::string& value, std::int64_t seconds) {
  return fmt::format("{}={}; Path=/; Max-Age={}; Secure; HttpOnly; SameSite=Strict", k_cookie,
                     value, seconds);
}

Reply page_of(const char* type, std::string_view text) { return {200, type, std::string(text)}; }
Reply file_of(const char* type, const std::string& name, std::string text) {
  Reply reply{200, type, std::move(text)};
  reply.fields.emplace_back("Content-Disposition",
                            fmt::format("attachment; filename=\"{}\"", name));
  return reply;
}
constexpr char k_csv[] = "text/csv; charset=utf-8", k_pdf[] = "application/pdf";

/// "at=0&of=1000", to the letter; none: it is something else.
std::optional<std::pair<std::uint64_t, std::uint64_t>> place_in(const std::string& query) {
  static const std::regex k_place("at=([0-9]{1,9})&of=([0-9]{1,9})");
  std::smatch found;
  if (!std::regex_match(query, found, k_place)) return std::nullopt;
  return std::pair(std::stoull(found[1]), std::stoull(found[2]));
}

/// A recording that a station hands in.
class TakesSession : public Taker {
 public:
  TakesSession(Inbox& inbox, const std::string& sha256, const std::string& station)
      : inbox_(inbox), sha256_(sha256), station_(station), file_(inbox.receive(sha256)) {}
  void take(std::string_view part) override { file_->take(part); }
  Reply done() override {
    file_->keep();
    inbox_.add(sha256_, station_);
    return json_reply(to_json_value(HandInState{HandedState::waiting}), 202);
  }

 private:
  Inbox& inbox_;
  std::string sha256_, station_;
  std::unique_ptr<Arriving> file_;
};

}  // namespace

struct Office::Parts {
  explicit Parts(const OfficeOptions& o)
      : accounts(o.home + "/accounts.json"),
        desk(o.ledger_folder, o.school, {o.home}, o.exams),
        inbox(o.home + "/" + desk.ledger_id() + "/inbox", o.ledger_folder, o.school, o.filing,
              [this] { board.touch(); }),
        pieces(
            o.home + "/" + desk.ledger_id() + "/pieces",
            [this](const std::string& path, const std::string& sha256, const std::string& station) {
              inbox.adopt(path, sha256, station);
            },
            [] { return utc_now_ns() / 1'000'000'000; }),
        lti(
            desk, o.home, o.student_report,
            [this](const std::string& name) { return accounts.of(name); },
            [this](const Account& account) {
              return cookie_field(site.sign_ins().begin(account, steady_s()), k_absolute_end_s);
            }),
        site({[this](const std::string& name) {
                auto account = accounts.of(name);
                return account ? account : lti.reader(name);
              },
              [this](const std::string& key) { return desk.station_problem(key); }, steady_s,
              utc_now_ns, desk.ledger_id(), o.proxy,
              [this](const std::string& cookie) { return lti.has_come(cookie); }}),
        proxied(o.proxy.has_value()),
        rehearsal(o.filing.simulated),
        reports(o.report),
        regrades(desk, o.ledger_folder, o.home + "/" + desk.ledger_id() + "/regrade.json"),
        used_codes(o.home + "/" + desk.ledger_id() + "/used_codes.json") {
    each_route([this]<class Served>(Served) {
      if constexpr (std::same_as<typename Served::Request, InParts>)
        site.on_parts(Served::row, [this](const Call& c) { return answer(Served(), c); });
      else
        site.on(Served::row, [this](const Call& c) { return serve<Served>(c); });
    });
    server = std::make_unique<HttpServer>(
        o.address, o.port, o.certificate, [this](const Head& head) { return site.welcome(head); },
        o.limits);
  }

  /// From what was asked to what is answered, with what the row of the route says.
  template <class Served>
  [[nodiscard]] Reply serve(const Call& call) {
    if constexpr (JsonStruct<typename Served::Request>) {
      auto asked = json_value_of<typename Served::Request>(call.json(), asked_json());
      if constexpr (std::same_as<Served, route::count_regrade>)
        regrades.require_ready(asked.id, call.by->account);  // or a code is used up for nothing
      if constexpr (Served::row.needs_code()) require_code(asked.code, call.by->account);
      return answered<Served>(call, asked);
    } else {
      return answered<Served>(call);
    }
  }

  template <class Served>
  [[nodiscard]] Reply answered(const Call& call, const auto&... asked) {
    Reply reply = [&] {
      if constexpr (requires { answer(Served(), asked..., call); })
        return reply_of<typename Served::Answer>(answer(Served(), asked..., call));
      else
        return reply_of<typename Served::Answer>(lti.answer(Served(), asked..., call));
    }();
    if (Served::row.asks == Asks::person && Served::row.changes()) {
      board.touch();
      lti.nudge();
    }
    return reply;
  }

  template <class Answer, class Given>
  [[nodiscard]] static Reply reply_of(Given given) {
    if constexpr (std::same_as<Answer, Raw>) {
      return given;
    } else if constexpr (requires { given.stream; }) {
      static_assert(std::same_as<Answer, typename Given::Answer>);
      return std::move(given.stream);
    } else {
      Answered<Answer> told(std::move(given));
      Reply reply = json_reply(to_json_value(told.body), told.status);
      reply.fields = std::move(told.fields);
      return reply;
    }
  }

  Reply answer(route::page, const Call&) {
    return page_of("text/html; charset=utf-8", page_html());
  }
  Reply answer(route::page_script, const Call&) {
    return page_of("text/javascript; charset=utf-8", page_script());
  }
  Reply answer(route::page_style, const Call&) {
    return page_of("text/css; charset=utf-8", page_style());
  }
  Words answer(route::words, const Call&) {
    Words out{language(), std::string(1, decimal_sign()), {}, proxied};
    if (language() != "en")
      for (const auto& m : page_messages()) out.words[m] = catalogue().find(m).value_or(m);
    return out;
  }

  Answered<Nothing> answer(route::sign_out, const Call& c) {
    site.sign_ins().end(c.cookie);
    return {Nothing(), cookie_field("", 0)};
  }
  Me answer(route::me, const Call& c) { return me(*c.by); }

  [[nodiscard]] Me me(const SignedIn& who) const {
    Me out{who.account.name,
           who.account.role,
           who.token,
           {},
           desk.school(),
           rehearsal,
           !who.account.code_secret.empty()};
    for (const Route& r : routes())
      if (r.asks == Asks::person && r.lets(who.account.role))
        out.may.push_back(fmt::format("{} {}", r.method, r.path));
    return out;
  }

  Answered<Me> answer(route::sign_in, const SignIn& asked, const Call& call) {
    const std::string key = call.head.address + " " + asked.name;
    const std::int64_t now = steady_s();
    if (!tries.allow(call.head.address, k_tries_of_an_address, now) ||
        !tries.allow(key, k_tries_of_a_name, now))
      throw Refused{429, msg("too many tries: wait a minute")};
    const auto account = accounts.sign_in(asked.name, asked.password);
    if (!account) throw Refused{401, msg("name and password do not belong together")};
    tries.forget(key);
    return signed_in(*account, now, "");
  }

  /// Who the proxy says it is, where that is an account here: its role is the account's.
  Answered<Me> answer(route::sign_in_by_proxy, const Call& call) {
    if (!proxied) throw Refused{404, msg("there is nothing here")};
    if (call.proxied_as.empty())
      throw Refused{401, msg("the school's sign-on says nobody: come by its address")};
    const std::int64_t now = steady_s();
    if (!tries.allow("proxy " + call.proxied_as, k_tries_of_an_address, now))
      throw Refused{429, msg("too many tries: wait a minute")};
    const auto account = accounts.called(call.proxied_as);
    if (!account)
      throw Refused{
          403,
          msg("the school's sign-on knows you, and this office has no account for you: ask who runs it")};
    return signed_in(*account, now, call.proxied_as);
  }

  Answered<Me> signed_in(const Account& account, std::int64_t now, const std::string& proxied_as) {
    const std::string cookie = site.sign_ins().begin(account, now, proxied_as);
    return {me(*site.sign_ins().of(cookie, now)), cookie_field(cookie, k_absolute_end_s)};
  }

  Exams answer(route::exams, const Call&) { return desk.exams(); }
  Preview answer(route::preview, const ClassList& asked, const Call&) {
    return desk.preview(asked);
  }
  Issued answer(route::issue, const Issue& asked, const Call& c) {
    return desk.issue(asked, c.by->account);
  }
  Tickets answer(route::tickets, const Call& c) {
    return desk.tickets(is_officer(c), board.candidates());
  }
  Entered answer(route::cancel_ticket, const CancelTicket& asked, const Call& c) {
    return desk.cancel(asked, c.by->account, board.candidates());
  }
  MadeUp answer(route::make_up, const MakeUp& asked, const Call& c) {
    return desk.make_up(asked, c.by->account);
  }
  BoardShown answer(route::board, const Call&) { return desk.board(board, inbox); }
  Stream<BoardShown> answer(route::board_events, const Call& c) {
    return events<BoardShown>(
        c, [this](std::uint64_t seen) { return board.wait(seen, k_patience_ms); },
        [this] { return desk.board(board, inbox); }, true);
  }
  InviteCode answer(route::invite_station, const Invite& asked, const Call& c) {
    return desk.invite(asked, c.by->account);
  }
  Entered answer(route::revoke_station, const RevokeStation& asked, const Call& c) {
    return desk.revoke(asked, c.by->account);
  }
  Entered answer(route::place_station, const PlaceStation& asked, const Call& c) {
    return desk.place(asked, c.by->account);
  }
  Seated answer(route::seats, const SeatThem& asked, const Call& c) {
    return desk.seat(asked, c.by->account);
  }
  Attendance answer(route::attendance, const Call&) { return desk.attendance(board); }
  Reply answer(route::cards, const Call&) { return file_of(k_pdf, "cards.pdf", desk.cards()); }
  Reply answer(route::sign_in_sheet, const Call&) {
    return file_of(k_pdf, "sign-in-sheet.pdf", desk.sign_in_sheet());
  }
  Entered answer(route::announce, const Announce& asked, const Call& c) {
    return desk.announce(asked, c.by->account);
  }
  Entered answer(route::hold, const Hold& asked, const Call& c) {
    return desk.hold(asked, c.by->account);
  }
  Entered answer(route::go_on, const GoOn& asked, const Call& c) {
    return desk.go_on(asked, c.by->account);
  }
  Incidents answer(route::incidents, const Call&) { return desk.incidents(); }
  Entered answer(route::note_incident, const NoteIncident& asked, const Call& c) {
    return desk.note_incident(asked, c.by->account);
  }
  Queue answer(route::queue, const Call&) { return desk.queue(); }
  Entered answer(route::decide, const Decide& asked, const Call& c) {
    return desk.decide(asked, c.by->account);
  }
  Results answer(route::results, const Call& c) { return desk.results(is_officer(c)); }
  Released answer(route::release, const ReleaseResults& asked, const Call& c) {
    return desk.release(asked, c.by->account);
  }
  Entered answer(route::retract, const Retract& asked, const Call& c) {
    return desk.retract(asked, c.by->account);
  }
  RegradeAll answer(route::regrade, const Call&) {
    return {regrades.state(), regrades.rows(), desk.filed_exams()};
  }
  Stream<RegradeShown> answer(route::regrade_events, const Call& c) {
    return events<RegradeShown>(
        c, [this](std::uint64_t seen) { return regrades.wait(seen, k_patience_ms); },
        [this] { return regrades.state(); });
  }
  RegradeId answer(route::begin_regrade, const BeginRegrade& asked, const Call& c) {
    return regrades.begin(asked, c.by->account);
  }
  RegradeCounted answer(route::count_regrade, const CountRegrade& asked, const Call& c) {
    return regrades.count(asked, c.by->account);
  }
  Nothing answer(route::drop_regrade, const RegradeId& asked, const Call& c) {
    return regrades.drop(asked.value, c.by->account), Nothing();
  }
  Appeals answer(route::appeals, const Call&) { return desk.appeals(); }
  Entered answer(route::open_appeal, const OpenAppeal& asked, const Call& c) {
    return desk.open_appeal(asked, c.by->account);
  }
  Entered answer(route::answer_appeal, const AnswerAppeal& asked, const Call& c) {
    return desk.answer_appeal(asked, c.by->account);
  }
  TrailPage answer(route::trail, const AskTrail& asked, const Call& c) {
    return desk.trail(asked, is_officer(c));
  }
  Reply answer(route::report, const Call& c) { return reports.of(desk.recording(c.tail)); }
  Reply answer(route::gradebook, const Call&) {
    return file_of(k_csv, "gradebook.csv", desk.gradebook(rehearsal));
  }
  Reply answer(route::criteria, const Call&) {
    return file_of(k_csv, "criteria.csv", desk.criteria());
  }
  [[nodiscard]] static bool is_officer(const Call& c) {
    return c.by->account.role == Role::officer;
  }

  /// What `say` says whenever `wait` gives another number, four times a second at most; after a
  /// silence a comment, so that a line that is dead is noticed, or, with `by_time`, what `say` says
  /// then: tickets run out by the clock alone.
  template <class Event>
  [[nodiscard]] Stream<Event> events(const Call& call,
                                     std::function<std::uint64_t(std::uint64_t seen)> wait,
                                     std::function<Event()> say, bool by_time = false) {
    Stream<Event> reply{{200, "text/event-stream"}};
    reply.stream.events = [this, call, by_time, wait = std::move(wait),
                           say = std::move(say)](const WriteEvent& write) {
      std::uint64_t seen = 0;
      std::int64_t spoken_s = steady_s();
      while (site.still(call)) {
        const std::uint64_t now = wait(seen);
        if (now != seen) {
          seen = now;
          spoken_s = steady_s();
          if (!write("data: " + json_reply(to_json_value(say())).body + "\n\n")) return;
          std::this_thread::sleep_for(k_between_events);
        } else if (steady_s() - spoken_s >= k_silence_s) {
          spoken_s = steady_s();
          if (!write(by_time ? "data: " + json_reply(to_json_value(say())).body + "\n\n"
                             : std::string(":\n\n")))
            return;
        } else if (!write("")) {
          return;
        }
      }
    };
    return reply;
  }

  /// A release and a new rubric ask for a code of the second factor, each good once.
  void require_code(const std::string& code, const Account& by) {
    if (by.code_secret.empty())
      throw Error(
          msg("this"), msg("needs a second factor, and this account has none"),
          msg("cavum serve --add-account NAME --role {} --second-factor", name_of(by.role)));
    if (!tries.allow("code " + by.name, k_tries_of_a_code, steady_s()))
      throw Error(msg("the code"), msg("was tried too often"), msg("wait a minute"));
    const auto counter = counter_of_code(from_base32(by.code_secret).value_or(Bytes()), code,
                                         utc_now_ns() / 1'000'000'000);
    if (!counter)
      throw Error(msg("the code"), msg("is not good"), msg("type the one that the app shows now"));
    if (!used_codes.use(by.name, *counter))
      throw Error(msg("the code"), msg("was used already: wait for the next one"),
                  msg("the app shows another one within 30 s"));
  }

  Hello answer(route::hello, const Call&) {
    return {desk.ledger_id(), desk.public_key(), utc_now_ns()};
  }
  Enrolled answer(route::enrol, const Call& c) {
    if (!tries.allow("enrol " + c.head.address, k_tries_of_enrolment, steady_s()))
      throw Refused{429, msg("too many tries: wait a minute")};
    Enrolled done = desk.enrol(c.body);
    tries.forget("enrol " + c.head.address);
    board.touch();
    return done;
  }
  StationTickets answer(route::station_tickets, const Call&) { return desk.station_tickets(); }
  WordToBegin answer(route::begin_exam, const AskBegin& asked, const Call& c) {
    try {
      WordToBegin word = desk.begin(asked, c.station);
      board.touch();
      return word;
    } catch (const Error&) {
      if (const std::string candidate = desk.candidate_of(asked.value); !candidate.empty())
        board.refused(c.station, candidate);
      throw;
    }
  }
  OfficeWord answer(route::station_report, const StationReport& report, const Call& c) {
    board.report(c.station, report, utc_now_ns());
    return desk.word_for(c.station, report.heard, board.since_utc_ns(c.station));
  }
  Answered<HandInState> answer(route::pieces_had, const Call& c) {
    return said_of(pieces.have(c.station, c.tail));
  }
  Answered<HandInState> answer(route::add_piece, const Call& c) {
    const auto place = place_in(c.head.query);
    if (!place) throw Refused{400, msg("say where the piece stands: ?at=0&of=1000")};
    return said_of(pieces.add(c.station, c.tail, place->first, place->second, c.body), true);
  }
  std::unique_ptr<Taker> answer(route::hand_in, const Call& c) {
    return std::make_unique<TakesSession>(inbox, c.tail, c.station);
  }
  HandInState answer(route::handed_in, const Call& c) {
    if (const auto entry = desk.filed(c.tail))
      return {.state = HandedState::filed, .entry = *entry, .receipt = desk.receipt(*entry)};
    const Handed h = inbox.of(c.tail);
    if (h.state == HandedState::refused)
      return {.state = h.state, .findings = english_each(h.findings)};
    return {.state = h.state == HandedState::unknown ? h.state : HandedState::waiting};
  }

  /// 409: the piece was not the next one.
  static Answered<HandInState> said_of(const Pieces::Have& h, bool after_a_piece = false) {
    if (h.whole) return {HandInState{HandedState::waiting}, 202};
    return {HandInState{.have = h.have, .of = h.of}, after_a_piece && !h.taken ? 409 : 200};
  }

  Accounts accounts;
  Desk desk;
  Board board;
  Inbox inbox;
  Pieces pieces;
  LtiOffice lti;
  Site site;
  bool proxied = false, rehearsal = false;
  Reports reports;
  Regrades regrades;
  Tries tries;
  UsedCodes used_codes;
  std::unique_ptr<HttpServer> server;  // ends first: handlers use the rest
};

Office::Office(const OfficeOptions& options) : parts_(std::make_unique<Parts>(options)) {}
Office::~Office() = default;
std::uint16_t Office::port() const noexcept { return parts_->server->port(); }
std::unique_ptr<Exchange> Office::welcome(const Head& head) { return parts_->site.welcome(head); }
const std::string& Office::school() const noexcept { return parts_->desk.school(); }

}  // namespace cavum::office
