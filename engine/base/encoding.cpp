#include "engine/base/encoding.h"

#include <sodium.h>

namespace cavum {
namespace {

int variant_of(Base64 form) {
  return form == Base64::padded ? sodium_base64_VARIANT_ORIGINAL
                                : sodium_base64_VARIANT_URLSAFE_NO_PADDING;
}

}  // namespace

std::string to_hex(std::span<const std::uint8_t> bytes) {
  std::string out(2 * bytes.size() + 1, '\0');
  sodium_bin2hex(out.data(), out.size(), bytes.data(), bytes.size());
  out.pop_back();  // the terminating zero
  return out;
}

std::optional<Bytes> from_hex(std::string_view text) {
  Bytes out(text.size() / 2);
  std::size_t n = 0;
  if (sodium_hex2bin(out.data(), out.size(), text.data(), text.size(), nullptr, &n, nullptr) != 0 ||
      to_hex(out) != text)
    return {};
  return out;
}

std::string to_base64(std::span<const std::uint8_t> bytes, Base64 form) {
  std::string out(sodium_base64_encoded_len(bytes.size(), variant_of(form)), '\0');
  sodium_bin2base64(out.data(), out.size(), bytes.data(), bytes.size(), variant_of(form));
  out.pop_back();  // the terminating zero
  return out;
}

std::optional<Bytes> from_base64(std::string_view text, Base64 form) {
  Bytes out(text.size());
  std::size_t n = 0;
  if (sodium_base642bin(out.data(), out.size(), text.data(), text.size(), nullptr, &n, nullptr,
                        variant_of(form)) != 0)
    return {};
  out.resize(n);
  return to_base64(out, form) == text ? std::optional(std::move(out))
                                      : std::nullopt;  // libsodium reads bytes above 127 as '/'
}

}  // namespace cavum
