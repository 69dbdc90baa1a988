// The tooth on the graphics card: what the surface's patches are, kept up with what was cut. Taking what changed is short and needs the tooth to
// stand still; making meshes of it and sending them on comes afterwards.
#pragma once

#include <vector>

#include "ui/station/gpu.h"

namespace cavum::station {

class ToothDrawing {
 public:
  explicit ToothDrawing(const Octree& tooth);

  /// Takes what differs in `now`, while it stands still.
  void take(const Octree& now) { leaves_.take(now, changed_); }
  /// Meshes and sends on what was taken. Returns how many patches changed.
  std::size_t update();

  /// What cannot be seen is left out: patches that face away from the eye or lie outside the picture. `eye_mm`: where the eye is; `to_picture`: from
  /// the tooth frame to the picture.
  struct Sight {
    glm::vec3 eye_mm;
    glm::mat4 to_picture;
  };
  void draw_hard_tissue(const Sight& sight) const { draw(hard_, sight, by_processor_); }
  /// Only its outside: its border with the hard tissue is the same surface as the chamber's wall.
  void draw_pulp(const Sight& sight) const { draw(pulp_, sight, by_processor_); }
  [[nodiscard]] std::size_t triangles() const noexcept { return hard_.surface.triangle_count(); }
  /// Changes with each update that changed anything.
  [[nodiscard]] std::uint64_t version() const noexcept { return version_; }

 private:
  /// A ball around a patch, and a cone around its triangles' normals.
  struct Extent {
    glm::vec3 middle_mm{0}, axis{0};
    float radius_mm = 0.0F, sine = 1.0F;  // of the cone's half angle; 1 = faces every way
  };
  struct Drawn {
    SurfacePatches surface;
    std::vector<GpuMesh> meshes;  // by patch
    std::vector<Extent> extents;
  };
  [[nodiscard]] static Drawn made(SurfacePatches surface);
  [[nodiscard]] static Extent extent_of(const SurfacePatch& patch);
  static void draw(const Drawn& drawn, const Sight& sight, bool by_processor);
  std::size_t update(Drawn& drawn);

  bool by_processor_;
  LeafBlocks leaves_;
  Drawn hard_, pulp_;
  std::vector<LeafBox> changed_;
  std::vector<std::uint32_t> touched_;
  std::uint64_t version_ = 1;
};

}  // namespace cavum::station
