#include "ui/office/lti/https.h"

#include <curl/curl.h>
#include <fmt/core.h>
#include <openssl/ssl.h>

#include <new>
#include <utility>

#include "engine/base/hash.h"

namespace cavum::office {
namespace {

constexpr std::size_t k_sent_again = 64U << 10;

/// Each option is followed by its value.
template <class Value, class... More>
void set(CURL* handle, CURLoption option, Value value, More... more) {
  curl_easy_setopt(handle, option, value);
  if constexpr (sizeof...(more) != 0) set(handle, more...);
}

struct Transfer {
  const HttpsRequest& asked;
  HttpsAnswer& answer;
  std::size_t sent = 0;
};

std::size_t give(char* to, std::size_t size, std::size_t count, void* of) {
  auto& t = *static_cast<Transfer*>(of);
  const std::size_t n = t.asked.body.copy(to, size * count, t.sent);
  t.sent += n;
  return n;
}

/// For a connection that stood idle, and that the server closed: what is large is not sent twice.
int give_again(void* of, curl_off_t from, int) {
  auto& t = *static_cast<Transfer*>(of);
  t.sent = static_cast<std::size_t>(from);
  return t.asked.body.size() < k_sent_again ? CURL_SEEKFUNC_OK : CURL_SEEKFUNC_FAIL;
}

std::size_t take(char* from, std::size_t size, std::size_t count, void* of) {
  auto& t = *static_cast<Transfer*>(of);
  if (t.answer.body.size() + size * count > t.asked.largest_answer) return 0;
  t.answer.body.append(from, size * count);
  return size * count;
}

int is_stopped(void* stopped, curl_off_t, curl_off_t, curl_off_t, curl_off_t) {
  return stopped != nullptr && static_cast<const std::atomic<bool>*>(stopped)->load() ? 1 : 0;
}

int is_exactly(X509_STORE_CTX* shown, void* right) {
  Sha256 hash{};
  X509_digest(X509_STORE_CTX_get0_cert(shown), EVP_sha256(), hash.data(), nullptr);
  const bool same = to_hex(hash) == *static_cast<const std::string*>(right);
  X509_STORE_CTX_set_error(shown, same ? X509_V_OK : X509_V_ERR_CERT_REJECTED);
  return same ? 1 : 0;
}

CURLcode set_trust(CURL*, void* tls, void* of) {
  auto& trust = *static_cast<HttpsTrust*>(of);
  if (!trust.exactly.empty())
    SSL_CTX_set_cert_verify_callback(static_cast<SSL_CTX*>(tls), is_exactly, &trust.exactly);
  else if (trust.authority.empty())
    SSL_CTX_set_default_verify_paths(static_cast<SSL_CTX*>(tls));
  return CURLE_OK;
}

}  // namespace

Https::Https(HttpsTrust trust, const std::atomic<bool>* stopped)
    : trust_(std::move(trust)), stopped_(stopped), handle_(curl_easy_init(), curl_easy_cleanup) {
  if (!handle_) throw std::bad_alloc();
}

HttpsAnswer Https::ask(const HttpsRequest& request) {
  HttpsAnswer answer;
  Transfer transfer{request, answer};
  CURL* const h = handle_.get();
  curl_easy_reset(h);  // the connection stays
  set(h, CURLOPT_URL, request.address.c_str(), CURLOPT_PATH_AS_IS, 1L, CURLOPT_PROTOCOLS_STR,
      "https", CURLOPT_PROXY, "", CURLOPT_HTTP_VERSION, static_cast<long>(CURL_HTTP_VERSION_1_1),
      CURLOPT_SSLVERSION, static_cast<long>(CURL_SSLVERSION_TLSv1_2), CURLOPT_USERAGENT, "Cavum");
  set(h, CURLOPT_NOSIGNAL, 1L, CURLOPT_TIMEOUT_MS, static_cast<long>(request.patience.count()),
      CURLOPT_NOPROGRESS, 0L, CURLOPT_XFERINFOFUNCTION, is_stopped, CURLOPT_XFERINFODATA, stopped_,
      CURLOPT_WRITEFUNCTION, take, CURLOPT_WRITEDATA, &transfer);
  set(h, CURLOPT_CAINFO, nullptr, CURLOPT_CAPATH, nullptr, CURLOPT_SSL_CTX_FUNCTION, set_trust,
      CURLOPT_SSL_CTX_DATA, &trust_, CURLOPT_SSL_VERIFYHOST, trust_.exactly.empty() ? 2L : 0L);
  if (curl_blob pem{trust_.authority.data(), trust_.authority.size(), CURL_BLOB_COPY}; pem.len != 0)
    set(h, CURLOPT_CAINFO_BLOB, &pem);
  if (request.method != "GET")
    set(h, CURLOPT_POST, 1L, CURLOPT_CUSTOMREQUEST, request.method.c_str(),
        CURLOPT_POSTFIELDSIZE_LARGE, static_cast<curl_off_t>(request.body.size()),
        CURLOPT_READFUNCTION, give, CURLOPT_READDATA, &transfer, CURLOPT_SEEKFUNCTION, give_again,
        CURLOPT_SEEKDATA, &transfer);
  auto fields = request.fields;
  for (const char* own : {"Expect", "Content-Type"})
    fields.emplace(own, "");  // libcurl's own are left out
  curl_slist* lines = nullptr;
  for (const auto& [name, value] : fields)
    lines = curl_slist_append(lines, fmt::format("{}: {}", name, value).c_str());
  const std::unique_ptr<curl_slist, void (*)(curl_slist*)> kept(lines, curl_slist_free_all);
  set(h, CURLOPT_HTTPHEADER, lines);
  if (const CURLcode wrong = curl_easy_perform(h); wrong != CURLE_OK)
    answer.wrong = curl_easy_strerror(wrong);
  curl_easy_getinfo(h, CURLINFO_RESPONSE_CODE, &answer.status);
  curl_header* field = nullptr;
  if (curl_easy_header(h, request.wanted_field, 0, CURLH_HEADER, -1, &field) == CURLHE_OK)
    answer.field = field->value;
  return answer;
}

}  // namespace cavum::office
