#include "ui/office/lti_office.h"

#include <fmt/core.h>

#include <algorithm>
#include <chrono>

#include "engine/base/error.h"
#include "engine/base/hash.h"
#include "engine/base/json_fields.h"
#include "engine/base/text.h"
#include "engine/language/language.h"
#include "engine/language/say.h"
#include "engine/language/shown.h"
#include "engine/session/session.h"

namespace cavum::office {
namespace {

using nlohmann::json;

constexpr std::int64_t k_visit_s = 3600;
constexpr std::size_t k_most_visits = 5000, k_cookie_bytes = 32;
constexpr char k_login_cookie[] = "__Host-cavum-login";

std::int64_t clock_s() { return std::chrono::duration_cast<std::chrono::seconds>(std::chrono::steady_clock::now().time_since_epoch()).count(); }
std::int64_t utc_s() { return read_clocks().utc_ns / 1'000'000'000; }

std::string lti_page(const std::string& title, const std::string& body) {
  return fmt::format(
      "<!DOCTYPE html>\n<html lang=\"{}\"><head><meta charset=\"utf-8\"><meta name=\"viewport\" content=\"width=device-width\">"
      "<title>{}</title><link rel=\"stylesheet\" href=\"/office.css\"></head><body><main><h1>{}</h1>{}</main></body></html>\n",
      language(), xml_text(title), xml_text(title), body);
}
std::string paragraph(const std::string& text) { return "<p>" + xml_text(text) + "</p>"; }

/// It opens in a window of its own, where cookies of this office are no third party's.
std::string in_a_window(const std::string& fields) {
  return paragraph(tr("Cavum opens in a window of its own: inside the platform's page, browsers keep no sign-in.")) +
         "<p><a target=\"_blank\" rel=\"noopener\" href=\"/lti/login?" + xml_text(fields) + "\">" + xml_text(tr("Open Cavum in a new window")) +
         "</a></p>";
}

bool is_framed(const Head& head) {
  const std::string where = head.field("sec-fetch-dest");
  return where == "iframe" || where == "frame" || where == "embed" || where == "object";
}

std::string cookie_to_keep(const char* name, const std::string& value, std::int64_t seconds, const char* same_site) {
  return fmt::format("{}={}; Path=/; Max-Age={}; Secure; HttpOnly; SameSite={}", name, value, seconds, same_site);
}

Reply go_to(int status, const std::string& address) {
  Reply reply{status, "text/html; charset=utf-8", ""};
  reply.fields.emplace_back("Location", address);
  return reply;
}

std::string verdict_in_words(const std::string& verdict) {
  return verdict == "pass" ? tr("passed") : verdict == "fail" ? tr("failed") : verdict == "review" ? tr("a person decides") : shown(verdict);
}

}  // namespace

LtiOffice::LtiOffice(Desk& desk, const std::string& home, Reports::Make report, std::function<std::optional<Account>(const std::string&)> account)
    : desk_(desk),
      platforms_(home + "/platforms.json"),
      courses_(home + "/" + desk.ledger_id() + "/courses.json"),
      reports_(std::move(report)),
      account_(std::move(account)),
      sender_(desk, platforms_, courses_) {}

void LtiOffice::serve(Site& site, std::function<void(const std::string& code, const Account& by)> require_code,
                      std::function<std::string(const Account&)> begin_sign_in) {
  begin_sign_in_ = std::move(begin_sign_in);
  /// What is wrong, as a page.
  const auto as_page = [this](auto say) {
    return [this, say](const Call& call) {
      try {
        return say(call);
      } catch (const Error& wrong) {
        return framed(400, lti_page(tr("Cavum cannot be opened"), paragraph(shown(one_line(wrong.what())))));
      }
    };
  };
  site.on("GET", "/lti/jwks", [this](const Call&) { return json_reply(public_key_set(platforms_.keys())); });
  site.on("GET", "/lti/login", as_page([this](const Call& c) { return login(c, c.head.query); }));
  site.on("POST", "/lti/login", as_page([this](const Call& c) { return login(c, c.body); }));
  site.on("POST", "/lti/launch", as_page([this](const Call& c) { return launch(c); }));
  site.on("GET", "/lti/result", as_page([this](const Call& c) { return own_results(c); }));
  site.on("GET", "/lti/report/*", as_page([this](const Call& c) {
            const auto visit = visit_of(c.cookie);
            return reports_.of(desk_.own_recording(visit ? visit->id : "", c.tail));
          }));
  site.on("GET", "/api/lti", [this](const Call&) { return json_reply(shown_set_up()); });
  const auto change = [&](const char* path, auto act) {
    site.on("POST", path, [this, act, require_code](const Call& c) {
      const json asked = c.json();
      require_code(text_in(asked, "code"), c.by->account);
      act(asked);
      sender_.nudge();
      return json_reply(shown_set_up());
    });
  };
  change("/api/lti/set", [this](const json& asked) { platforms_.set(platform_in(member_of(asked, "platform"))); });
  change("/api/lti/remove", [this](const json& asked) {
    platforms_.remove(text_in(asked, "issuer"), text_in(asked, "client_id"));
    courses_.remove(text_in(asked, "issuer"), text_in(asked, "client_id"));
  });
  change("/api/lti/link", [this](const json& asked) {
    const std::string account = text_in(asked, "account");
    if (!account.empty() && !account_(account)) throw Error("account " + one_line(account), "is not there", "see `cavum serve --accounts`");
    platforms_.link(text_in(asked, "issuer"), text_in(asked, "client_id"), text_in(asked, "sub"), account);
  });
  change("/api/lti/new-key", [this](const json&) { platforms_.rotate(); });
  site.on("POST", "/api/lti/send", [this](const Call&) {
    sender_.send_again();
    return json_reply(json::object());
  });
}

Reply LtiOffice::framed(int status, const std::string& html) const {
  std::string places;
  for (const auto& p : platforms_.all())
    for (const std::string& origin : {origin_of(p.issuer), origin_of(p.auth_endpoint)})
      if (places.find(origin + " ") == std::string::npos) places += origin + " ";
  Reply reply{status, "text/html; charset=utf-8", html};
  reply.fields.emplace_back("Content-Security-Policy", "default-src 'none'; style-src 'self'; form-action 'none'; base-uri 'none'; frame-ancestors " +
                                                           (places.empty() ? "'none'" : places));
  return reply;
}

Reply LtiOffice::login(const Call& call, const std::string& fields) {
  const LtiLogin answer = logins_.begin(platforms_, form_fields(fields), utc_s());
  if (is_framed(call.head)) return framed(200, lti_page("Cavum", in_a_window(fields)));
  Reply reply = go_to(302, answer.address);
  // the platform's page sends it back by a form, which only a cookie of SameSite=None goes with
  reply.fields.emplace_back("Set-Cookie", cookie_to_keep(k_login_cookie, answer.cookie, k_login_s, "None"));
  return reply;
}

Reply LtiOffice::launch(const Call& call) {
  const LtiLaunch come = logins_.finish(
      platforms_, form_fields(call.body), cookie_named(call.head.field("cookie"), k_login_cookie),
      [this](const LtiPlatform& p, const std::string& kid) { return keys_.of(p, kid); }, utc_s());
  courses_.note(come);
  sender_.nudge();
  const std::string login_over = cookie_to_keep(k_login_cookie, "", 0, "None");
  if (come.teaches) {
    const auto linked = come.platform.accounts.find(come.sub);
    std::optional<Account> account;
    if (linked != come.platform.accounts.end()) account = account_(linked->second);
    if (!account) {  // a name that no account can have
      account = Account{come.platform.name + "\t" + (come.name.empty() ? come.sub : come.name) + "\t" + come.sub, Role::reader, "", ""};
      const std::lock_guard guard(lock_);
      if (teaching_.size() >= k_most_visits) teaching_.clear();
      teaching_[account->name] = {*account, come.platform.issuer, come.platform.client_id};
    }
    Reply reply = go_to(303, "/");
    reply.fields.emplace_back("Set-Cookie", begin_sign_in_(*account));
    return reply;
  }
  const std::string cookie = ledger::random_hex(k_cookie_bytes);
  {
    const std::lock_guard guard(lock_);
    const std::int64_t now = clock_s();
    std::erase_if(visits_, [&](const auto& one) { return now - one.second.since_s > k_visit_s; });
    if (visits_.size() >= k_most_visits)
      visits_.erase(
          std::min_element(visits_.begin(), visits_.end(), [](const auto& a, const auto& b) { return a.second.since_s < b.second.since_s; }));
    visits_[to_hex(sha256(cookie))] = {come.id, come.name, come.exam, come.platform.issuer, come.platform.client_id, now};
  }
  Reply reply = go_to(303, "/lti/result");
  reply.fields.emplace_back("Set-Cookie", cookie_to_keep(k_visit_cookie, cookie, k_visit_s, "Lax"));
  return reply;
}

std::optional<LtiVisit> LtiOffice::visit_of(const std::string& cookie) {
  std::optional<LtiVisit> found;
  {
    const std::lock_guard guard(lock_);
    const auto at = visits_.find(to_hex(sha256(cookie)));
    if (at == visits_.end() || clock_s() - at->second.since_s > k_visit_s) return std::nullopt;
    found = at->second;
  }
  return platforms_.of(found->issuer, found->client_id) ? found : std::nullopt;
}

std::optional<Account> LtiOffice::reader(const std::string& name) {
  std::optional<Teaching> found;
  {
    const std::lock_guard guard(lock_);
    const auto at = teaching_.find(name);
    if (at == teaching_.end()) return std::nullopt;
    found = at->second;
  }
  return platforms_.of(found->issuer, found->client_id) ? std::optional(found->account) : std::nullopt;
}

Reply LtiOffice::own_results(const Call& call) {
  const auto visit = visit_of(call.cookie);
  if (!visit) return error_reply(401, "nobody has come");
  std::string body = visit->name.empty() ? "" : paragraph(visit->name);
  if (visit->id.empty()) {
    body += paragraph(tr("The platform does not tell this office who you are. Ask your school."));
  } else if (const json results = desk_.own_results(visit->id, visit->exam); results.empty()) {
    body += paragraph(tr("There is no result of yours that was released."));
  } else {
    body += "<ul>";
    for (const json& r : results) {
      const std::string text = tr("{0}: {1}, {2} of {3} points, released {4}", as_is(text_in(r, "exam")), verdict_in_words(text_in(r, "verdict")),
                                  fixed(r["points"].get<double>(), 1), plain_number(r["max"].get<double>()), as_is(text_in(r, "released")));
      body += "<li>" + xml_text(text);
      if (r["simulated"] == true) body += ". " + xml_text(tr("A rehearsal: no student sat this."));
      if (r["counts"] == false) body += ". " + xml_text(tr("A later attempt counts."));
      if (const std::string hash = text_in(r, "sha256"); !hash.empty())
        body += " <a href=\"/lti/report/" + hash + "\">" + xml_text(tr("Report")) + "</a>";
      body += "</li>";
    }
    body += "</ul>";
  }
  return {200, "text/html; charset=utf-8", lti_page(tr("Your results"), body)};
}

json LtiOffice::shown_set_up() {
  json platforms = json::array(), keys = json::array();
  for (const auto& p : platforms_.all()) {
    json one = json_of(p);
    one["addresses"] = shown_addresses(p);
    platforms.push_back(std::move(one));
  }
  for (const auto& k : platforms_.keys()) keys.push_back({{"kid", k.kid}, {"made", utc_text(k.made_utc_ns)}});
  return {{"platforms", platforms}, {"keys", keys}, {"progress", sender_.progress()}};
}

}  // namespace cavum::office
