// Bodies as signed distance: negative inside, mm. Exact for the primitive bodies, near their
// surface also for columns and combined ones; zone_map.h makes true distances of them.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <vector>

#include "engine/base/message.h"
#include "engine/tooth/anatomy/landmarks.h"
#include "engine/tooth/tooth.h"
#include "scenarios/file/scenario.h"
#include "scenarios/zones/relief.h"
#include "scenarios/zones/zone_work.h"

namespace cavum::scenarios {

class Shape {
 public:
  virtual ~Shape() = default;
  /// Signed distance at a point of the tooth frame, mm. Where it is not a true distance it keeps
  /// its sign.
  [[nodiscard]] virtual double distance_mm(Vec3 p) const noexcept = 0;
  /// How many pieces are looked at for one distance, at a leaf's centre.
  [[nodiscard]] virtual std::uint64_t pieces() const noexcept { return 1; }
};

/// A right-handed frame: x and y across a body, z along its axis.
struct ShapeFrame {
  Vec3 at, x, y, z;
  [[nodiscard]] Vec3 local(Vec3 p) const noexcept {
    return {dot(p - at, x), dot(p - at, y), dot(p - at, z)};
  }
};
/// That of a body which has a place, an axis and a turn about it.
[[nodiscard]] ShapeFrame shape_frame(const ShapeSpec& spec);

/// "file:line:column" of a shape.
[[nodiscard]] FileLocation location_text(const std::string& file, const ShapeSpec& spec);

/// Makes bodies for one tooth; keeps what they have in common (surface, pulp chamber).
class ShapeMaker {
 public:
  /// `where` names the scenario in errors. `landmarks`: those of the tooth, where they are known
  /// already.
  ShapeMaker(const Tooth& tooth, std::string where, std::optional<Landmarks> landmarks = {});
  ~ShapeMaker();
  /// The bodies of a list combined in their order. Throws Error when the tooth lacks what a body
  /// refers to, and beyond a limit of zone_work.h.
  [[nodiscard]] std::unique_ptr<Shape> make(const std::vector<ShapeSpec>& list);
  /// The tooth without what stands beside it: columns, landmarks and boxes are laid by it, tissues
  /// by the whole.
  [[nodiscard]] const Tooth& own();
  /// What stands beside it, as a body, within a box of leaves (`high` exclusive); null where
  /// nothing does. Beyond the box it says nothing.
  [[nodiscard]] std::unique_ptr<Shape> beside(IVec3 low, IVec3 high);
  /// Of the tooth alone.
  [[nodiscard]] const ColumnMap& surface();
  /// Where the tooth's cusps, fissures and ridges are; found when they are first asked for.
  [[nodiscard]] const Landmarks& landmarks();
  /// Of a tissue or its chamber. Throws Error when the tooth has none.
  [[nodiscard]] const TissueRelief& relief(const std::string& tissue, TissuePart part,
                                           const Message& where);
  /// The way in that a body of the list tells, unit, out of the tooth: its axis, or what it took
  /// from landmarks when it was made.
  [[nodiscard]] Vec3 way_in(const ShapeSpec& spec) const;
  void set_way_in(const ShapeSpec& spec, Vec3 way);
  /// With what stands beside it.
  [[nodiscard]] const Tooth& tooth() const noexcept { return tooth_; }
  [[nodiscard]] ZoneWork& work() noexcept { return work_; }

 private:
  struct Cache;
  const Tooth& tooth_;
  std::string where_;
  ZoneWork work_;
  std::unique_ptr<Cache> cache_;
};

/// What each row of bodies_table.inc is on a tooth; `where` names it in errors. Each in a source of
/// its own, some in that of their like.
#define BODY(KIND, ...)                                                                      \
  [[nodiscard]] std::unique_ptr<Shape> body_##KIND(const ShapeSpec& spec, ShapeMaker& maker, \
                                                   const Message& where);
#include "scenarios/file/bodies_table.inc"

}  // namespace cavum::scenarios
