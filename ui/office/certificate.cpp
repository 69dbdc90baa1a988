#include "ui/office/certificate.h"

#include <fmt/core.h>
#include <openssl/bio.h>
#include <openssl/ec.h>
#include <openssl/evp.h>
#include <openssl/pem.h>
#include <openssl/rand.h>
#include <openssl/x509.h>
#include <openssl/x509v3.h>

#include <array>
#include <boost/asio/ip/address.hpp>
#include <filesystem>
#include <memory>

#include "engine/base/error.h"
#include "engine/base/file.h"
#include "engine/base/hash.h"

namespace cavum::office {
namespace {

constexpr long k_five_years_s = 5L * 365 * 86'400;
constexpr int k_serial_bytes = 16;

template <auto release>
struct Release {
  void operator()(auto* p) const noexcept { release(p); }
};
using Key = std::unique_ptr<EVP_PKEY, Release<EVP_PKEY_free>>;
using Certificate = std::unique_ptr<X509, Release<X509_free>>;
using BioHandle = std::unique_ptr<BIO, Release<BIO_free_all>>;
using Extension = std::unique_ptr<X509_EXTENSION, Release<X509_EXTENSION_free>>;
using Number = std::unique_ptr<BIGNUM, Release<BN_free>>;

void require(bool done) {
  if (!done)
    throw Error(msg("OpenSSL"), msg("makes no certificate"),
                msg("give the school's own: --certificate FILE --key FILE"));
}

std::string text_in_stream(BIO* stream) {
  char* data = nullptr;
  const long size = BIO_get_mem_data(stream, &data);
  return {data, static_cast<std::size_t>(size)};
}

void extend(X509* certificate, int kind, const std::string& value) {
  X509V3_CTX context;
  X509V3_set_ctx_nodb(&context);
  X509V3_set_ctx(&context, certificate, certificate, nullptr, nullptr, 0);
  const Extension extension(X509V3_EXT_conf_nid(nullptr, &context, kind, value.c_str()));
  require(extension && X509_add_ext(certificate, extension.get(), -1) == 1);
}

std::string alternatives(const std::vector<std::string>& names) {
  std::string out;
  for (const auto& name : names) {
    boost::system::error_code no_address;
    static_cast<void>(boost::asio::ip::make_address(name, no_address));
    out += fmt::format("{}{}:{}", out.empty() ? "" : ",", no_address ? "DNS" : "IP", name);
  }
  return out;
}

}  // namespace

void make_certificate(const CertificateFiles& files, const std::vector<std::string>& names) {
  const bool has_certificate = std::filesystem::exists(files.certificate),
             has_key = std::filesystem::exists(files.key);
  if (has_certificate && has_key) return;
  if (has_certificate)
    throw Error(files.key, msg("is missing, and its certificate is there"),
                msg("restore it, or remove the certificate: a new pair is made then"));
  const Key key(EVP_EC_gen("P-256"));
  const Certificate made(X509_new());
  require(key && made);
  std::array<unsigned char, k_serial_bytes> serial{};
  require(RAND_bytes(serial.data(), k_serial_bytes) == 1);
  serial[0] &= 0x7fU;
  const Number number(BN_bin2bn(serial.data(), k_serial_bytes, nullptr));
  require(X509_set_version(made.get(), X509_VERSION_3) == 1 && number &&
          BN_to_ASN1_INTEGER(number.get(), X509_get_serialNumber(made.get())));
  require(X509_gmtime_adj(X509_getm_notBefore(made.get()), -3600) &&
          X509_gmtime_adj(X509_getm_notAfter(made.get()), k_five_years_s));
  X509_NAME* subject = X509_get_subject_name(made.get());
  const std::string common = "Cavum exam office";
  require(X509_NAME_add_entry_by_txt(subject, "CN", MBSTRING_UTF8,
                                     reinterpret_cast<const unsigned char*>(common.c_str()), -1, -1,
                                     0) == 1 &&
          X509_set_issuer_name(made.get(), subject) == 1 &&
          X509_set_pubkey(made.get(), key.get()) == 1);
  extend(made.get(), NID_basic_constraints, "critical,CA:FALSE");
  extend(made.get(), NID_key_usage, "critical,digitalSignature");
  extend(made.get(), NID_ext_key_usage, "serverAuth");
  extend(made.get(), NID_subject_alt_name, alternatives(names));
  require(X509_sign(made.get(), key.get(), EVP_sha256()) > 0);
  const BioHandle key_text(BIO_new(BIO_s_mem())), text(BIO_new(BIO_s_mem()));
  require(key_text && text &&
          PEM_write_bio_PrivateKey(key_text.get(), key.get(), nullptr, nullptr, 0, nullptr,
                                   nullptr) == 1 &&
          PEM_write_bio_X509(text.get(), made.get()) == 1);
  make_private_folder(std::filesystem::path(files.key).parent_path().string());
  write_private_text_file(files.key, text_in_stream(key_text.get()));
  write_text_file(files.certificate, text_in_stream(text.get()));
}

std::string fingerprint_of(const std::string& file) {
  const std::string text = read_text_file(file);
  const BioHandle stream(BIO_new_mem_buf(text.data(), static_cast<int>(text.size())));
  const Certificate read(PEM_read_bio_X509(stream.get(), nullptr, nullptr, nullptr));
  Sha256 hash{};
  if (!read || X509_digest(read.get(), EVP_sha256(), hash.data(), nullptr) != 1)
    throw Error(file, msg("holds no certificate in PEM"),
                msg("name the file that `cavum serve` made, or the school's own"));
  return to_hex(hash);
}

}  // namespace cavum::office
