#include "ui/office/lti/launch.h"

#include <fmt/core.h>
#include <sodium.h>

#include <algorithm>

#include "engine/base/encoding.h"
#include "engine/base/error.h"
#include "engine/base/json_fields.h"
#include "engine/base/json_reader.h"
#include "engine/base/text.h"
#include "grading/records/ledger_key.h"
#include "ui/office/lti/lti_error.h"

namespace cavum::office {
namespace {

using nlohmann::json;

constexpr char k_claims[] = "https://purl.imsglobal.org/spec/lti/claim/";
constexpr char k_grades_claim[] = "https://purl.imsglobal.org/spec/lti-ags/claim/endpoint";
constexpr char k_membership[] = "http://purl.imsglobal.org/vocab/lis/v2/membership#";
constexpr std::size_t k_longest_sub = 255, k_max_used = 200'000, k_random_bytes = 32;

Error launch_error(LtiError code, const Message& what) {
  return {code, msg("this launch"), what,
          msg("open the link on the platform again; if it stays, tell the office")};
}

int digit_of(char c) {
  if (c >= '0' && c <= '9') return c - '0';
  if (c >= 'a' && c <= 'f') return c - 'a' + 10;
  if (c >= 'A' && c <= 'F') return c - 'A' + 10;
  return -1;
}

std::string url_decoded(std::string_view text) {
  std::string out;
  for (std::size_t i = 0; i < text.size(); ++i) {
    if (text[i] != '%') {
      out += text[i] == '+' ? ' ' : text[i];
      continue;
    }
    const int high = i + 2 < text.size() ? digit_of(text[i + 1]) : -1,
              low = i + 2 < text.size() ? digit_of(text[i + 2]) : -1;
    if (high < 0 || low < 0) throw launch_error(LtiError::not_understood, msg("is no form"));
    out += static_cast<char>(high * 16 + low);
    i += 2;
  }
  return out;
}

const json& claim_of(const json& claims, const char* name) {
  return member_of(claims, (std::string(k_claims) + name).c_str());
}

std::string field_in(const std::map<std::string, std::string>& fields, const char* name) {
  const auto found = fields.find(name);
  return found == fields.end() ? "" : found->second;
}

/// The token is for us alone.
bool is_audience(const json& claims, const std::string& client) {
  const json &aud = member_of(claims, "aud"), &azp = member_of(claims, "azp");
  const bool right = aud == client || (aud.is_array() && aud.size() == 1 && aud[0] == client);
  return right && (azp.is_null() || azp == client);
}

double seconds_in(const json& claims, const char* name) {
  const json& value = member_of(claims, name);
  if (!value.is_number())
    throw launch_error(LtiError::incomplete, msg("has a token without '{}'", name));
  return value.get<double>();
}

/// By the claim that was agreed on; a value that is no line of text counts as none.
std::string matched_id(const json& claims, const LtiPlatform& p) {
  if (p.claim == "sub") return text_in(claims, "sub");
  const auto dot = p.claim.find('.');
  const std::string id =
      text_in(claim_of(claims, p.claim.substr(0, dot).c_str()), p.claim.substr(dot + 1).c_str());
  return id.size() <= k_longest_sub && is_plain_text(id) && !id.starts_with('$')
             ? id
             : "";  // "$Person.sourcedId": the platform did not fill it in
}

/// One line of at most so many bytes, of what somebody else wrote.
std::string shortened(const std::string& text, std::size_t bytes = 200) {
  const std::string line = one_line(text).substr(0, bytes);
  return line.substr(0, whole_characters(line));
}

}  // namespace

std::map<std::string, std::string> form_fields(std::string_view text) {
  std::map<std::string, std::string> out;
  while (!text.empty()) {
    const auto end = std::min(text.find('&'), text.size());
    const std::string_view one = text.substr(0, end);
    const auto equals = std::min(one.find('='), one.size());
    const std::string name = url_decoded(one.substr(0, equals)),
                      value = url_decoded(one.substr(std::min(equals + 1, one.size())));
    if (!is_plain_text(name) || !is_plain_text(value))
      throw launch_error(LtiError::not_understood, msg("is no form"));
    if (!one.empty() && !out.emplace(name, value).second)
      throw launch_error(LtiError::twice, msg("says something twice"));
    text.remove_prefix(std::min(end + 1, text.size()));
  }
  return out;
}

std::string url_encoded(std::string_view text) {
  std::string out;
  for (const char c : text)
    if ((c >= '0' && c <= '9') || (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || c == '-' ||
        c == '.' || c == '_' || c == '~')
      out += c;
    else
      out += fmt::format("%{:02X}", static_cast<unsigned char>(c));
  return out;
}

LtiLogins::LtiLogins() : secret_(records::random_hex(k_random_bytes)) {}

/// text.seal
std::string LtiLogins::sealed(const std::string& text) const {
  unsigned char seal[crypto_auth_BYTES];
  static_assert(crypto_auth_KEYBYTES == k_random_bytes);
  const Bytes key = records::from_hex(secret_, k_random_bytes, msg("the secret"));
  crypto_auth(seal, reinterpret_cast<const unsigned char*>(text.data()), text.size(), key.data());
  return text + "." + to_base64(seal, Base64::in_address);
}

LtiLogin LtiLogins::begin(const LtiPlatforms& platforms,
                          const std::map<std::string, std::string>& fields,
                          std::int64_t now_s) const {
  const std::string issuer = field_in(fields, "iss"), client = field_in(fields, "client_id"),
                    hint = field_in(fields, "login_hint"),
                    target = field_in(fields, "target_link_uri"),
                    deployment = field_in(fields, "lti_deployment_id");
  if (issuer.empty() || hint.empty() || target.empty())
    throw launch_error(LtiError::incomplete, msg("does not say who comes, and from where"));
  std::vector<LtiPlatform> found = platforms.all();
  std::erase_if(found, [&](const LtiPlatform& p) {
    return p.issuer != issuer || (!client.empty() && p.client_id != client) ||
           (!deployment.empty() && std::find(p.deployments.begin(), p.deployments.end(),
                                             deployment) == p.deployments.end());
  });
  if (found.empty())
    throw launch_error(LtiError::platform,
                       msg("comes from a platform that this office does not know"));
  if (found.size() > 1)
    throw launch_error(LtiError::platform,
                       msg("does not say which of the platforms of its issuer it comes from"));
  const LtiPlatform& p = found.front();
  if (target != p.office + k_lti_launch)
    throw launch_error(LtiError::target, msg("leads to another place than this office"));
  const std::string state = records::random_hex(k_random_bytes),
                    nonce = records::random_hex(k_random_bytes);
  const json kept = {{"state", state},
                     {"nonce", nonce},
                     {"until", now_s + k_login_s},
                     {"iss", p.issuer},
                     {"client", p.client_id}};
  std::string address =
      p.auth_endpoint + (p.auth_endpoint.find('?') == std::string::npos ? "?" : "&");
  address += "scope=openid&response_type=id_token&response_mode=form_post&prompt=none&client_id=" +
             url_encoded(p.client_id) + "&redirect_uri=" + url_encoded(p.office + k_lti_launch) +
             "&login_hint=" + url_encoded(hint) + "&state=" + state + "&nonce=" + nonce;
  if (const std::string message = field_in(fields, "lti_message_hint"); !message.empty())
    address += "&lti_message_hint=" + url_encoded(message);
  return {address, sealed(to_base64url(kept.dump()))};
}

LtiLaunch LtiLogins::finish(const LtiPlatforms& platforms,
                            const std::map<std::string, std::string>& fields,
                            const std::string& cookie, const KeysOf& keys_of, std::int64_t now_s) {
  const std::string state = field_in(fields, "state");
  if (cookie.empty())
    throw launch_error(
        LtiError::login,
        msg("came back without the cookie of its login: this browser keeps none here, or another window began it"));
  const std::string text = cookie.substr(0, cookie.find('.')), right = sealed(text);
  if (right.size() != cookie.size() ||
      sodium_memcmp(right.data(), cookie.data(), right.size()) != 0)
    throw launch_error(LtiError::login, msg("has the cookie of no login of this office"));
  const json kept = parse_json_or_null(from_base64url(text).value_or(""));
  if (state.empty() || text_in(kept, "state") != state)
    throw launch_error(LtiError::login, msg("belongs to another login than this browser's"));
  if (whole_in(kept, "until") < now_s) throw launch_error(LtiError::too_late, msg("took too long"));
  const std::string wrong = field_in(fields, "error");
  if (!wrong.empty())
    throw launch_error(LtiError::platform,
                       msg("was refused by the platform: {}", shortened(wrong)));
  const auto platform = platforms.of(text_in(kept, "iss"), text_in(kept, "client"));
  if (!platform)
    throw launch_error(LtiError::platform,
                       msg("comes from a platform that this office does not know"));
  const ReadToken token = read_token(field_in(fields, "id_token"));
  require_signed(token, keys_of(*platform, token.kid));
  const std::string nonce = text_in(kept, "nonce");
  LtiLaunch launch = checked_claims(token.claims, *platform, nonce, now_s);
  const std::lock_guard guard(lock_);
  std::erase_if(used_, [&](const auto& one) { return one.second < now_s; });
  if (used_.size() >= k_max_used)
    throw launch_error(LtiError::used, msg("is one of too many at once: wait some minutes"));
  if (!used_.emplace(nonce, whole_in(kept, "until")).second)
    throw launch_error(LtiError::used, msg("was used before"));
  return launch;
}

LtiLaunch checked_claims(const json& claims, const LtiPlatform& platform, const std::string& nonce,
                         std::int64_t now_s) {
  if (text_in(claims, "iss") != platform.issuer)
    throw launch_error(LtiError::platform, msg("has a token of another platform"));
  if (!is_audience(claims, platform.client_id))
    throw launch_error(LtiError::audience,
                       msg("has a token that is meant for another tool, or for others, too"));
  const double now = static_cast<double>(now_s), expires = seconds_in(claims, "exp"),
               issued = seconds_in(claims, "iat");
  if (!(expires > now - k_skew_s))
    throw launch_error(LtiError::too_late, msg("has a token whose time is over"));
  if (!(issued < now + k_skew_s))
    throw launch_error(LtiError::too_late, msg("has a token of the future: a clock is wrong"));
  if (!(issued > now - k_oldest_token_s))
    throw launch_error(LtiError::too_late, msg("has a token that is too old"));
  if (nonce.empty() || text_in(claims, "nonce") != nonce)
    throw launch_error(LtiError::login, msg("has the token of another login"));
  LtiLaunch launch;
  launch.platform = platform;
  if (const json& d = claim_of(claims, "deployment_id"); d.is_string()) launch.deployment = d;
  if (std::find(platform.deployments.begin(), platform.deployments.end(), launch.deployment) ==
      platform.deployments.end())
    throw launch_error(LtiError::deployment, msg("comes from a deployment that was not set up"));
  if (claim_of(claims, "message_type") != "LtiResourceLinkRequest")
    throw launch_error(LtiError::message, msg("is another message than a link's"));
  if (claim_of(claims, "version") != "1.3.0")
    throw launch_error(LtiError::message, msg("is not of version 1.3.0"));
  if (claim_of(claims, "target_link_uri") != platform.office + k_lti_launch)
    throw launch_error(LtiError::target, msg("leads to another place than this office"));
  launch.link = text_in(claim_of(claims, "resource_link"), "id");
  if (launch.link.empty() || launch.link.size() > k_longest_sub)
    throw launch_error(LtiError::incomplete, msg("does not say which link was opened"));
  launch.sub = text_in(claims, "sub");
  if (launch.sub.empty() || launch.sub.size() > k_longest_sub || !is_plain_text(launch.sub))
    throw launch_error(LtiError::incomplete, msg("does not say who comes"));
  const json& roles = claim_of(claims, "roles");
  if (!roles.is_array())
    throw launch_error(LtiError::incomplete, msg("does not say in which role"));
  const auto is = [&](const char* role) {
    return std::find(roles.begin(), roles.end(), json(std::string(k_membership) + role)) !=
           roles.end();
  };
  const bool learns = is("Learner");
  launch.teaches = is("Instructor") && !learns;  // of two roles the one that sees less
  if (!learns && !launch.teaches)
    throw launch_error(
        LtiError::role,
        msg("is of a role that sees nothing here: a course's learners and instructors do"));
  launch.id = matched_id(claims, platform);
  launch.name = shortened(text_in(claims, "name"));
  const json& context = claim_of(claims, "context");
  launch.context = text_in(context, "id");
  launch.title = shortened(text_in(context, "title"));
  launch.exam = text_in(claim_of(claims, "custom"), "exam");
  if (const json& grades = member_of(claims, k_grades_claim); grades.is_object())
    launch.grades = grades;
  return launch;
}

}  // namespace cavum::office
