// Compact tooth file, version 1, little-endian:
//   "CVTOOTH1"            8 bytes
//   name                  u32 length + text
//   FDI number u8 (0: not stated), jaw u8 (0 not stated, 1 upper, 2 lower), class u8 (0 not stated,
//   1 incisor, 2 canine, 3 premolar, 4 molar) entry count u32 (0 to 256), each what was done to it:
//   u32 length + JSON, see tooth_source.h tissue count u8, each tissue {u8 id, u8 solid, name}
//   packed octree         see packed_octree.cpp
//   landmark count u32 (0 to 64), each {name, f64 x, y, z, mm}: those that a person put
//   note count u32 (0 to 256), each {u8 kind: 0 guess, 1 warning, 2 mirror image; the message as
//   JSON, see engine/base/message_json.h} SHA-256               32 bytes, over all of the above
#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
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

constexpr std::string_view k_magic = "CVTOOTH1";
constexpr std::size_t k_max_notes = 256;

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
  if (landmarks.size() > k_max_placed)
    return msg("{} landmarks, at most {} may be put", landmarks.size(), k_max_placed);
  for (std::size_t i = 0; i < landmarks.size(); ++i) {
    const auto& [name, at] = landmarks[i];
    if (name.empty() || name.size() > k_longest_landmark_name || !is_plain_text(name))
      return msg("the name of landmark {} cannot be read, or has more than {} bytes", i + 1,
                 k_longest_landmark_name);
    if (!is_finite(at) ||
        std::max({std::fabs(at.x), std::fabs(at.y), std::fabs(at.z)}) > k_farthest_mm)
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
  if (count > k_max_placed)
    in.fail(msg("a tooth has at most {} landmarks that a person put", k_max_placed));
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
    out.put_string(
        text.empty()
            ? ""
            : encode(text).dump(-1, ' ', false, nlohmann::ordered_json::error_handler_t::replace));
  }
}

