// The tooth on the graphics card, kept up with what was cut. Taking what changed is short and needs
// the tooth to stand still; making meshes of it and sending them on comes afterwards. Blocks of
// 5x5x5 patches are one mesh each. Patches that were cut are finer than the others.
#pragma once

#include <vector>

#include "ui/station/gpu.h"
#include "ui/station/thinned_patch.h"
#include "ui/station/tooth_shading.h"

namespace cavum::station {

class ToothDrawing {
 public:
  explicit ToothDrawing(const Octree& tooth);

  /// Takes what differs in `now`, while it stands still.
  void take(const Octree& now) { leaves_.take(now, changed_); }
  /// Meshes and sends on what was taken. Returns how many patches changed.
  std::size_t update();

  /// What cannot be seen is left out: blocks that face away from the eye or lie outside the
  /// picture. `eye_mm`: where the eye is; `to_picture`: from the tooth frame to the picture.
  struct Sight {
    glm::vec3 eye_mm;
    glm::mat4 to_picture;
  };
  void draw_hard_tissue(const Sight& sight, DrawCount& count) const { draw(hard_, sight, count); }
  /// Only the blocks that come within a ball, or only those that do not.
  struct Ball {
    glm::vec3 middle_mm;
    float radius_mm;
    bool within;
  };
  void draw_hard_tissue(const Sight& sight, DrawCount& count, const Ball& ball) const {
    draw(hard_, sight, count, false, &ball);
  }
  /// Where it lies open: its border with the hard tissue is the same surface as the chamber's wall.
  void draw_open_pulp(const Sight& sight, DrawCount& count) const {
    draw(pulp_, sight, count, true);
  }
  void draw_pulp(const Sight& sight, DrawCount& count) const { draw(pulp_, sight, count); }
  /// Distance to the hard tissue, mm, negative inside; no more than two leaves either way.
  [[nodiscard]] double distance_mm(Vec3 at_mm) const;
  /// Corners of a box around all of it.
  [[nodiscard]] const std::array<glm::vec3, 2>& box_mm() const noexcept { return box_mm_; }
  /// Of the hard tissue, if nothing were thinned.
  [[nodiscard]] std::size_t triangles() const noexcept { return hard_.surface.triangle_count(); }
  /// Of the hard tissue as it is drawn, from all sides.
  [[nodiscard]] std::size_t triangles_kept() const noexcept;
  /// Changes with each update that changed anything.
  [[nodiscard]] std::uint64_t version() const noexcept { return version_; }

 private:
  /// A ball around a block, and a cone around its triangles' normals.
  struct Extent {
    glm::vec3 middle_mm{0}, axis{0};
    float radius_mm = 0.0F, sine = 1.0F;  // of the cone's half angle; 1 = faces every way
  };
  struct Patch {
    bool cut = false;   // finer than what nobody worked on
    bool old = true;    // to be made anew
    bool open = false;  // air beside it
    std::vector<ToothVertex> vertices;
    std::vector<std::array<std::uint16_t, 3>> triangles;
  };
  struct Block {
    bool old = false, open = false;
    GpuMesh mesh;
    Extent extent;
  };
  struct Drawn {
    SurfacePatches surface;
    std::uint8_t own;  // tissue, k_air = hard tissue
    std::vector<Patch> patches;
    std::vector<Block> blocks;
    std::vector<std::uint32_t> dim;  // patches whose light changed since they were made
  };
  [[nodiscard]] Drawn made(std::uint8_t own);
  [[nodiscard]] static Extent extent_of(std::span<const ToothVertex> vertices,
                                        std::span<const std::uint32_t> indices);
  void draw(const Drawn& drawn, const Sight& sight, DrawCount& count, bool open_alone = false,
            const Ball* ball = nullptr) const;
  std::size_t update(Drawn& drawn);
  /// Patches touched become finer; and what is in reach of their light.
  void mark(Drawn& drawn, std::span<const std::uint32_t> touched);
  void remake(Drawn& drawn, std::uint32_t number);
  void send(Drawn& drawn, std::size_t block);
  [[nodiscard]] IVec3 place_of(std::uint32_t number) const;
  [[nodiscard]] std::uint32_t number_of(IVec3 patch) const;
  [[nodiscard]] std::size_t block_of(IVec3 patch) const;
  template <class Visit>
  void for_each_around(IVec3 patch, int reach, const Visit& visit) const;

  bool by_processor_;
  LeafBlocks leaves_;
  ToothShading shading_;
  IVec3 size_, blocks_;                // patches and blocks along x, y, z
  std::vector<ToothVertex> vertices_;  // of a block, while it is made
  std::vector<std::uint32_t> indices_;
  Drawn hard_, pulp_;
  std::array<glm::vec3, 2> box_mm_{};
  std::vector<LeafBounds> changed_;
  std::vector<std::uint32_t> touched_;
  std::uint64_t version_ = 1;
};

}  // namespace cavum::station
