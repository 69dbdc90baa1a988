// Compact tooth file, version 2, little-endian:
//   "CVTOOTH2"            8 bytes
//   name, source          each u32 length + text
//   tissue count u8, each tissue {u8 id, u8 solid, name}
//   packed octree         see packed_octree.cpp
//   SHA-256               32 bytes, over all of the above
// Version 3 ("CVTOOTH3") is written only for a tooth with notes, or landmarks that a person put: as version 2, and before the checksum
//   landmark count u32 (0 to 64), each {name, f64 x, y, z, mm}
//   note count u32 (0 to 256), each {u8 kind: 0 guess, 1 warning, 2 mirror image; the message as JSON, see engine/base/message_json.h}
// Version 1 is read, too:
//   "CVTOOTH1", u64 size of the body, u64 packed size, zstd frame of that size, SHA-256 as above
//   with name, source and tissues as above in the body, then the octree as Octree::write writes it
#include <fmt/core.h>
#include <zstd.h>
#include <zstd_errors.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <new>
#include <string_view>

#include "engine/base/error.h"
#include "engine/base/file.h"
#include "engine/base/hash.h"
#include "engine/base/json_reader.h"
#include "engine/base/message_json.h"
#include "engine/base/text.h"
#include "engine/tooth/known_fits.h"

