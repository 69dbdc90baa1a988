// A tooth: its octree, what its labels mean, and where it comes from. Frame: origin at the crown's
// centre, +z occlusal, +x mesial, +y buccal, mm.
#pragma once

#include <string>
#include <vector>

#include "engine/tooth/octree.h"

namespace cavum {

struct Tooth {
  Octree octree;
  std::vector<Tissue> tissues = standard_tissues();
  std::string name;    ///< for people: "lower first molar (parametric)"
  std::string source;  ///< what it was made from, and every assumption made on the way (spacing, frame)

  /// Name of a tissue id; "air" for 0, "tissue N" for one that the table does not list.
  [[nodiscard]] std::string tissue_name(std::uint8_t id) const;
  /// Id of a named tissue; throws Error when the tooth has none of that name.
  [[nodiscard]] std::uint8_t tissue_id(const std::string& name) const;
};

/// The compact tooth file (`.cvt`), layout in tooth_file.cpp. The same tooth always gives the same bytes.
[[nodiscard]] Bytes save_tooth(const Tooth& tooth);
/// Reads a compact tooth file held in memory; `where` names it in errors. Throws Error on any damage.
[[nodiscard]] Tooth load_tooth(std::span<const std::uint8_t> bytes, const std::string& where);

void save_tooth_file(const Tooth& tooth, const std::string& path);
[[nodiscard]] Tooth load_tooth_file(const std::string& path);

/// SHA-256 (hex) of tissues and octree; name and source do not count. What sessions and scenarios pin.
[[nodiscard]] std::string tooth_hash(const Tooth& tooth);

}  // namespace cavum
