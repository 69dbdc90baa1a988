// The server's certificate: the school's own, or one that it signs itself, made at the first start.
#pragma once

#include <string>
#include <vector>

namespace cavum::office {

struct CertificateFiles {
  std::string certificate, key;  ///< PEM
};

/// Makes a key (ECDSA, P-256; mode 0600) and a certificate good for five years, for these names and
/// addresses, unless both files are there. Throws Error when one of them is missing, or they cannot
/// be written.
void make_certificate(const CertificateFiles& files, const std::vector<std::string>& names);
/// SHA-256 over the certificate's DER, hexadecimal: what a station is told, and a browser shows.
/// Throws Error when the file holds none.
[[nodiscard]] std::string fingerprint_of(const std::string& certificate_file);

}  // namespace cavum::office
