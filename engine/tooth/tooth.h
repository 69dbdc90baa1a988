// A tooth: its octree, what its labels mean, and where it comes from. Frame: origin at the crown's
// centre, +z occlusal, +x mesial, +y buccal, mm.
#pragma once

#include <string>
#include <vector>

#include "engine/tooth/octree.h"
#include "engine/tooth/tooth_number.h"
#include "engine/tooth/tooth_source.h"

namespace cavum {

/// A place with a name, mm of the tooth frame.
struct NamedPoint {
  std::string name;  ///< of docs/anatomy.md: `central_pit`, `cusp_2`
  Vec3 at_mm;
  friend bool operator==(const NamedPoint&, const NamedPoint&) = default;
};

/// What is to be known of a tooth beside where it comes from: told by the shape and said by nobody;
/// not checked, or confirmed against what was measured; of the mirror image of what was read (+x
/// mesial and +y buccal do not go together on it otherwise).
struct ToothNote {
  enum class Kind : std::uint8_t { guess, warning, mirror_image };
  Kind kind = Kind::guess;
  Message text;
  friend bool operator==(const ToothNote&, const ToothNote&) = default;
};

/// What is said of a tooth beside its shape.
struct ToothFacts {
  std::string name;  ///< for people: "lower first molar (parametric)"
  ToothKind kind;    ///< which one of the jaw
  ToothSource
      source;  ///< what it was made from, and every assumption made on the way (spacing, frame)
  std::vector<NamedPoint>
      placed_landmarks;  ///< that a person put; they stand in place of what find_landmarks finds
  std::vector<ToothNote> notes;
};

struct Tooth : ToothFacts {
  Octree octree;
  std::vector<Tissue> tissues = standard_tissues();

  /// Name of a tissue id; "air" for 0, "tissue N" for one that the table does not list.
  [[nodiscard]] std::string tissue_name(std::uint8_t id) const;
  [[nodiscard]] std::vector<Message> notes_of(ToothNote::Kind kind) const;
  /// Id of a named tissue; throws Error when the tooth has none of that name.
  [[nodiscard]] std::uint8_t tissue_id(const std::string& name) const;
};

/// The most landmarks that a person may put on one tooth, and the longest of their names, bytes.
inline constexpr std::size_t k_max_placed = 64, k_longest_landmark_name = 32;

/// The compact tooth file (`.cvt`), layout in tooth_file.cpp. The same tooth always gives the same
/// bytes. Throws Error when there are more landmarks than above, or one with a name that is empty,
/// too long, twice there, or no plain text, or with a place that is not finite.
[[nodiscard]] Bytes save_tooth(const Tooth& tooth);
/// Reads a compact tooth file held in memory; `where` names it in errors. Throws Error on any
/// damage.
[[nodiscard]] Tooth load_tooth(std::span<const std::uint8_t> bytes, const std::string& where);

void save_tooth_file(const Tooth& tooth, const std::string& path);
[[nodiscard]] Tooth load_tooth_file(const std::string& path);

/// SHA-256 (hex) of tissues, octree and, where there are any, placed landmarks; name, kind and
/// source do not count. What sessions and scenarios pin.
[[nodiscard]] std::string tooth_hash(const Tooth& tooth);

}  // namespace cavum
