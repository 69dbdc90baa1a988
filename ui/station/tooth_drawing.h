// The tooth on the graphics card: what the surface's patches are, kept up with what was cut. Taking what changed is short and needs the tooth to
// stand still; making meshes of it and sending them on comes afterwards.
#pragma once

#include <optional>
#include <vector>

#include "ui/station/gpu.h"

namespace cavum {

class ToothDrawing {
 public:
  /// `with_pulp`: also the pulp by itself, for looking through the tooth.
  ToothDrawing(const Octree& tooth, bool with_pulp);

  /// Takes what differs in `now`, while it stands still.
  void take(const Octree& now) { leaves_.take(now, changed_); }
  /// Meshes and sends on what was taken. Returns how many patches changed.
  std::size_t update();

  void draw_hard_tissue() const { draw(hard_); }
  void draw_pulp() const {
    if (pulp_) draw(*pulp_);
  }
  [[nodiscard]] std::size_t triangles() const noexcept { return hard_.surface.triangle_count(); }
  /// Changes with each update that changed anything.
  [[nodiscard]] std::uint64_t version() const noexcept { return version_; }

 private:
  struct Drawn {
    SurfacePatches surface;
    std::vector<GpuMesh> meshes;  // by patch
  };
  [[nodiscard]] static Drawn made(SurfacePatches surface);
  static void draw(const Drawn& drawn);
  std::size_t update(Drawn& drawn);

  LeafBlocks leaves_;
  Drawn hard_;
  std::optional<Drawn> pulp_;
  std::vector<LeafBox> changed_;
  std::vector<std::uint32_t> touched_;
  std::uint64_t version_ = 1;
};

}  // namespace cavum
