#include "ui/office/lti/platforms.h"

#include <algorithm>
#include <filesystem>
#include <regex>

#include "engine/base/error.h"
#include "engine/base/file.h"
#include "engine/base/json_fields.h"
#include "engine/base/json_reader.h"
#include "engine/base/text.h"
#include "engine/session/session.h"

namespace cavum::office {
namespace {

using nlohmann::json;

constexpr std::size_t k_stored_keys = 2;

void require_line(const LtiLine& text, const char* name, bool needed) {
  if (!is_plain_text(text) || (needed && text.empty()))
    throw Error(msg("the platform's '{}'", name), msg("is no line of text"),
                msg("copy it from the platform's page of this tool"));
}

void require_address(const LtiLine& text, const char* name, bool needed) {
  require_line(text, name, needed);
  if (!text.empty() && origin_of(text).empty())
    throw Error(msg("the platform's '{}'", name), msg("is no address of https"),
                msg("give one such as https://moodle.example/mod/lti/certs.php"));
}

}  // namespace

std::string origin_of(const std::string& address) {
  static const std::regex k_address(
      R"((https://(?:[A-Za-z0-9.-]+|\[[0-9A-Fa-f:.]+\])(?::([0-9]{1,5}))?)(?:[/?][!-~]*)?)");
  std::smatch found;
  if (address.size() > 2000 || address.find_first_of("#\\\"<>^`{|}") != std::string::npos ||
      !std::regex_match(address, found, k_address))
    return "";
  if (found[2].matched && (std::stoi(found[2]) == 0 || std::stoi(found[2]) > 65'535)) return "";
  std::string origin = found[1];
  for (char& c : origin)
    if (c >= 'A' && c <= 'Z') c = static_cast<char>(c - 'A' + 'a');
  return origin.ends_with(":443") ? origin.substr(0, origin.size() - 4) : origin;
}

bool LtiPlatform::may_ask(const std::string& address) const {
  const std::string origin = origin_of(address);
  return !origin.empty() && (origin == origin_of(issuer) || origin == origin_of(auth_endpoint) ||
                             origin == origin_of(token_endpoint) || origin == origin_of(jwks_url) ||
                             std::find(hosts.begin(), hosts.end(), origin) != hosts.end());
}

LtiPlatform platform_in(const json& given) {
  return sound_platform(json_value_of<LtiPlatform>(given, asked_json()));
}

LtiPlatform sound_platform(LtiPlatform p) {
  static const std::regex k_claim("sub|(custom|lis)\\.[A-Za-z0-9_]{1,100}");
  require_line(p.name, "name", true);
  require_line(p.client_id, "client_id", true);
  require_line(p.token_audience, "token_audience", false);
  require_address(p.office, "office", true);
  require_address(p.issuer, "issuer", true);
  require_address(p.auth_endpoint, "auth_endpoint", true);
  require_address(p.token_endpoint, "token_endpoint", true);
  require_address(p.jwks_url, "jwks_url", false);
  p.office = origin_of(p.office);
  if (p.key_set.is_string())
    p.key_set =
        p.key_set.get<std::string>().empty()
            ? json()
            : parse_json(p.key_set.get<std::string>(), msg("the key set"), {1U << 18, 5'000, 8});
  if (p.jwks_url.empty() == p.key_set.is_null())
    throw Error(msg("the platform's keys"),
                p.jwks_url.empty() ? msg("are missing") : msg("stand there twice"),
                msg("give jwks_url or key_set, and not both"));
  if (!p.key_set.is_null() && !member_of(p.key_set, "keys").is_array())
    throw Error(msg("the platform's 'key_set'"), msg("is no key set"),
                msg("give the whole key set as the platform writes it"));
  if (p.claim.empty()) p.claim = "sub";
  if (!std::regex_match(p.claim, k_claim))
    throw Error(msg("the platform's 'claim'"), msg("is none that candidates can be matched by"),
                msg("say sub, custom.NAME or lis.NAME"));
  for (LtiLine& host : p.hosts) {
    require_address(host, "hosts", true);
    host = origin_of(host);
  }
  std::erase_if(static_cast<std::vector<cavum::Text<255>>&>(p.deployments),
                [](const auto& d) { return d.empty(); });
  if (p.deployments.empty())
    throw Error(msg("the platform's 'deployments'"), msg("are missing"),
                msg("give the deployment id that the platform shows"));
  return p;
}

// clang-format off
CAVUM_JSON_OF(LtiKey, (kid), (pem), (made_utc_ns))
// clang-format on
struct LtiPlatforms::File {
  std::vector<LtiPlatform> platforms;
  std::vector<LtiKey> keys;
};

/// Of the file.
static auto file_of(auto& platforms, auto& keys) {
  return json_inside([&](auto& of) {
    of("format", JsonFormat{"cavum platforms 1"}), of("platforms", platforms), of("keys", keys);
  });
}

LtiPlatforms::File LtiPlatforms::read() const {
  File file;
  if (!std::filesystem::exists(path_)) return file;
  const JsonSource source{path_, msg("restore it, or remove it and set them up anew")};
  auto all = file_of(file.platforms, file.keys);
  read_json_value(parse_json(read_text_file(path_), path_), {source}, all);
  for (LtiPlatform& p : file.platforms) p = sound_platform(std::move(p));
  return file;
}

void LtiPlatforms::write(const File& file) const {
  make_private_folder(std::filesystem::path(path_).parent_path().string());
  write_private_text_file(path_, to_json_value(file_of(file.platforms, file.keys)).dump(1) + "\n");
}

std::vector<LtiPlatform> LtiPlatforms::all() const {
  const std::lock_guard guard(lock_);
  return read().platforms;
}

std::optional<LtiPlatform> LtiPlatforms::of(const std::string& issuer,
                                            const std::string& client_id) const {
  for (auto& p : all())
    if (p.is(issuer, client_id)) return p;
  return std::nullopt;
}

void LtiPlatforms::set(LtiPlatform platform) {
  const std::lock_guard guard(lock_);
  File file = read();
  const auto same =
      std::find_if(file.platforms.begin(), file.platforms.end(),
                   [&](const LtiPlatform& p) { return p.is(platform.issuer, platform.client_id); });
  platform.accounts.clear();
  if (same == file.platforms.end()) {
    file.platforms.push_back(std::move(platform));
  } else {
    platform.accounts = same->accounts;
    *same = std::move(platform);
  }
  write(file);
}

void LtiPlatforms::remove(const std::string& issuer, const std::string& client_id) {
  const std::lock_guard guard(lock_);
  File file = read();
  if (std::erase_if(file.platforms,
                    [&](const LtiPlatform& p) { return p.is(issuer, client_id); }) == 0)
    throw Error(msg("platform {}", one_line(issuer)), msg("is not set up"),
                msg("see `cavum serve --platforms`"));
  write(file);
}

void LtiPlatforms::link(const std::string& issuer, const std::string& client_id,
                        const std::string& sub, const std::string& account) {
  if (sub.empty() || sub.size() > 255)
    throw Error(msg("the person's 'sub'"), msg("is none"), msg("copy it from the platform"));
  const std::lock_guard guard(lock_);
  File file = read();
  const auto same = std::find_if(file.platforms.begin(), file.platforms.end(),
                                 [&](const LtiPlatform& p) { return p.is(issuer, client_id); });
  if (same == file.platforms.end())
    throw Error(msg("platform {}", one_line(issuer)), msg("is not set up"),
                msg("see `cavum serve --platforms`"));
  if (account.empty())
    same->accounts.erase(sub);
  else
    same->accounts[sub] = account;
  write(file);
}

std::vector<LtiKey> LtiPlatforms::keys() {
  const std::lock_guard guard(lock_);
  File file = read();
  if (file.keys.empty()) {
    file.keys.push_back(new_lti_key(read_clocks().utc_ns));
    write(file);
  }
  return file.keys;
}

void LtiPlatforms::rotate() {
  const std::lock_guard guard(lock_);
  File file = read();
  file.keys.insert(file.keys.begin(), new_lti_key(read_clocks().utc_ns));
  if (file.keys.size() > k_stored_keys) file.keys.resize(k_stored_keys);
  write(file);
}

LtiAddresses addresses_for(const LtiPlatform& p) {
  return {p.office + k_lti_launch, p.office + k_lti_login, p.office + k_lti_launch,
          p.office + k_lti_keys};
}

}  // namespace cavum::office
