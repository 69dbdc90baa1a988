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
#include "engine/language/language.h"
#include "engine/language/shown.h"
#include "engine/session/session.h"
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

using nlohmann::json;

constexpr std::size_t k_tries_of_a_name = 5, k_tries_of_an_address = 20, k_tries_of_a_code = 5, k_tries_of_enrolment = 10;
constexpr int k_patience_ms = 1000, k_silence_s = 15;
constexpr auto k_between_events = std::chrono::milliseconds(250);

std::int64_t steady_s() { return std::chrono::duration_cast<std::chrono::seconds>(std::chrono::steady_clock::now().time_since_epoch()).count(); }
std::int64_t utc_now_ns() { return read_clocks().utc_ns; }

std::string cookie_field(const std::string& value, std::int64_t seconds) {
  return fmt::format("{}={}; Path=/; Max-Age={}; Secure; HttpOnly; SameSite=Strict", k_cookie, value, seconds);
}

json words_of_the_page(bool proxied) {
  json words = json::object();
  if (language() != "en")
    for (const auto& m : page_messages()) words[m] = shown(m);
  return {{"language", language()}, {"decimal_sign", std::string(1, decimal_sign())}, {"words", words}, {"proxy", proxied}};
}

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
    return json_reply({{"state", "waiting"}}, 202);
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
        inbox(o.home + "/" + desk.ledger_id() + "/inbox", o.ledger_folder, o.school, o.filing, [this] { board.touch(); }),
        pieces(
            o.home + "/" + desk.ledger_id() + "/pieces",
            [this](const std::string& path, const std::string& sha256, const std::string& station) { inbox.adopt(path, sha256, station); },
            [] { return utc_now_ns() / 1'000'000'000; }),
        lti(desk, o.home, o.student_report, [this](const std::string& name) { return accounts.of(name); }),
        site({[this](const std::string& name) {
                auto account = accounts.of(name);
                return account ? account : lti.reader(name);
              },
              [this](const std::string& key) { return desk.station_problem(key); }, steady_s, utc_now_ns, desk.ledger_id(), o.proxy,
              [this](const std::string& cookie) { return lti.has_come(cookie); }}),
        proxied(o.proxy.has_value()),
        rehearsal(o.filing.simulated),
        reports(o.report),
        regrades(desk, o.ledger_folder, o.home + "/" + desk.ledger_id() + "/regrade.json"),
        used_codes(o.home + "/" + desk.ledger_id() + "/used_codes.json") {
    serve_pages();
    serve_people();
    serve_desk();
    serve_stations();
    lti.serve(
        site, [this](const std::string& code, const Account& by) { require_code(code, by); },
        [this](const Account& account) { return cookie_field(site.sign_ins().begin(account, steady_s()), k_absolute_end_s); });
    site.require_complete();
    server = std::make_unique<HttpServer>(
        o.address, o.port, o.certificate, [this](const Head& head) { return site.welcome(head); }, o.limits);
  }

  void serve_pages() {
    const auto page = [this](const char* path, const char* type, std::string_view text) {
      site.on("GET", path, [type, text](const Call&) { return Reply{200, type, std::string(text)}; });
    };
    page("/", "text/html; charset=utf-8", page_html());
    page("/office.js", "text/javascript; charset=utf-8", page_script());
    page("/office.css", "text/css; charset=utf-8", page_style());
    site.on("GET", "/api/words", [this](const Call&) { return json_reply(words_of_the_page(proxied)); });
  }

  void serve_people() {
    site.on("POST", "/api/sign-in", [this](const Call& c) { return sign_in(c); });
    site.on("POST", "/api/sign-in/proxy", [this](const Call& c) { return sign_in_by_proxy(c); });
    site.on("POST", "/api/sign-out", [this](const Call& c) {
      site.sign_ins().end(c.cookie);
      Reply reply = json_reply(json::object());
      reply.fields.emplace_back("Set-Cookie", cookie_field("", 0));
      return reply;
    });
    site.on("GET", "/api/me", [this](const Call& c) { return me(*c.by); });
  }

  Reply me(const SignedIn& who) const {
    json may = json::array();
    for (const Door& d : doors())
      if (d.asks == Asks::person && d.lets(who.account.role)) may.push_back(fmt::format("{} {}", d.method, d.path));
    return json_reply({{"name", who.account.name},
                       {"role", name_of(who.account.role)},
                       {"token", who.token},
                       {"may", may},
                       {"school", desk.school()},
                       {"rehearsal", rehearsal},
                       {"second_factor", !who.account.code_secret.empty()}});
  }

  Reply sign_in(const Call& call) {
    const json asked = call.json();
    const std::string name = text_in(asked, "name"), key = call.head.address + " " + name;
    const std::int64_t now = steady_s();
    if (!tries.allow(call.head.address, k_tries_of_an_address, now) || !tries.allow(key, k_tries_of_a_name, now))
      return error_reply(429, "too many tries: wait a minute");
    const auto account = accounts.sign_in(name, text_in(asked, "password"));
    if (!account) return error_reply(401, "name and password do not belong together");
    tries.forget(key);
    return signed_in(*account, now, "");
  }

  /// Who the proxy says it is, where that is an account here: its role is the account's.
  Reply sign_in_by_proxy(const Call& call) {
    if (!proxied) return error_reply(404, "there is nothing here");
    if (call.proxied_as.empty()) return error_reply(401, "the school's sign-on says nobody: come by its address");
    const std::int64_t now = steady_s();
    if (!tries.allow("proxy " + call.proxied_as, k_tries_of_an_address, now)) return error_reply(429, "too many tries: wait a minute");
    const auto account = accounts.called(call.proxied_as);
    if (!account) return error_reply(403, "the school's sign-on knows you, and this office has no account for you: ask who runs it");
    return signed_in(*account, now, call.proxied_as);
  }

  Reply signed_in(const Account& account, std::int64_t now, const std::string& proxied_as) {
    const std::string cookie = site.sign_ins().begin(account, now, proxied_as);
    Reply reply = me(*site.sign_ins().of(cookie, now));
    reply.fields.emplace_back("Set-Cookie", cookie_field(cookie, k_absolute_end_s));
    return reply;
  }

  void serve_desk() {
    const auto get = [this](const char* path, auto say) { site.on("GET", path, [say](const Call& c) { return json_reply(say(c)); }); };
    const auto post = [this](const char* path, auto act) {
      site.on("POST", path, [this, act](const Call& c) {
        Reply reply = json_reply(act(c.json(), c.by->account));
        board.touch();
        lti.nudge();
        return reply;
      });
    };
    get("/api/exams", [this](const Call&) { return desk.exams(); });
    site.on("POST", "/api/roster/preview", [this](const Call& c) { return json_reply(desk.preview(c.json())); });
    post("/api/roster/issue", [this](const json& asked, const Account& by) { return desk.issue(asked, by); });
    get("/api/tickets", [this](const Call& c) { return desk.tickets(c.by->account.role == Role::officer, board.candidates()); });
    post("/api/tickets/cancel", [this](const json& asked, const Account& by) { return desk.cancel(asked, by, board.candidates()); });
    post("/api/tickets/makeup", [this](const json& asked, const Account& by) { return desk.make_up(asked, by); });
    get("/api/board", [this](const Call&) { return desk.board(board, inbox); });
    site.on("GET", "/api/board/events", [this](const Call& c) {
      return events(
          c, [this](std::uint64_t seen) { return board.wait(seen, k_patience_ms); }, [this] { return desk.board(board, inbox); }, true);
    });
    post("/api/stations/invite", [this](const json& asked, const Account& by) { return desk.invite(asked, by); });
    post("/api/stations/revoke", [this](const json& asked, const Account& by) { return desk.revoke(asked, by); });
    post("/api/stations/room", [this](const json& asked, const Account& by) { return desk.place(asked, by); });
    post("/api/seats", [this](const json& asked, const Account& by) { return desk.seat(asked, by); });
    get("/api/attendance", [this](const Call&) { return desk.attendance(board); });
    post("/api/announce", [this](const json& asked, const Account& by) { return desk.announce(asked, by); });
    post("/api/hold", [this](const json& asked, const Account& by) { return desk.hold(asked, by); });
    post("/api/go-on", [this](const json& asked, const Account& by) { return desk.go_on(asked, by); });
    get("/api/incidents", [this](const Call&) { return desk.incidents(); });
    post("/api/incidents", [this](const json& asked, const Account& by) { return desk.note_incident(asked, by); });
    get("/api/queue", [this](const Call&) { return desk.queue(); });
    post("/api/decide", [this](const json& asked, const Account& by) { return desk.decide(asked, by); });
    get("/api/results", [this](const Call& c) { return desk.results(c.by->account.role == Role::officer); });
    post("/api/release", [this](const json& asked, const Account& by) {
      require_code(text_in(asked, "code"), by);
      return desk.release(asked, by);
    });
    post("/api/retract", [this](const json& asked, const Account& by) {
      require_code(text_in(asked, "code"), by);
      return desk.retract(asked, by);
    });
    serve_regrades();
    get("/api/appeals", [this](const Call&) { return desk.appeals(); });
    post("/api/appeals/open", [this](const json& asked, const Account& by) { return desk.open_appeal(asked, by); });
    post("/api/appeals/answer", [this](const json& asked, const Account& by) { return desk.answer_appeal(asked, by); });
    site.on("POST", "/api/trail", [this](const Call& c) { return json_reply(desk.trail(c.json(), c.by->account.role == Role::officer)); });
    site.on("GET", "/api/report/*", [this](const Call& c) { return reports.of(desk.recording(c.tail)); });
    const auto paper = [this](const char* path, const char* file, const char* type, auto make) {
      site.on("GET", path, [file, type, make](const Call&) {
        Reply reply{200, type, make()};
        reply.fields.emplace_back("Content-Disposition", fmt::format("attachment; filename=\"{}\"", file));
        return reply;
      });
    };
    static constexpr char k_csv[] = "text/csv; charset=utf-8", k_pdf[] = "application/pdf";
    paper("/api/gradebook.csv", "gradebook.csv", k_csv, [this] { return desk.gradebook(rehearsal); });
    paper("/api/criteria.csv", "criteria.csv", k_csv, [this] { return desk.criteria(); });
    paper("/api/cards.pdf", "cards.pdf", k_pdf, [this] { return desk.cards(); });
    paper("/api/sign-in-sheet.pdf", "sign-in-sheet.pdf", k_pdf, [this] { return desk.sign_in_sheet(); });
  }

  /// A new rubric over all of an exam.
  void serve_regrades() {
    const auto post = [this](const char* path, auto act) {
      site.on("POST", path, [act](const Call& c) { return json_reply(act(c.json(), c.by->account)); });
    };
    site.on("GET", "/api/regrade", [this](const Call&) {
      json state = regrades.state(true);
      state["exams"] = desk.filed_exams();
      return json_reply(state);
    });
    site.on("GET", "/api/regrade/events", [this](const Call& c) {
      return events(
          c, [this](std::uint64_t seen) { return regrades.wait(seen, k_patience_ms); }, [this] { return regrades.state(false); });
    });
    post("/api/regrade/begin", [this](const json& asked, const Account& by) { return regrades.begin(asked, by); });
    post("/api/regrade/drop", [this](const json& asked, const Account& by) { return regrades.drop(asked, by); });
    post("/api/regrade/count", [this](const json& asked, const Account& by) {
      regrades.require_ready(asked, by);  // before a code is used up for nothing
      static_cast<void>(reason_in(asked));
      require_code(text_in(asked, "code"), by);
      return regrades.count(asked, by);
    });
  }

  /// What `say` says whenever `wait` gives another number, four times a second at most; after a silence a comment, so that a line that is dead is
  /// noticed, or, with `by_time`, what `say` says then: tickets run out by the clock alone.
  [[nodiscard]] Reply events(const Call& call, std::function<std::uint64_t(std::uint64_t seen)> wait, std::function<json()> say,
                             bool by_time = false) {
    Reply reply{200, "text/event-stream"};
    reply.events = [this, call, by_time, wait = std::move(wait), say = std::move(say)](const WriteEvent& write) {
      std::uint64_t seen = 0;
      std::int64_t spoken_s = steady_s();
      while (site.still(call)) {
        const std::uint64_t now = wait(seen);
        if (now != seen) {
          seen = now;
          spoken_s = steady_s();
          if (!write("data: " + json_reply(say()).body + "\n\n")) return;
          std::this_thread::sleep_for(k_between_events);
        } else if (steady_s() - spoken_s >= k_silence_s) {
          spoken_s = steady_s();
          if (!write(by_time ? "data: " + json_reply(say()).body + "\n\n" : std::string(":\n\n"))) return;
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
      throw Error("this", "needs a second factor, and this account has none",
                  fmt::format("cavum serve --add-account NAME --role {} --second-factor", name_of(by.role)));
    if (!tries.allow("code " + by.name, k_tries_of_a_code, steady_s())) throw Error("the code", "was tried too often", "wait a minute");
    const auto counter = counter_of_code(from_base32(by.code_secret).value_or(Bytes()), code, utc_now_ns() / 1'000'000'000);
    if (!counter) throw Error("the code", "is not good", "type the one that the app shows now");
    if (!used_codes.use(by.name, *counter))
      throw Error("the code", "was used already: wait for the next one", "the app shows another one within 30 s");
  }

  void serve_stations() {
    site.on("GET", "/station/hello", [this](const Call&) {
      return json_reply({{"ledger", desk.ledger_id()}, {"public_key", desk.public_key()}, {"utc_ns", utc_now_ns()}});
    });
    site.on("POST", "/station/enrol", [this](const Call& c) {
      if (!tries.allow("enrol " + c.head.address, k_tries_of_enrolment, steady_s())) return error_reply(429, "too many tries: wait a minute");
      Reply reply = json_reply(desk.enrol(c.body));
      tries.forget("enrol " + c.head.address);
      board.touch();
      return reply;
    });
    site.on("GET", "/station/tickets", [this](const Call&) { return json_reply(desk.station_tickets()); });
    site.on("POST", "/station/begin", [this](const Call& c) {
      const json asked = c.json();
      try {
        Reply reply = json_reply(desk.begin(asked, c.station));
        board.touch();
        return reply;
      } catch (const Error&) {
        if (const std::string candidate = desk.candidate_of(text_in(asked, "ticket")); !candidate.empty()) board.refused(c.station, candidate);
        throw;
      }
    });
    site.on("POST", "/station/report", [this](const Call& c) {
      const StationReport report = parse_report(c.body);
      board.report(c.station, report, utc_now_ns());
      return json_reply(desk.word_for(c.station, report.heard, board.since_utc_ns(c.station)));
    });
    site.on("GET", "/station/pieces/*", [this](const Call& c) { return said_of(pieces.have(c.station, c.tail)); });
    site.on("PUT", "/station/pieces/*", [this](const Call& c) {
      const auto place = place_in(c.head.query);
      if (!place) return error_reply(400, "say where the piece stands: ?at=0&of=1000");
      return said_of(pieces.add(c.station, c.tail, place->first, place->second, c.body), true);
    });
    site.on_parts("PUT", "/station/sessions/*", [this](const Call& c) { return std::make_unique<TakesSession>(inbox, c.tail, c.station); });
    site.on("GET", "/station/sessions/*", [this](const Call& c) { return handed(c.tail); });
  }

  /// 409: the piece was not the next one.
  static Reply said_of(const Pieces::Have& h, bool after_a_piece = false) {
    if (h.whole) return json_reply({{"state", "waiting"}}, 202);
    return json_reply({{"have", h.have}, {"of", h.of}}, after_a_piece && !h.taken ? 409 : 200);
  }

  Reply handed(const std::string& sha256) {
    if (const auto entry = desk.filed(sha256)) return json_reply({{"state", "filed"}, {"entry", *entry}, {"receipt", desk.receipt(*entry)}});
    const Handed h = inbox.of(sha256);
    if (h.state == Handed::State::refused) return json_reply({{"state", "refused"}, {"findings", h.findings}});
    return json_reply({{"state", h.state == Handed::State::unknown ? "unknown" : "waiting"}});
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
