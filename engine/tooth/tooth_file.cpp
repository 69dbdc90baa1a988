// Compact tooth file, version 1, little-endian:
//   "CVTOOTH1"            8 bytes
//   u64 body size         bytes of the body before compression
//   u64 packed size       bytes that follow
//   zstd frame            the body
//   SHA-256               32 bytes, over all of the above
// Body: name, source (u32 length + text), tissue count u8, each tissue {u8 id, u8 solid, name}, then the
// octree (Octree::write: leaf, origin, size, and three streams: shape, labels, distance differences).
#include <zstd.h>

#include <algorithm>
#include <memory>

#include "engine/base/error.h"
#include "engine/base/file.h"
#include "engine/base/hash.h"
#include "engine/base/text.h"
#include "engine/tooth/tooth.h"

namespace cavum {
namespace {

constexpr char k_magic[] = "CVTOOTH1";
constexpr std::uint64_t k_largest_body = 1ULL << 31;

void write_content(const Tooth& tooth, ByteWriter& out) {
  out.put(static_cast<std::uint8_t>(tooth.tissues.size()));
  for (const auto& t : tooth.tissues) {
    out.put(t.id);
    out.put(static_cast<std::uint8_t>(t.solid));
    out.put_string(t.name);
  }
  tooth.octree.write(out);
}

}  // namespace

std::string Tooth::tissue_name(std::uint8_t id) const {
  if (id == k_air) return "air";
  for (const auto& t : tissues)
    if (t.id == id) return t.name;
  return "tissue " + std::to_string(id);
}

std::uint8_t Tooth::tissue_id(const std::string& wanted) const {
  for (const auto& t : tissues)
    if (t.name == wanted) return t.id;
  throw Error("tooth '" + name + "'", "has no tissue named '" + wanted + "'", "use one that `cavum tooth info` lists");
}

Bytes save_tooth(const Tooth& tooth) {
  ByteWriter body;
  body.put_string(tooth.name);
  body.put_string(tooth.source);
  write_content(tooth, body);
  Bytes packed(ZSTD_compressBound(body.bytes().size()));
  const auto n = ZSTD_compress(packed.data(), packed.size(), body.bytes().data(), body.bytes().size(), 19);
  if (ZSTD_isError(n)) throw Error("tooth", ZSTD_getErrorName(n), "free some memory and try again");
  ByteWriter out;
  for (const char* c = k_magic; *c != 0; ++c) out.put(*c);
  out.put(static_cast<std::uint64_t>(body.bytes().size()));
  out.put(static_cast<std::uint64_t>(n));
  out.put_bytes(std::span(packed).first(n));
  const Sha256 sum = sha256(out.bytes());
  out.put_bytes(sum);
  return out.take();
}

Tooth load_tooth(std::span<const std::uint8_t> bytes, const std::string& where) {
  ByteReader in(bytes, where);
  const auto magic = in.get_bytes(std::min<std::size_t>(8, bytes.size()));
  if (!std::equal(magic.begin(), magic.end(), k_magic, k_magic + 8))
    throw Error(where, "not a Cavum tooth file of version 1", "make or import the tooth again with `cavum tooth`");
  const auto body_size = in.get<std::uint64_t>();
  const auto packed_size = in.get<std::uint64_t>();
  if (body_size > k_largest_body || packed_size > in.left()) in.fail("the sizes in the header do not fit the file");
  const auto packed = in.get_bytes(packed_size);
  const auto sum = in.get_bytes(32);
  if (in.left() != 0) in.fail("data after the end");
  const Sha256 expected = sha256(bytes.first(bytes.size() - 32));
  if (!std::equal(sum.begin(), sum.end(), expected.begin())) in.fail("the checksum does not match");
  Bytes body(body_size);
  const auto n = ZSTD_decompress(body.data(), body.size(), packed.data(), packed.size());
  if (ZSTD_isError(n) || n != body_size) in.fail("the compressed data are damaged");

  ByteReader from(body, where);
  Tooth tooth;
  tooth.name = one_line(from.get_string());
  tooth.source = one_line(from.get_string());
  tooth.tissues.resize(from.get<std::uint8_t>());
  for (auto& t : tooth.tissues) {
    t.id = from.get<std::uint8_t>();
    t.solid = from.get<std::uint8_t>() != 0;
    t.name = from.get_string();
    if (!is_plain_text(t.name)) from.fail("the name of tissue " + std::to_string(t.id) + " cannot be read");
  }
  tooth.octree = Octree::read(from, tooth.tissues);
  return tooth;
}

void save_tooth_file(const Tooth& tooth, const std::string& path) { write_file(path, save_tooth(tooth)); }

Tooth load_tooth_file(const std::string& path) { return load_tooth(read_file(path), path); }

std::string tooth_hash(const Tooth& tooth) {
  ByteWriter content;
  write_content(tooth, content);
  return to_hex(sha256(content.bytes()));
}

}  // namespace cavum
