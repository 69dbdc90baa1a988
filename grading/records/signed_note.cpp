#include "grading/records/signed_note.h"

#include <fmt/core.h>
#include <sodium.h>

#include <algorithm>

#include "engine/base/hash.h"
#include "engine/base/text.h"
#include "grading/records/ledger_key.h"

namespace cavum::records {
namespace {

constexpr std::size_t k_longest_note = 1'000'000, k_max_signatures = 100, k_longest_name = 254,
                      k_time_bytes = 8, k_signature_bytes = 64;
constexpr std::string_view k_dash = "\xe2\x80\x94 ";  // U+2014

/// Space, plus, and Unicode's other spaces in UTF-8.
bool has_space_or_plus(const std::string& name) {
  static constexpr std::string_view k_spaces[] = {" ",
                                                  "+",
                                                  "\xc2\x85",
                                                  "\xc2\xa0",
                                                  "\xe1\x9a\x80",
                                                  "\xe2\x80\x80",
                                                  "\xe2\x80\x81",
                                                  "\xe2\x80\x82",
                                                  "\xe2\x80\x83",
                                                  "\xe2\x80\x84",
                                                  "\xe2\x80\x85",
                                                  "\xe2\x80\x86",
                                                  "\xe2\x80\x87",
                                                  "\xe2\x80\x88",
                                                  "\xe2\x80\x89",
                                                  "\xe2\x80\x8a",
                                                  "\xe2\x80\xa8",
                                                  "\xe2\x80\xa9",
                                                  "\xe2\x80\xaf",
                                                  "\xe2\x81\x9f",
                                                  "\xe3\x80\x80"};
  return std::any_of(std::begin(k_spaces), std::end(k_spaces),
                     [&](std::string_view s) { return name.find(s) != std::string::npos; });
}

std::span<const std::uint8_t> bytes_of(const std::string& text) {
  return {reinterpret_cast<const std::uint8_t*>(text.data()), text.size()};
}

/// What a cosigner signs.
std::string cosigned_text(const std::string& text, std::uint64_t utc_s) {
  return fmt::format("cosignature/v1\ntime {}\n{}", utc_s, text);
}

[[noreturn]] void no_note(const Where& where, const Message& why) {
  throw Error(where, msg("is no signed note: {}", why),
              msg("name a note that `cavum ledger` wrote, unchanged"));
}

}  // namespace

std::string to_base64(std::span<const std::uint8_t> bytes) {
  std::string out(sodium_base64_ENCODED_LEN(bytes.size(), sodium_base64_VARIANT_ORIGINAL), '\0');
  sodium_bin2base64(out.data(), out.size(), bytes.data(), bytes.size(),
                    sodium_base64_VARIANT_ORIGINAL);
  out.pop_back();  // the terminating zero
  return out;
}

std::optional<Bytes> from_base64(const std::string& text) {
  Bytes out(text.size() / 4 * 3 + 3);
  std::size_t n = 0;
  if (sodium_base642bin(out.data(), out.size(), text.data(), text.size(), nullptr, &n, nullptr,
                        sodium_base64_VARIANT_ORIGINAL) != 0)
    return {};
  out.resize(n);
  // libsodium reads bytes above 127 as '/'
  return to_base64(out) == text ? std::optional(std::move(out)) : std::nullopt;
}

void require_note_name(const std::string& name, const Where& where) {
  if (name.empty() || name.size() > k_longest_name || !is_plain_text(name) ||
      has_space_or_plus(name))
    throw Error(where, msg("'{}' is no name for a signature", one_line(name)),
                msg("give 1 to 254 bytes of text without spaces and plus signs"));
}

std::array<std::uint8_t, 4> key_id_of(const NoteKey& key) {
  Bytes b(key.name.begin(), key.name.end());
  b.push_back('\n');
  b.push_back(static_cast<std::uint8_t>(key.kind));
  b.insert(b.end(), key.public_key.begin(), key.public_key.end());
  const Sha256 hash = sha256(b);
  return {hash[0], hash[1], hash[2], hash[3]};
}

std::string key_line(const NoteKey& key) {
  Bytes b{static_cast<std::uint8_t>(key.kind)};
  b.insert(b.end(), key.public_key.begin(), key.public_key.end());
  return fmt::format("{}+{}+{}", key.name, to_hex(key_id_of(key)), to_base64(b));
}

NoteKey parse_key_line(const std::string& line, const Where& where) {
  const auto fail = [&]() -> NoteKey {
    throw Error(where, msg("is no key of a note: NAME+key id+base64"),
                msg("copy the whole line that its owner shows"));
  };
  const auto first = line.find('+'),
             second = first == std::string::npos ? first : line.find('+', first + 1);
  if (second == std::string::npos) return fail();
  const auto bytes = from_base64(line.substr(second + 1));
  if (!bytes || bytes->size() != 33 || ((*bytes)[0] != 0x01 && (*bytes)[0] != 0x04)) return fail();
  NoteKey key{line.substr(0, first), static_cast<NoteKind>((*bytes)[0]), {}};
  std::copy(bytes->begin() + 1, bytes->end(), key.public_key.begin());
  require_note_name(key.name, where);
  if (line.substr(first + 1, second - first - 1) != to_hex(key_id_of(key))) return fail();
  return key;
}

NoteSignature parse_signature_line(const std::string& line, const Where& where) {
  const auto name_end = line.find(' ', k_dash.size());
  if (!line.starts_with(k_dash) || name_end == std::string::npos || line.empty() ||
      line.back() != '\n')
    no_note(where, msg("a line of a signature is none"));
  const auto bytes = from_base64(line.substr(name_end + 1, line.size() - name_end - 2));
  if (!bytes || bytes->size() < 5)
    no_note(where, msg("a signature is no base64 of a key id and a signature"));
  NoteSignature s{line.substr(k_dash.size(), name_end - k_dash.size()),
                  {},
                  Bytes(bytes->begin() + 4, bytes->end())};
  std::copy_n(bytes->begin(), 4, s.key_id.begin());
  require_note_name(s.name, where);
  return s;
}

std::string signature_line(const NoteSignature& s) {
  Bytes b(s.key_id.begin(), s.key_id.end());
  b.insert(b.end(), s.signature.begin(), s.signature.end());
  return fmt::format("{}{} {}\n", k_dash, s.name, to_base64(b));
}

SignedNote parse_note(const std::string& note, const Where& where) {
  if (note.size() > k_longest_note) no_note(where, msg("it is longer than 1 MB"));
  const auto gap = note.rfind("\n\n");
  if (gap == std::string::npos || note.back() != '\n')
    no_note(where, msg("it has no empty line between text and signatures, or no line end"));
  SignedNote out{note.substr(0, gap + 1), {}};
  for (std::size_t from = 0; from < note.size();) {
    const auto end = note.find('\n', from);
    const std::string line = note.substr(from, end - from);
    if (!is_plain_text(line))
      no_note(where, msg("it holds a control character or bytes that are no UTF-8"));
    if (from >= gap + 2) {
      out.signatures.push_back(parse_signature_line(line + "\n", where));
      if (out.signatures.size() > k_max_signatures)
        no_note(where, msg("it has more than {} signatures", k_max_signatures));
    }
    from = end + 1;
  }
  if (out.signatures.empty()) no_note(where, msg("nobody has signed it"));
  return out;
}

std::string write_note(const SignedNote& note) {
  std::string out = note.text + "\n";
  for (const auto& s : note.signatures) out += signature_line(s);
  return out;
}

NoteSignature sign_note(const std::string& text, const std::string& name, const SigningKey& key) {
  const auto signature = key.sign(bytes_of(text));
  return {name, key_id_of({name, NoteKind::signature, key.public_key}),
          Bytes(signature.begin(), signature.end())};
}

NoteSignature cosign_note(const std::string& text, const std::string& name, const SigningKey& key,
                          std::uint64_t utc_s) {
  NoteSignature out{name, key_id_of({name, NoteKind::cosignature, key.public_key}), {}};
  for (int shift = 56; shift >= 0; shift -= 8)
    out.signature.push_back(static_cast<std::uint8_t>(utc_s >> shift));
  const auto signature = key.sign(bytes_of(cosigned_text(text, utc_s)));
  out.signature.insert(out.signature.end(), signature.begin(), signature.end());
  return out;
}

std::optional<std::uint64_t> cosigned_at(const NoteSignature& s) {
  if (s.signature.size() != k_time_bytes + k_signature_bytes) return {};
  std::uint64_t utc_s = 0;
  for (std::size_t i = 0; i < k_time_bytes; ++i) utc_s = utc_s << 8 | s.signature[i];
  return utc_s > INT64_MAX ? std::nullopt : std::optional(utc_s);
}

bool is_of(const NoteSignature& s, const NoteKey& key) {
  return s.name == key.name && s.key_id == key_id_of(key);
}

bool holds(const NoteSignature& s, const NoteKey& key, const std::string& text) {
  if (!is_of(s, key)) return false;
  const bool timed = key.kind == NoteKind::cosignature;
  const auto at = cosigned_at(s);
  if (timed ? !at : s.signature.size() != k_signature_bytes) return false;
  std::array<std::uint8_t, k_signature_bytes> signature{};
  std::copy(s.signature.end() - k_signature_bytes, s.signature.end(), signature.begin());
  return is_signed_by(key.public_key, bytes_of(timed ? cosigned_text(text, *at) : text), signature);
}

NoteVerdict check_note(const SignedNote& note, const NoteKey& key) {
  NoteVerdict verdict = NoteVerdict::absent;
  for (const auto& s : note.signatures)
    if (is_of(s, key)) {
      if (!holds(s, key, note.text)) return NoteVerdict::broken;
      verdict = NoteVerdict::holds;
    }
  return verdict;
}

}  // namespace cavum::records
