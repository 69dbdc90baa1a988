#include "ui/office/lti/keys.h"

#include <openssl/bio.h>
#include <openssl/bn.h>
#include <openssl/core_names.h>
#include <openssl/evp.h>
#include <openssl/param_build.h>
#include <openssl/pem.h>
#include <openssl/rsa.h>

#include <memory>
#include <set>

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

template <auto Free>
struct Freed {
  template <class T>
  void operator()(T* p) const {
    Free(p);
  }
};
using RsaKey = std::unique_ptr<EVP_PKEY, Freed<EVP_PKEY_free>>;
using RsaContext = std::unique_ptr<EVP_PKEY_CTX, Freed<EVP_PKEY_CTX_free>>;
using Digest = std::unique_ptr<EVP_MD_CTX, Freed<EVP_MD_CTX_free>>;
using Big = std::unique_ptr<BIGNUM, Freed<BN_free>>;
using Text = std::unique_ptr<BIO, Freed<BIO_free>>;
using Builder = std::unique_ptr<OSSL_PARAM_BLD, Freed<OSSL_PARAM_BLD_free>>;
using Params = std::unique_ptr<OSSL_PARAM, Freed<OSSL_PARAM_free>>;

constexpr unsigned k_own_bits = 3072;
constexpr int k_fewest_bits = 2048, k_max_bits = 8192;
constexpr std::size_t k_longest_token = 64U << 10, k_kid_bytes = 16;

Error key_error() {
  return {msg("the office's key for learning platforms"), msg("cannot be used"),
          msg("have a new one made: cavum serve --new-lti-key")};
}
Error token_error(LtiError code, const Message& what) {
  return {code, msg("the platform's token"), what,
          msg("open the link on the platform again; if it stays, tell the office")};
}

std::string bytes_of(const BIGNUM* n) {
  std::string out(static_cast<std::size_t>(BN_num_bytes(n)), '\0');
  BN_bn2bin(n, reinterpret_cast<unsigned char*>(out.data()));
  return out;
}

RsaKey private_key(const LtiKey& key) {
  const Text text(BIO_new_mem_buf(key.pem.data(), static_cast<int>(key.pem.size())));
  RsaKey read(PEM_read_bio_PrivateKey(text.get(), nullptr, nullptr, nullptr));
  if (!read || EVP_PKEY_get_base_id(read.get()) != EVP_PKEY_RSA) throw key_error();
  return read;
}

Big number_in(const json& jwk, const char* name) {
  const auto bytes = from_base64url(text_in(jwk, name));
  if (!bytes || bytes->empty()) return {};
  return Big(BN_bin2bn(reinterpret_cast<const unsigned char*>(bytes->data()),
                       static_cast<int>(bytes->size()), nullptr));
}

/// Null: it is no RSA key that we take.
RsaKey public_key(const json& jwk) {
  const Big n = number_in(jwk, "n"), e = number_in(jwk, "e");
  if (!n || !e || BN_num_bits(n.get()) < k_fewest_bits || BN_num_bits(n.get()) > k_max_bits ||
      BN_num_bits(e.get()) > 64 || !BN_is_odd(e.get()) || BN_is_one(e.get()))
    return {};
  const Builder builder(OSSL_PARAM_BLD_new());
  if (!builder || OSSL_PARAM_BLD_push_BN(builder.get(), OSSL_PKEY_PARAM_RSA_N, n.get()) != 1 ||
      OSSL_PARAM_BLD_push_BN(builder.get(), OSSL_PKEY_PARAM_RSA_E, e.get()) != 1)
    return {};
  const Params params(OSSL_PARAM_BLD_to_param(builder.get()));
  const RsaContext context(EVP_PKEY_CTX_new_from_name(nullptr, "RSA", nullptr));
  EVP_PKEY* made = nullptr;
  if (!params || !context || EVP_PKEY_fromdata_init(context.get()) != 1 ||
      EVP_PKEY_fromdata(context.get(), &made, EVP_PKEY_PUBLIC_KEY, params.get()) != 1)
    return {};
  return RsaKey(made);
}

/// A name that stands twice could be read in two ways: JSON's reader keeps the last.
bool names_stand_once(const std::string& text) {
  std::vector<std::set<std::string>> open;
  bool once = true;
  const json::parser_callback_t look = [&](int, json::parse_event_t event, json& value) {
    if (event == json::parse_event_t::object_start) open.emplace_back();
    if (event == json::parse_event_t::key)
      once = once && open.back().insert(value.get<std::string>()).second;
    if (event == json::parse_event_t::object_end) open.pop_back();
    return true;
  };
  return !json::parse(text, look, false).is_discarded() && once;
}

