#include "ui/office/lti_office.h"

#include <fmt/core.h>

#include <algorithm>
#include <chrono>

#include "engine/base/error.h"
#include "engine/base/hash.h"
#include "engine/base/json_fields.h"
#include "engine/base/text.h"
#include "engine/session/session.h"
#include "ui/language/language.h"
#include "ui/language/say.h"

namespace cavum::office {
namespace {

constexpr std::int64_t k_visit_s = 3600;
constexpr std::size_t k_max_visits = 5000, k_cookie_bytes = 32;
constexpr char k_login_cookie[] = "__Host-cavum-login";

std::int64_t clock_s() {
  return std::chrono::duration_cast<std::chrono::seconds>(
             std::chrono::steady_clock::now().time_since_epoch())
      .count();
}
std::int64_t utc_s() { return read_clocks().utc_ns / 1'000'000'000; }

std::string lti_page(const std::string& title, const std::string& body) {
  return fmt::format(
      "<!DOCTYPE html>\n<html lang=\"{}\"><head><meta charset=\"utf-8\"><meta name=\"viewport\" content=\"width=device-width\">"
      "<title>{}</title><link rel=\"stylesheet\" href=\"{}\"></head><body><main><h1>{}</h1>{}</main></body></html>\n",
      language(), xml_text(title), route::page_style::row.path, xml_text(title), body);
}
std::string paragraph(const std::string& text) { return "<p>" + xml_text(text) + "</p>"; }

/// It opens in a window of its own, where cookies of this office are no third party's.
std::string in_a_window(const std::string& fields) {
  return paragraph(tr(
             "Cavum opens in a window of its own: inside the platform's page, browsers keep no sign-in.")) +
         "<p><a target=\"_blank\" rel=\"noopener\" href=\"" + std::string(k_lti_login) + "?" +
         xml_text(fields) + "\">" + xml_text(tr("Open Cavum in a new window")) + "</a></p>";
}

bool is_framed(const Head& head) {
  const std::string where = head.field("sec-fetch-dest");
  return where == "iframe" || where == "frame" || where == "embed" || where == "object";
}

std::string cookie_to_keep(const char* name, const std::string& value, std::int64_t seconds,
                           const char* same_site) {
  return fmt::format("{}={}; Path=/; Max-Age={}; Secure; HttpOnly; SameSite={}", name, value,
                     seconds, same_site);
}

Reply go_to(int status, const std::string& address) {
  Reply reply{status, "text/html; charset=utf-8", ""};
  reply.fields.emplace_back("Location", address);
  return reply;
}

std::string verdict_in_words(grading::Verdict v) {
  return v == grading::Verdict::pass   ? tr("passed")
         : v == grading::Verdict::fail ? tr("failed")
                                       : tr("a person decides");
}

}  // namespace

LtiOffice::LtiOffice(Desk& desk, const std::string& home, Reports::Make report,
                     std::function<std::optional<Account>(const std::string&)> account,
                     std::function<std::string(const Account&)> begin_sign_in)
    : desk_(desk),
      platforms_(home + "/platforms.json"),
      courses_(home + "/" + desk.ledger_id() + "/courses.json"),
      reports_(std::move(report)),
      account_(std::move(account)),
      begin_sign_in_(std::move(begin_sign_in)),
      sender_(desk, platforms_, courses_) {}

template <class Say>
Reply LtiOffice::as_page(const Say& say) const {
  try {
    return say();
  } catch (const Error& wrong) {
    return framed(400,
                  lti_page(tr("Cavum cannot be opened"), paragraph(one_line(tr(wrong.message())))));
  }
}

Reply LtiOffice::answer(route::lti_keys, const Call&) {
  return json_reply(public_key_set(platforms_.keys()));
}
Reply LtiOffice::answer(route::lti_login, const Call& c) {
  return as_page([&] { return login(c, c.head.query); });
}
Reply LtiOffice::answer(route::lti_login_form, const Call& c) {
  return as_page([&] { return login(c, c.body); });
}
Reply LtiOffice::answer(route::lti_launch, const Call& c) {
  return as_page([&] { return launch(c); });
}
Reply LtiOffice::answer(route::own_results, const Call& c) {
  return as_page([&] { return own_results(c); });
}
Reply LtiOffice::answer(route::own_report, const Call& c) {
  return as_page([&] {
    const auto visit = visit_of(c.cookie);
    return reports_.of(desk_.own_recording(visit ? visit->id : "", c.tail));
  });
}

LtiSetUp LtiOffice::answer(route::set_platform, const SetPlatform& asked, const Call& c) {
  platforms_.set(sound_platform(asked.platform));
  return answer(route::lti(), c);
}

LtiSetUp LtiOffice::answer(route::remove_platform, const RemovePlatform& asked, const Call& c) {
  platforms_.remove(asked.issuer, asked.client_id);
  courses_.remove(asked.issuer, asked.client_id);
  return answer(route::lti(), c);
}

LtiSetUp LtiOffice::answer(route::link_person, const LinkPerson& asked, const Call& c) {
  if (!asked.account.empty() && !account_(asked.account))
    throw Error(msg("account {}", one_line(asked.account)), msg("is not there"),
                msg("see `cavum serve --accounts`"));
  platforms_.link(asked.issuer, asked.client_id, asked.sub, asked.account);
  return answer(route::lti(), c);
}

LtiSetUp LtiOffice::answer(route::new_key, const WithCode&, const Call& c) {
  platforms_.rotate();
  return answer(route::lti(), c);
}

Nothing LtiOffice::answer(route::send_scores, const Call&) {
  sender_.send_again();
  return {};
}

Reply LtiOffice::framed(int status, const std::string& html) const {
  std::string places;
  for (const auto& p : platforms_.all())
    for (const std::string& origin : {origin_of(p.issuer), origin_of(p.auth_endpoint)})
      if (places.find(origin + " ") == std::string::npos) places += origin + " ";
  Reply reply{status, "text/html; charset=utf-8", html};
  reply.fields.emplace_back(
      "Content-Security-Policy",
      "default-src 'none'; style-src 'self'; form-action 'none'; base-uri 'none'; frame-ancestors " +
          (places.empty() ? "'none'" : places));
  return reply;
}

Reply LtiOffice::login(const Call& call, const std::string& fields) {
  const LtiLogin answer = logins_.begin(platforms_, form_fields(fields), utc_s());
  if (is_framed(call.head)) return framed(200, lti_page("Cavum", in_a_window(fields)));
  Reply reply = go_to(302, answer.address);
  // the platform's page sends it back by a form, which only a cookie of SameSite=None goes with
  reply.fields.emplace_back("Set-Cookie",
                            cookie_to_keep(k_login_cookie, answer.cookie, k_login_s, "None"));
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
      account = Account{
          come.platform.name + "\t" + (come.name.empty() ? come.sub : come.name) + "\t" + come.sub,
          Role::reader, "", ""};
      const std::lock_guard guard(lock_);
      if (teaching_.size() >= k_max_visits) teaching_.clear();
      teaching_[account->name] = {*account, come.platform.issuer, come.platform.client_id};
    }
    Reply reply = go_to(303, route::page::row.path_of());
    reply.fields.emplace_back("Set-Cookie", begin_sign_in_(*account));
    return reply;
  }
  const std::string cookie = records::random_hex(k_cookie_bytes);
  {
    const std::lock_guard guard(lock_);
    const std::int64_t now = clock_s();
    std::erase_if(visits_, [&](const auto& one) { return now - one.second.since_s > k_visit_s; });
    if (visits_.size() >= k_max_visits)
      visits_.erase(std::min_element(
          visits_.begin(), visits_.end(),
          [](const auto& a, const auto& b) { return a.second.since_s < b.second.since_s; }));
    visits_[to_hex(sha256(cookie))] = {
        come.id, come.name, come.exam, come.platform.issuer, come.platform.client_id, now};
  }
  Reply reply = go_to(303, route::own_results::row.path_of());
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
  return platforms_.of(found->issuer, found->client_id) ? std::optional(found->account)
                                                        : std::nullopt;
}

