#include "ui/office/proxy.h"

#include <arpa/inet.h>
#include <sodium.h>

#include <algorithm>
#include <array>

#include "engine/base/error.h"
#include "engine/base/text.h"

namespace cavum::office {
namespace {

constexpr char k_mapped[] = "::ffff:";  // an IPv4 address at a socket for IPv6
constexpr std::size_t k_longest_known_as = 200;

std::string plain_address(const std::string& address) {
  const bool mapped = address.starts_with(k_mapped) && address.find('.') != std::string::npos;
  return mapped ? address.substr(sizeof k_mapped - 1) : address;
}

bool is_token(char c) { return (c >= 'a' && c <= 'z') || (c >= '0' && c <= '9') || c == '-'; }

}  // namespace

ProxySignOn proxy_sign_on(const std::string& address, const std::string& secret,
                          const std::string& field) {
  ProxySignOn out{"", secret, field};
  std::array<unsigned char, sizeof(in6_addr)> bytes{};
  std::array<char, INET6_ADDRSTRLEN> text{};
  for (const int family : {AF_INET, AF_INET6})
    if (::inet_pton(family, address.c_str(), bytes.data()) == 1 &&
        ::inet_ntop(family, bytes.data(), text.data(), text.size()) != nullptr)
      out.address = plain_address(text.data());
  if (out.address.empty())
    throw Error("--proxy-address " + one_line(address), msg("is no address"),
                msg("give the proxy's own, such as 127.0.0.1"));
  for (char& c : out.field)
    if (c >= 'A' && c <= 'Z') c = static_cast<char>(c - 'A' + 'a');
  if (out.field.empty() || !std::all_of(out.field.begin(), out.field.end(), is_token) ||
      out.field == k_proxy_secret_field)
    throw Error("--proxy-header " + one_line(field), msg("is no name of a field"),
                msg("give the one that the proxy sets, such as X-Auth-Request-Email"));
  if (secret.size() < k_shortest_proxy_secret || !is_plain_text(secret))
    throw Error("--proxy-secret", msg("is no line of 32 characters at least"),
                msg("write one that nobody can guess: openssl rand -hex 32"));
  return out;
}

ProxyWord proxy_word(const Head& head, const std::optional<ProxySignOn>& proxy) {
  if (!proxy) return {};
  const auto secret = head.fields.find(k_proxy_secret_field), who = head.fields.find(proxy->field);
  if (secret == head.fields.end() && who == head.fields.end()) return {};
  const bool right =
      secret != head.fields.end() && secret->second.size() == proxy->secret.size() &&
      sodium_memcmp(secret->second.data(), proxy->secret.data(), proxy->secret.size()) == 0;
  if (!right || plain_address(head.address) != proxy->address) return {true, ""};
  if (who == head.fields.end()) return {};
  if (who->second.size() > k_longest_known_as || !is_plain_text(who->second)) return {true, ""};
  return {false, who->second};
}

}  // namespace cavum::office
