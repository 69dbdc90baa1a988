// The target as faulty preparations are made from: as it is, and open along the way in; in a frame
// whose z is that way in. Displaced work must be possible from outside, so whatever lies above what
// is cut goes, too.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "scenarios/zones/shape.h"
#include "scenarios/zones/zone_map.h"

namespace cavum::grading {

/// A leaf of the target in the frame of the way in, mm.
struct TargetLeaf {
  Vec3 at;
  std::uint8_t tissue = k_air;
};

class TargetField {
 public:
  /// `tooth` and `zones` must outlive it.
  TargetField(const Tooth& tooth, const scenarios::ZoneMap& zones);

  /// From the tooth frame into that of the way in: z out of the tooth, mm.
  [[nodiscard]] Vec3 local(Vec3 p) const noexcept { return frame_.local(p); }
  [[nodiscard]] Vec3 in_tooth(Vec3 q) const noexcept {
    return frame_.at + frame_.x * q.x + frame_.y * q.y + frame_.z * q.z;
  }
  [[nodiscard]] const Tooth& tooth() const noexcept { return tooth_; }
  /// Signed distance to the target's surface at a place of the tooth frame, mm, negative inside.
  [[nodiscard]] double target_mm(Vec3 p) const noexcept { return zones_.distance_mm(p); }
  /// The same of the target with all that lies above it on the way in, at a place of the local
  /// frame; near its surface a distance.
  [[nodiscard]] double open_mm(Vec3 q) const noexcept;
  /// Height of the target's floor below or above a place, mm, local; beside the target that of the
  /// nearest place.
  [[nodiscard]] double floor_mm(Vec3 q) const noexcept;
  [[nodiscard]] const std::vector<TargetLeaf>& leaves() const noexcept { return leaves_; }
  /// Corners of the box around the target's leaves, local, mm.
  [[nodiscard]] Vec3 low_mm() const noexcept { return box_mm_.low; }
  [[nodiscard]] Vec3 high_mm() const noexcept { return box_mm_.high; }
  /// Mean height of the target's highest leaves, column by column: the level of the opening, local,
  /// mm.
  [[nodiscard]] double opening_mm() const noexcept { return opening_mm_; }
  /// Mean height of the target over its own floor, column by column, mm.
  [[nodiscard]] double mean_depth_mm() const noexcept { return mean_depth_mm_; }
  /// Where a tissue lies nearest below the target's floor: the floor there, and the tissue. None
  /// within 8 mm.
  struct Below {
    Vec3 floor, tissue;
  };
  [[nodiscard]] std::optional<Below> below(const std::string& tissue) const;

 private:
  void read_leaves();
  void lay_open();
  void lay_floor();
  [[nodiscard]] std::size_t column(int x, int y) const noexcept {
    return static_cast<std::size_t>(y) * static_cast<std::size_t>(nx_) +
           static_cast<std::size_t>(x);
  }
  [[nodiscard]] Vec3 cell_mm(int x, int y, int z) const noexcept {
    return origin_ + Vec3{double(x), double(y), double(z)} * leaf_mm_;
  }

  const Tooth& tooth_;
  const scenarios::ZoneMap& zones_;
  scenarios::ShapeFrame frame_;
  double leaf_mm_;
  std::vector<TargetLeaf> leaves_;
  Bounds box_mm_;
  double opening_mm_ = 0.0, mean_depth_mm_ = 0.0;
  Vec3 origin_;  // of the lattice's first cell
  int nx_ = 0, ny_ = 0, nz_ = 0;
  std::vector<float> open_;       // x fastest
  std::vector<float> floor_;      // by column
  std::vector<std::uint8_t> in_;  // 1 for columns of the target itself
};

}  // namespace cavum::grading