Reply LtiOffice::own_results(const Call& call) {
  const auto visit = visit_of(call.cookie);
  if (!visit) return error_reply(401, msg("nobody has come"));
  std::string body = visit->name.empty() ? "" : paragraph(visit->name);
  if (visit->id.empty()) {
    body += paragraph(tr("The platform does not tell this office who you are. Ask your school."));
  } else if (const auto results = desk_.own_results(visit->id, visit->exam); results.empty()) {
    body += paragraph(tr("There is no result of yours that was released."));
  } else {
    body += "<ul>";
    for (const OwnResult& r : results) {
      const std::string text = tr("{}: {}, {} of {} points, released {}", as_is(r.exam),
                                  as_is(verdict_in_words(r.verdict)), as_points(r.points),
                                  as_number(r.max), as_is(r.released));
      body += "<li>" + xml_text(text);
      if (r.simulated) body += ". " + xml_text(tr("A rehearsal: no student sat this."));
      if (!r.counts) body += ". " + xml_text(tr("A later attempt counts."));
      if (!r.sha256.empty())
        body += " <a href=\"" + route::own_report::row.path_of(r.sha256) + "\">" +
                xml_text(tr("Report")) + "</a>";
      body += "</li>";
    }
    body += "</ul>";
  }
  return {200, "text/html; charset=utf-8", lti_page(tr("Your results"), body)};
}

LtiSetUp LtiOffice::answer(route::lti, const Call&) {
  LtiSetUp out{{}, {}, sender_.progress()};
  for (const auto& p : platforms_.all()) out.platforms.push_back({p, addresses_for(p)});
  for (const auto& k : platforms_.keys()) out.keys.push_back({k.kid, utc_text(k.made_utc_ns)});
  return out;
}

}  // namespace cavum::office