std::vector<ToothNote> read_notes(ByteReader& in, const std::string& where) {
  const auto count = in.get<std::uint32_t>();
  if (count > k_max_notes) in.fail(msg("a tooth has at most {} notes", k_max_notes));
  std::vector<ToothNote> notes(count);
  for (auto& [kind, text] : notes) {
    const auto number = in.get<std::uint8_t>();
    if (number > static_cast<std::uint8_t>(ToothNote::Kind::mirror_image))
      in.fail(msg("a note is of no known kind"));
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

void write_kind(const ToothKind& kind, ByteWriter& out) {
  out.put(static_cast<std::uint8_t>(kind.number ? kind.number->fdi : 0));
  out.put(static_cast<std::uint8_t>(kind.jaw));
  out.put(static_cast<std::uint8_t>(kind.tooth_class));
}

ToothKind read_kind(ByteReader& in) {
  const ToothNumber number{in.get<std::uint8_t>()};
  const auto jaw = in.get<std::uint8_t>(), tooth_class = in.get<std::uint8_t>();
  if (jaw > static_cast<std::uint8_t>(Jaw::lower) ||
      tooth_class > static_cast<std::uint8_t>(ToothClass::molar))
    in.fail(msg("its jaw or class is none"));
  const ToothKind stated(static_cast<Jaw>(jaw), static_cast<ToothClass>(tooth_class));
  if (number.fdi == 0) return stated;
  if (!number.exists()) in.fail(msg("its number is that of no permanent tooth"));
  const ToothKind kind(number);
  if (kind.jaw != stated.jaw || kind.tooth_class != stated.tooth_class)
    in.fail(msg("its number contradicts its jaw or class"));
  return kind;
}

void write_source(const ToothSource& source, ByteWriter& out) {
  out.put(static_cast<std::uint32_t>(source.size()));
  for (const auto& entry : source)
    out.put_string(encode(entry).dump(-1, ' ', false, nlohmann::json::error_handler_t::replace));
}

ToothSource read_source(ByteReader& in, const std::string& where) {
  const auto count = in.get<std::uint32_t>();
  if (count > k_max_notes)
    in.fail(msg("a tooth has at most {} entries of its source", k_max_notes));
  ToothSource source;
  for (std::uint32_t i = 0; i < count; ++i)
    source.push_back(decode_tooth_entry(parse_json(in.get_string(), where, k_json_part), where));
  return source;
}

Tooth read_all_but_octree(ByteReader& in, const std::string& where) {
  Tooth tooth;
  tooth.name = one_line(in.get_string());
  tooth.kind = read_kind(in);
  tooth.source = read_source(in, where);
  tooth.tissues.resize(in.get<std::uint8_t>());
  for (auto& t : tooth.tissues) {
    t.id = in.get<std::uint8_t>();
    t.solid = in.get<std::uint8_t>() != 0;
    t.name = in.get_string();
    if (!is_plain_text(t.name)) in.fail(msg("the name of tissue {} cannot be read", t.id));
  }
  return tooth;
}

}  // namespace

std::string Tooth::tissue_name(std::uint8_t id) const {
  if (id == k_air) return "air";
  for (const auto& t : tissues)
    if (t.id == id) return t.name;
  return fmt::format("tissue {}", id);
}

std::vector<Message> Tooth::notes_of(ToothNote::Kind wanted) const {
  std::vector<Message> texts;
  for (const ToothNote& n : notes)
    if (n.kind == wanted) texts.push_back(n.text);
  return texts;
}

std::uint8_t Tooth::tissue_id(const std::string& wanted) const {
  for (const auto& t : tissues)
    if (t.name == wanted) return t.id;
  throw Error(msg("tooth '{}'", name), msg("has no tissue named '{}'", wanted),
              msg("use one that `cavum tooth info` lists"));
}

Bytes save_tooth(const Tooth& tooth) {
  if (const auto fault = fault_of(tooth.placed_landmarks); !fault.empty())
    throw Error(msg("tooth '{}'", tooth.name), fault, msg("put fewer landmarks, or others"));
  if (tooth.notes.size() > k_max_notes)
    throw Error(msg("tooth '{}'", tooth.name), msg("has more than {} notes", k_max_notes),
                msg("import it anew"));
  if (tooth.source.size() > k_max_notes)
    throw Error(msg("tooth '{}'", tooth.name),
                msg("has more than {} entries of its source", k_max_notes), msg("make it anew"));
  ByteWriter out;
  for (const char c : k_magic) out.put(c);
  out.put_string(tooth.name);
  write_kind(tooth.kind, out);
  write_source(tooth.source, out);
  write_tissues(tooth, out);
  ByteWriter canonical;
  tooth.octree.write(canonical);
  ByteReader from(canonical.bytes(), msg("tooth"));
  pack_octree(from, tooth.tissues, out);
  write_landmarks(tooth, out);
  write_notes(tooth, out);
  out.put_bytes(sha256(out.bytes()));
  return out.take();
}

Tooth load_tooth(std::span<const std::uint8_t> bytes, const std::string& where) {
  return load_tooth_like(bytes, where, nullptr);
}

Tooth load_tooth_like(std::span<const std::uint8_t> bytes, const std::string& where,
                      const PackedFits* like, KnownFits* keep) {
  if (bytes.size() < k_magic.size() || !std::equal(k_magic.begin(), k_magic.end(), bytes.begin()))
    throw Error(where, msg("not a Cavum tooth file of version 1"),
                msg("make or import the tooth again with `cavum tooth`"));
  if (bytes.size() < k_magic.size() + sizeof(Sha256))
    throw Error(where, msg("the data end too early"),
                msg("the file is incomplete: use an intact copy"));
  const auto signed_bytes = bytes.first(bytes.size() - sizeof(Sha256));
  const Sha256 sum = sha256(signed_bytes);
  ByteReader in(signed_bytes.subspan(k_magic.size()), where);
  if (!std::equal(sum.begin(), sum.end(),
                  bytes.begin() + static_cast<std::ptrdiff_t>(signed_bytes.size())))
    in.fail(msg("the checksum does not match"));
  Tooth tooth = read_all_but_octree(in, where);
  const Bytes canonical = unpack_octree(in, tooth.tissues, like, keep);
  ByteReader from(canonical, where);
  tooth.octree = Octree::read(from, tooth.tissues);
  tooth.placed_landmarks = read_landmarks(in);
  tooth.notes = read_notes(in, where);
  if (in.left() != 0) in.fail(msg("data after the end"));
  return tooth;
}

void save_tooth_file(const Tooth& tooth, const std::string& path) {
  write_file(path, save_tooth(tooth));
}

Tooth load_tooth_file(const std::string& path) { return load_tooth(read_file(path), path); }

std::string tooth_hash(const Tooth& tooth) {
  ByteWriter content;
  write_tissues(tooth, content);
  tooth.octree.write(content);
  if (!tooth.placed_landmarks.empty()) write_landmarks(tooth, content);
  return to_hex(sha256(content.bytes()));
}

}  // namespace cavum