json part_in(std::string_view part) {
  const auto bytes = from_base64url(part);
  if (!bytes) throw token_error(LtiError::not_understood, msg("is none"));
  const json read = parse_json_or_null(*bytes, {k_longest_token, 5'000, 16});
  if (!read.is_object()) throw token_error(LtiError::not_understood, msg("is none"));
  if (!names_stand_once(*bytes)) throw token_error(LtiError::twice, msg("says something twice"));
  return read;
}

/// The only key of that name; null: none, or two.
const json* key_named(const json& keys, const std::string& kid, bool& twice) {
  const json* found = nullptr;
  if (const json& list = member_of(keys, "keys"); list.is_array())
    for (const json& k : list)
      if (text_in(k, "kid") == kid) {
        twice = found != nullptr;
        found = &k;
      }
  return found;
}

}  // namespace

std::string to_base64url(std::string_view bytes) {
  return to_base64({reinterpret_cast<const std::uint8_t*>(bytes.data()), bytes.size()},
                   Base64::in_address);
}

std::optional<std::string> from_base64url(std::string_view text) {
  const auto bytes = from_base64(text, Base64::in_address);
  return bytes ? std::optional<std::string>({bytes->begin(), bytes->end()}) : std::nullopt;
}

LtiKey new_lti_key(std::int64_t utc_ns) {
  const RsaKey key(EVP_RSA_gen(k_own_bits));
  const Text text(BIO_new(BIO_s_mem()));
  if (!key || !text ||
      PEM_write_bio_PKCS8PrivateKey(text.get(), key.get(), nullptr, nullptr, 0, nullptr, nullptr) !=
          1)
    throw key_error();
  char* data = nullptr;
  const long size = BIO_get_mem_data(text.get(), &data);
  return {records::random_hex(k_kid_bytes), {data, static_cast<std::size_t>(size)}, utc_ns};
}

json public_key_set(const std::vector<LtiKey>& keys) {
  json out = json::array();
  for (const LtiKey& k : keys) {
    const RsaKey key = private_key(k);
    BIGNUM *n = nullptr, *e = nullptr;
    const bool read = EVP_PKEY_get_bn_param(key.get(), OSSL_PKEY_PARAM_RSA_N, &n) == 1 &&
                      EVP_PKEY_get_bn_param(key.get(), OSSL_PKEY_PARAM_RSA_E, &e) == 1;
    const Big modulus(n), exponent(e);
    if (!read) throw key_error();
    out.push_back({{"kty", "RSA"},
                   {"use", "sig"},
                   {"alg", "RS256"},
                   {"kid", k.kid},
                   {"n", to_base64url(bytes_of(n))},
                   {"e", to_base64url(bytes_of(e))}});
  }
  return {{"keys", out}};
}

std::string sign_token(const json& claims, const LtiKey& key) {
  const RsaKey by = private_key(key);
  const std::string text =
      to_base64url(json{{"alg", "RS256"}, {"kid", key.kid}, {"typ", "JWT"}}.dump()) + "." +
      to_base64url(claims.dump());
  const auto* bytes = reinterpret_cast<const unsigned char*>(text.data());
  const Digest digest(EVP_MD_CTX_new());
  std::size_t size = 0;
  if (!digest || EVP_DigestSignInit(digest.get(), nullptr, EVP_sha256(), nullptr, by.get()) != 1 ||
      EVP_DigestSign(digest.get(), nullptr, &size, bytes, text.size()) != 1)
    throw key_error();
  std::string signature(size, '\0');
  if (EVP_DigestSign(digest.get(), reinterpret_cast<unsigned char*>(signature.data()), &size, bytes,
                     text.size()) != 1)
    throw key_error();
  signature.resize(size);
  return text + "." + to_base64url(signature);
}

ReadToken read_token(const std::string& token) {
  const auto first = token.find('.'), last = token.rfind('.');
  if (token.size() > k_longest_token || first == std::string::npos ||
      token.find('.', first + 1) != last)
    throw token_error(LtiError::not_understood, msg("is none"));
  const json header = part_in(std::string_view(token).substr(0, first));
  if (text_in(header, "alg") != "RS256")
    throw token_error(LtiError::algorithm, msg("is not signed by RS256"));
  if (header.contains("crit"))
    throw token_error(LtiError::not_understood, msg("asks for what this office does not know"));
  const json& type = member_of(header, "typ");
  if (!type.is_null() && type != "JWT")
    throw token_error(LtiError::not_understood, msg("is of another type than JWT"));
  ReadToken read{text_in(header, "kid"),
                 part_in(std::string_view(token).substr(first + 1, last - first - 1)),
                 token.substr(0, last),
                 {}};
  if (read.kid.empty())
    throw token_error(LtiError::key, msg("does not say which key has signed it"));
  const auto signature = from_base64url(std::string_view(token).substr(last + 1));
  if (!signature) throw token_error(LtiError::not_understood, msg("is none"));
  read.signature = *signature;
  return read;
}

bool has_key(const json& keys, const std::string& kid) {
  bool twice = false;
  return key_named(keys, kid, twice) != nullptr;
}

void require_signed(const ReadToken& token, const json& keys) {
  bool twice = false;
  const json* jwk = key_named(keys, token.kid, twice);
  if (jwk == nullptr)
    throw token_error(LtiError::key, msg("is signed by a key that is not the platform's"));
  if (twice)
    throw token_error(LtiError::key,
                      msg("is signed by a key whose name stands twice in the platform's key set"));
  const json &use = member_of(*jwk, "use"), &algorithm = member_of(*jwk, "alg");
  const RsaKey key = text_in(*jwk, "kty") == "RSA" && (use.is_null() || use == "sig") &&
                             (algorithm.is_null() || algorithm == "RS256")
                         ? public_key(*jwk)
                         : RsaKey();
  if (!key)
    throw token_error(
        LtiError::key,
        msg("is signed by a key that is none for RS256, or has fewer than 2048 bits"));
  const Digest digest(EVP_MD_CTX_new());
  const bool good =
      digest &&
      EVP_DigestVerifyInit(digest.get(), nullptr, EVP_sha256(), nullptr, key.get()) == 1 &&
      EVP_DigestVerify(digest.get(), reinterpret_cast<const unsigned char*>(token.signature.data()),
                       token.signature.size(),
                       reinterpret_cast<const unsigned char*>(token.signed_text.data()),
                       token.signed_text.size()) == 1;
  if (!good) throw token_error(LtiError::signature, msg("does not bear the platform's signature"));
}

}  // namespace cavum::office