namespace cavum {
namespace {

constexpr std::string_view k_magic = "CVTOOTH2", k_magic_1 = "CVTOOTH1", k_magic_3 = "CVTOOTH3";
constexpr std::size_t k_most_notes = 256;
constexpr std::uint64_t k_largest_body_1 = 1ULL << 28;  // the octree of a molar has 7 MB

void write_tissues(const Tooth& tooth, ByteWriter& out) {
  out.put(static_cast<std::uint8_t>(tooth.tissues.size()));
  for (const auto& t : tooth.tissues) {
    out.put(t.id);
    out.put(static_cast<std::uint8_t>(t.solid));
    out.put_string(t.name);
  }
}

/// What is wrong with landmarks that a person put; empty when nothing is.
Message fault_of(const std::vector<NamedPoint>& landmarks) {
  constexpr double k_farthest_mm = 200.0;
  if (landmarks.size() > k_most_placed) return msg("{} landmarks, at most {} may be put", landmarks.size(), k_most_placed);
  for (std::size_t i = 0; i < landmarks.size(); ++i) {
    const auto& [name, at] = landmarks[i];
    if (name.empty() || name.size() > k_longest_landmark_name || !is_plain_text(name))
      return msg("the name of landmark {} cannot be read, or has more than {} bytes", i + 1, k_longest_landmark_name);
    if (!is_finite(at) || std::max({std::fabs(at.x), std::fabs(at.y), std::fabs(at.z)}) > k_farthest_mm)
      return msg("landmark {} lies nowhere in a tooth", i + 1);
    for (std::size_t j = 0; j < i; ++j)
      if (landmarks[j].name == name) return msg("landmark {} has the name of another", i + 1);
  }
  return {};
}

void write_landmarks(const Tooth& tooth, ByteWriter& out) {
  out.put(static_cast<std::uint32_t>(tooth.placed_landmarks.size()));
  for (const auto& [name, at] : tooth.placed_landmarks) {
    out.put_string(name);
    for (const double v : {at.x, at.y, at.z}) out.put(v);
  }
}

std::vector<NamedPoint> read_landmarks(ByteReader& in) {
  const auto count = in.get<std::uint32_t>();
  if (count > k_most_placed) in.fail(msg("a tooth has at most {} landmarks that a person put", k_most_placed));
  std::vector<NamedPoint> landmarks(count);
  for (auto& [name, at] : landmarks) {
    name = in.get_string();
    at.x = in.get<double>();
    at.y = in.get<double>();
    at.z = in.get<double>();
  }
  if (const auto fault = fault_of(landmarks); !fault.empty()) in.fail(fault);
  return landmarks;
}

void write_notes(const Tooth& tooth, ByteWriter& out) {
  out.put(static_cast<std::uint32_t>(tooth.notes.size()));
  for (const auto& [kind, text] : tooth.notes) {
    out.put(static_cast<std::uint8_t>(kind));
    out.put_string(text.empty() ? "" : encode(text).dump(-1, ' ', false, nlohmann::ordered_json::error_handler_t::replace));
  }
}

std::vector<ToothNote> read_notes(ByteReader& in, const std::string& where) {
  const auto count = in.get<std::uint32_t>();
  if (count > k_most_notes) in.fail(msg("a tooth has at most {} notes", k_most_notes));
  std::vector<ToothNote> notes(count);
  for (auto& [kind, text] : notes) {
    const auto number = in.get<std::uint8_t>();
    if (number > static_cast<std::uint8_t>(ToothNote::Kind::mirror_image)) in.fail(msg("a note is of no known kind"));
    kind = static_cast<ToothNote::Kind>(number);
    const std::string json = in.get_string();
    if (json.empty()) continue;
    try {
      text = decode_message(parse_json(json, where, k_json_part));
    } catch (const std::invalid_argument& e) {
      in.fail(msg("a note is no message: {}", e.what()));
    }
  }
  return notes;
}

Tooth read_all_but_octree(ByteReader& in) {
  Tooth tooth;
  tooth.name = one_line(in.get_string());
  tooth.source = one_line(in.get_string());
  tooth.tissues.resize(in.get<std::uint8_t>());
  for (auto& t : tooth.tissues) {
    t.id = in.get<std::uint8_t>();
    t.solid = in.get<std::uint8_t>() != 0;
    t.name = in.get_string();
    if (!is_plain_text(t.name)) in.fail(msg("the name of tissue {} cannot be read", t.id));
  }
  return tooth;
}

/// A zstd frame of `size` bytes, unpacked step by step: a size that is only claimed takes no memory.
Bytes unpack(std::span<const std::uint8_t> packed, std::uint64_t size, const ByteReader& in) {
  constexpr std::size_t k_portion = 1 << 20;
  const std::unique_ptr<ZSTD_DStream, std::size_t (*)(ZSTD_DStream*)> stream(ZSTD_createDStream(), ZSTD_freeDStream);
  if (!stream) throw std::bad_alloc();
  Bytes out;
  ZSTD_inBuffer from{packed.data(), packed.size(), 0};
  for (std::size_t more = 1; more != 0;) {
    const std::size_t had = out.size();
    out.resize(had + std::min<std::uint64_t>(k_portion, size - had));
    ZSTD_outBuffer to{out.data() + had, out.size() - had, 0};
    more = ZSTD_decompressStream(stream.get(), &to, &from);
    if (ZSTD_getErrorCode(more) == ZSTD_error_memory_allocation) throw std::bad_alloc();  // nothing is wrong with the file
    out.resize(had + to.pos);
    if (ZSTD_isError(more) != 0 || (to.pos == 0 && more != 0)) in.fail(msg("the compressed data are damaged"));
  }
  if (out.size() != size || from.pos != from.size) in.fail(msg("the compressed data are damaged"));
  return out;
}

Tooth read_body_1(ByteReader& in, const std::string& where) {
  const auto body_size = in.get<std::uint64_t>();
  const auto packed = in.get_bytes(in.get<std::uint64_t>());
  if (body_size > k_largest_body_1) in.fail(msg("the sizes in the header do not fit the file"));
  const Bytes body = unpack(packed, body_size, in);
  ByteReader from(body, where);
  Tooth tooth = read_all_but_octree(from);
  tooth.octree = Octree::read(from, tooth.tissues);
  return tooth;
}

KnownFits fits_of(const Tooth& tooth) {
  ByteWriter canonical, packed;
  tooth.octree.write(canonical);
  ByteReader from(canonical.bytes(), "tooth");
  pack_octree(from, tooth.tissues, packed);
  ByteReader in(packed.bytes(), "tooth");
  KnownFits fits;
  static_cast<void>(unpack_octree(in, tooth.tissues, nullptr, &fits));
  return fits;
}

}  // namespace

std::string Tooth::tissue_name(std::uint8_t id) const {
  if (id == k_air) return "air";
  for (const auto& t : tissues)
    if (t.id == id) return t.name;
  return fmt::format("tissue {}", id);
}

std::vector<Message> Tooth::notes_of(ToothNote::Kind kind) const {
  std::vector<Message> texts;
  for (const ToothNote& n : notes)
    if (n.kind == kind) texts.push_back(n.text);
  return texts;
}

std::uint8_t Tooth::tissue_id(const std::string& wanted) const {
  for (const auto& t : tissues)
    if (t.name == wanted) return t.id;
  throw Error(msg("tooth '{}'", name), msg("has no tissue named '{}'", wanted), msg("use one that `cavum tooth info` lists"));
}

Bytes save_tooth(const Tooth& tooth) {
  const bool third_version = !tooth.placed_landmarks.empty() || !tooth.notes.empty();
  if (const auto fault = fault_of(tooth.placed_landmarks); !fault.empty())
    throw Error(msg("tooth '{}'", tooth.name), fault, msg("put fewer landmarks, or others"));
  if (tooth.notes.size() > k_most_notes)
    throw Error(msg("tooth '{}'", tooth.name), msg("has more than {} notes", k_most_notes), msg("import it anew"));
  ByteWriter out;
  for (const char c : third_version ? k_magic_3 : k_magic) out.put(c);
  out.put_string(tooth.name);
  out.put_string(tooth.source);
  write_tissues(tooth, out);
  ByteWriter canonical;
  tooth.octree.write(canonical);
  ByteReader from(canonical.bytes(), "tooth");
  pack_octree(from, tooth.tissues, out);
  if (third_version) {
    write_landmarks(tooth, out);
    write_notes(tooth, out);
  }
  out.put_bytes(sha256(out.bytes()));
  return out.take();
}

Tooth load_tooth(std::span<const std::uint8_t> bytes, const std::string& where) { return load_tooth_like(bytes, where, nullptr); }

Tooth load_tooth_like(std::span<const std::uint8_t> bytes, const std::string& where, const PackedFits* like, KnownFits* keep) {
  const auto begins_with = [&bytes](std::string_view magic) {
    return bytes.size() >= magic.size() && std::equal(magic.begin(), magic.end(), bytes.begin());
  };
  const bool first_version = begins_with(k_magic_1), third_version = begins_with(k_magic_3);
  if (!first_version && !third_version && !begins_with(k_magic))
    throw Error(where, msg("not a Cavum tooth file of version 1, 2 or 3"), msg("make or import the tooth again with `cavum tooth`"));
  if (bytes.size() < k_magic.size() + sizeof(Sha256))
    throw Error(where, msg("the data end too early"), msg("the file is incomplete: use an intact copy"));
  const auto signed_bytes = bytes.first(bytes.size() - sizeof(Sha256));
  const Sha256 sum = sha256(signed_bytes);
  ByteReader in(signed_bytes.subspan(k_magic.size()), where);
  if (!std::equal(sum.begin(), sum.end(), bytes.begin() + static_cast<std::ptrdiff_t>(signed_bytes.size())))
    in.fail(msg("the checksum does not match"));
  Tooth tooth;
  if (first_version) {
    tooth = read_body_1(in, where);
    if (keep != nullptr) *keep = fits_of(tooth);
  } else {
    tooth = read_all_but_octree(in);
    const Bytes canonical = unpack_octree(in, tooth.tissues, like, keep);
    ByteReader from(canonical, where);
    tooth.octree = Octree::read(from, tooth.tissues);
    if (third_version) {
      tooth.placed_landmarks = read_landmarks(in);
      tooth.notes = read_notes(in, where);
    }
  }
  if (in.left() != 0) in.fail(msg("data after the end"));
  return tooth;
}

void save_tooth_file(const Tooth& tooth, const std::string& path) { write_file(path, save_tooth(tooth)); }

Tooth load_tooth_file(const std::string& path) { return load_tooth(read_file(path), path); }

std::string tooth_hash(const Tooth& tooth) {
  ByteWriter content;
  write_tissues(tooth, content);
  tooth.octree.write(content);
  if (!tooth.placed_landmarks.empty()) write_landmarks(tooth, content);
  return to_hex(sha256(content.bytes()));
}

}  // namespace cavum
