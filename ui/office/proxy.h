// Sign-in by the school's own accounts (OpenID Connect), which a reverse proxy in front of the
// office has checked: it says in a field of the request who asks, beside a secret that it shares
// with the office. The office believes that field from the proxy's address and with the secret
// alone.
#pragma once

#include <optional>
#include <string>

#include "ui/office/http_server.h"

namespace cavum::office {

inline constexpr char k_proxy_secret_field[] = "x-cavum-proxy-secret";
inline constexpr std::size_t k_shortest_proxy_secret = 32;

struct ProxySignOn {
  std::string address;  ///< the proxy's, as the connection has it: "127.0.0.1", "::1"
  std::string secret;   ///< k_shortest_proxy_secret bytes at least
  std::string field;    ///< name of the field that says who asks, in small letters
};
/// Checked and in the form that connections have. Throws Error for an address, a field's name or a
/// secret that is none.
[[nodiscard]] ProxySignOn proxy_sign_on(const std::string& address, const std::string& secret,
                                        const std::string& field);

/// What a request says of itself by the proxy's fields.
struct ProxyWord {
  bool refused = false;  ///< it bears one of them, and is not the proxy's
  std::string known_as;  ///< who asks; empty: the proxy says nobody
};
/// Without `proxy` nobody is believed.
[[nodiscard]] ProxyWord proxy_word(const Head& head, const std::optional<ProxySignOn>& proxy);

}  // namespace cavum::office
