#include "ui/office/lti_sender.h"

#include <fmt/core.h>

#include <algorithm>
#include <regex>
#include <set>

#include "engine/base/error.h"
#include "engine/base/json_fields.h"
#include "engine/base/message_from.h"
#include "engine/base/text.h"
#include "engine/session/session.h"
#include "grading/records/passback.h"
#include "ui/language/say.h"

namespace cavum::office {
namespace {

using nlohmann::json;
using Steady = std::chrono::steady_clock;

constexpr auto k_look = std::chrono::seconds(5), k_first_pause = std::chrono::seconds(60),
               k_longest_pause = std::chrono::seconds(3600),
               k_before_end = std::chrono::seconds(30);
constexpr std::int64_t k_assertion_s = 60;
constexpr int k_max_pages = 20;
constexpr std::size_t k_jti_bytes = 16;
constexpr char k_line_scope[] = "https://purl.imsglobal.org/spec/lti-ags/scope/lineitem",
               k_score_scope[] = "https://purl.imsglobal.org/spec/lti-ags/scope/score",
               k_tag[] = "cavum";
constexpr char k_item_type[] = "application/vnd.ims.lis.v2.lineitem+json",
               k_items_type[] = "application/vnd.ims.lis.v2.lineitemcontainer+json",
               k_score_type[] = "application/vnd.ims.lis.v1.score+json";

bool allows(const LtiCourse& c, const char* scope) {
  return std::find(c.scopes.begin(), c.scopes.end(), scope) != c.scopes.end();
}
std::string scopes_of(const LtiCourse& c) {
  return allows(c, k_line_scope) ? fmt::format("{} {}", k_line_scope, k_score_scope)
                                 : std::string(k_score_scope);
}
std::string key_of(const LtiPlatform& p, const LtiCourse& c) {
  return p.issuer + "\n" + p.client_id + "\n" + c.context + "\n" + c.exam;
}

bool is_good(int status) { return status >= 200 && status <= 299; }
/// It may be otherwise later.
bool is_passing(int status) {
  return status >= 500 || status == 429 || status == 408 || (status >= 300 && status <= 399);
}

/// The platform's own words, if it has any.
std::string words_of(const PlatformAnswer& answer) {
  for (const char* name : {"error_description", "error", "message", "detail"})
    if (const std::string text = text_in(answer.body, name); !text.empty()) return one_line(text);
  return "";
}

/// `more` goes into the path: an address may have a query.
std::string below(const std::string& address, const std::string& more) {
  const auto question = std::min(address.find('?'), address.size());
  return address.substr(0, question) + more + address.substr(question);
}
std::string asked_for(const std::string& address, const std::string& query) {
  return address + (address.find('?') == std::string::npos ? "?" : "&") + query;
}

/// Of `Link: <https://…>; rel="next"`; empty: there is no other page.
std::string next_page(const std::string& link) {
  static const std::regex k_next(R"re(<([^<>]*)>\s*;\s*rel="?next"?)re");
  std::smatch found;
  return std::regex_search(link, found, k_next) ? found[1].str() : "";
}

}  // namespace

LtiSender::LtiSender(Desk& desk, LtiPlatforms& platforms, LtiCourses& courses)
    : desk_(desk), platforms_(platforms), courses_(courses), thread_([this] { run(); }) {}

LtiSender::~LtiSender() {
  {
    const std::lock_guard guard(lock_);
    ends_ = true;
  }
  wake_.notify_all();
  thread_.join();
}

void LtiSender::nudge() {
  {
    const std::lock_guard guard(lock_);
    nudged_ = true;
  }
  wake_.notify_all();
}

void LtiSender::send_again() {
  {
    const std::lock_guard guard(lock_);
    nudged_ = again_ = true;
    for (auto& [key, trouble] : troubles_) trouble.next = Steady::now();
  }
  wake_.notify_all();
}

void LtiSender::run() {
  while (!ends_) {
    bool asked = false, again = false;
    {
      std::unique_lock guard(lock_);
      wake_.wait_for(guard, k_look, [&] { return nudged_ || ends_; });
      asked = nudged_;
      again = again_;
      nudged_ = again_ = false;
    }
    if (ends_) return;
    try {
      round(asked, again);
    } catch (
        const std::exception&) {  // a file that cannot be read: whoever looks at the page is told
    }
  }
}

void LtiSender::round(bool asked, bool again) {
  const std::size_t entries = desk_.entries();
  {
    const std::lock_guard guard(lock_);
    const bool tries = std::any_of(troubles_.begin(), troubles_.end(), [](const auto& one) {
      return Steady::now() >= one.second.next;
    });
    if (!asked && !tries && entries == seen_entries_) return;
  }
  seen_entries_ = entries;
  const std::vector<LtiCourse> courses = courses_.all();
  if (courses.empty()) {
    const std::lock_guard guard(lock_);
    troubles_.clear();
    return;
  }
  const std::vector<LtiPlatform> platforms = platforms_.all();
  const auto known = desk_.numbers();
  courses_.keep_only([&](const std::string& id) { return known.contains(id); });
  std::set<std::string> here;
  for (const LtiCourse& course : courses) {
    const auto platform =
        std::find_if(platforms.begin(), platforms.end(),
                     [&](const LtiPlatform& p) { return p.is(course.issuer, course.client_id); });
    if (platform == platforms.end() || ends_) continue;
    const std::string key = key_of(*platform, course);
    here.insert(key);
    {
      const std::lock_guard guard(lock_);
      if (const auto found = troubles_.find(key);
          found != troubles_.end() && Steady::now() < found->second.next)
        continue;
    }
    try {
      send(*platform, course, again);
      const std::lock_guard guard(lock_);
      troubles_.erase(key);
    } catch (const std::exception& wrong) {
      const std::lock_guard guard(lock_);
      Trouble& trouble = troubles_[key];
      trouble.what = message_from(wrong);
      trouble.pause = std::clamp(trouble.pause * 2, std::chrono::seconds(k_first_pause),
                                 std::chrono::seconds(k_longest_pause));
      trouble.next = Steady::now() + trouble.pause;
    }
  }
  const std::lock_guard guard(lock_);
  std::erase_if(troubles_, [&](const auto& one) {
    return !here.contains(one.first);
  });  // of platforms that were removed
}

void LtiSender::send(const LtiPlatform& platform, const LtiCourse& course, bool again) {
  std::string item = course.item;
  std::vector<records::ScoreDue> due = desk_.scores_due(course.exam, item, again);
  const std::vector<LtiCourse> all = courses_.all();
  std::erase_if(due, [&](const records::ScoreDue& d) {
    return user_in(course, all, platform.claim, d.id).empty();
  });
  if (due.empty()) return;
  if (!allows(course, k_score_scope))
    throw Error(course.title, msg("its platform lets this tool send no scores"),
                msg("allow it in the tool's settings there"));
  if (item.empty()) {
    double maximum = 0;
    for (const auto& d : due) maximum = std::max(maximum, d.score.value("scoreMaximum", 0.0));
    item = item_of(platform, course, maximum);
    courses_.set_item(course, item);
    due = desk_.scores_due(course.exam, item, again);  // another course may have sent to it before
  }
  for (const records::ScoreDue& d : due) {
    if (ends_) return;
    json score = d.score;
    score["userId"] = user_in(course, all, platform.claim, d.id);
    if (score["userId"] == "") continue;
    const PlatformAnswer answer = ask(platform, course, "POST", below(item, "/scores"),
                                      {{"Content-Type", k_score_type}}, score.dump());
    if (is_passing(answer.status))
      throw PlatformUnreachable(origin_of(item),
                                msg("answers {} {}", answer.status, words_of(answer)),
                                msg("it is tried again later"));
    desk_.enter_passback(d, platform.issuer, item, answer.status, words_of(answer));
  }
}

PlatformAnswer LtiSender::ask(const LtiPlatform& platform, const LtiCourse& course,
                              const std::string& method, const std::string& address,
                              const std::map<std::string, std::string>& fields,
                              const std::string& body) {
  PlatformAnswer answer;
  for (int tries = 0; tries < 2; ++tries) {
    auto all = fields;
    all["Authorization"] = "Bearer " + token_of(platform, course);
    answer = ask_platform(platform, method, address, all, body, &ends_);
    if (answer.status != 401) break;
    tokens_.clear();  // it has ended before its time
  }
  if (answer.status == 401)
    throw PlatformUnreachable(origin_of(address), msg("takes none of its own tokens (401)"),
                              msg("look at the tool's settings there"));
  return answer;
}

std::string LtiSender::token_of(const LtiPlatform& platform, const LtiCourse& course) {
  Token& token = tokens_[platform.issuer + "\n" + platform.client_id + "\n" + scopes_of(course)];
  if (!token.text.empty() && Steady::now() < token.until) return token.text;
  const std::int64_t now_s = read_clocks().utc_ns / 1'000'000'000;
  const json claims = {
      {"iss", platform.client_id},
      {"sub", platform.client_id},
      {"aud", platform.token_audience.empty() ? platform.token_endpoint : platform.token_audience},
      {"iat", now_s},
      {"exp", now_s + k_assertion_s},
      {"jti", records::random_hex(k_jti_bytes)}};
  const std::string body =
      "grant_type=client_credentials&client_assertion_type=" +
      url_encoded("urn:ietf:params:oauth:client-assertion-type:jwt-bearer") +
      "&client_assertion=" + url_encoded(sign_token(claims, platforms_.keys().front())) +
      "&scope=" + url_encoded(scopes_of(course));
  const PlatformAnswer answer = ask_platform(
      platform, "POST", platform.token_endpoint,
      {{"Content-Type", "application/x-www-form-urlencoded"}, {"Accept", "application/json"}}, body,
      &ends_);
  const std::string text = text_in(answer.body, "access_token");
  if (!is_good(answer.status) || text.empty() ||
      text.find_first_not_of(
          "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789-._~+/=") !=
          std::string::npos)
    throw PlatformUnreachable(origin_of(platform.token_endpoint),
                              msg("gives no token: {} {}", answer.status, words_of(answer)),
                              msg("look at client id and key set there; it is tried again later"));
  const std::int64_t lasts_s =
      std::clamp<std::int64_t>(whole_in(answer.body, "expires_in"), 0, 3600);
  token = {text, Steady::now() + std::chrono::seconds(lasts_s) - k_before_end};
  return token.text;
}

std::string LtiSender::item_of(const LtiPlatform& platform, const LtiCourse& course,
                               double maximum) {
  if (!allows(course, k_line_scope) || course.lineitems.empty())
    throw Error(course.title,
                msg("its platform has no column for this link, and lets this tool make none"),
                msg("let the link have a grade there"));
  std::string page =
      asked_for(course.lineitems, "resource_id=" + url_encoded(course.exam) + "&tag=" + k_tag);
  for (int i = 0; i < k_max_pages && !page.empty(); ++i) {
    const PlatformAnswer answer = ask(platform, course, "GET", page, {{"Accept", k_items_type}});
    if (answer.status != 200 || !answer.body.is_array())
      throw PlatformUnreachable(
          origin_of(page), msg("does not show its columns: {} {}", answer.status, words_of(answer)),
          msg("it is tried again later"));
    for (const json& one : answer.body)  // a platform may pass over what was asked for
      if (text_in(one, "resourceId") == course.exam && text_in(one, "tag") == k_tag &&
          platform.may_ask(text_in(one, "id")))
        return text_in(one, "id");
    page = next_page(answer.link);
  }
  if (maximum <= 0)
    throw Error(course.title, msg("has no result with points yet"),
                msg("its column is made with the first"));
  const json wanted = {{"label", "Cavum " + course.exam},
                       {"scoreMaximum", maximum},
                       {"resourceId", course.exam},
                       {"tag", k_tag}};
  const PlatformAnswer made =
      ask(platform, course, "POST", course.lineitems,
          {{"Content-Type", k_item_type}, {"Accept", k_item_type}}, wanted.dump());
  const std::string id = text_in(made.body, "id");
  if (!is_good(made.status) || !platform.may_ask(id))
    throw PlatformUnreachable(origin_of(course.lineitems),
                              msg("makes no column: {} {}", made.status, words_of(made)),
                              msg("it is tried again later"));
  return id;
}

std::vector<ScoresOfCourse> LtiSender::progress() {
  std::vector<ScoresOfCourse> out;
  const std::vector<LtiPlatform> platforms = platforms_.all();
  const std::vector<LtiCourse> courses = courses_.all();
  for (const LtiCourse& c : courses) {
    const auto p = std::find_if(platforms.begin(), platforms.end(), [&](const LtiPlatform& one) {
      return one.is(c.issuer, c.client_id);
    });
    if (p == platforms.end()) continue;
    int waiting = 0, unknown = 0;
    for (const auto& d : desk_.scores_due(c.exam, c.item, false))
      ++(user_in(c, courses, p->claim, d.id).empty() ? unknown : waiting);
    const auto [sent, refused] = c.item.empty() ? std::pair{0, 0} : desk_.passbacks(c.item);
    std::string trouble;
    {
      const std::lock_guard guard(lock_);
      if (const auto found = troubles_.find(key_of(*p, c)); found != troubles_.end())
        trouble = one_line(tr(found->second.what));
    }
    out.push_back({p->name, c.title, c.exam, c.item, sent, refused, waiting, unknown, trouble});
  }
  return out;
}

}  // namespace cavum::office
