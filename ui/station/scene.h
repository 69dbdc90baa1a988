// The picture of the work: tooth, diamond point and handpiece, lit by a lamp beside the eye and one from the upper left. In practice the tooth is
// as clear as water, with the pulp and what is to be removed in colour within; an exam shows none of that.
#pragma once

#include <memory>
#include <vector>

#include "engine/base/pose.h"
#include "engine/instrument/diamond_point.h"
#include "scenarios/zones/zone_map.h"
#include "ui/station/camera.h"
#include "ui/station/gpu.h"
#include "ui/station/tooth_drawing.h"

namespace cavum::station {

/// What is to be seen.
struct SceneView {
  Camera camera;
  Pose tool;              ///< tip as the tooth allows it
  int point = -1;         ///< of the tray; -1 = no instrument
  bool cutting = false;   ///< for now drawn like a point at rest
  bool handpiece = true;  ///< its head, half transparent
  bool clear = false;     ///< practice: look through the tooth
  bool stereo = false;    ///< one picture for each eye, side by side
  bool high_contrast = false;
};

class Scene {
 public:
  /// `target`: of practice; null = none is shown.
  Scene(const Octree& tooth, const std::vector<Tissue>& tissues, const std::vector<DiamondPoint>& tray, const scenarios::ZoneMap* target);

  [[nodiscard]] ToothDrawing& tooth() noexcept { return tooth_; }
  /// Bodies seen through clear tissue, one over the other in this order, in the colours and opacities of their corners.
  void show_bodies(std::vector<GpuMesh> bodies);
  /// A texture of this size with the picture; drawn again only when something differs. `samples` a pixel.
  [[nodiscard]] unsigned picture(const SceneView& view, int width, int height, int samples);
  /// Pictures drawn so far.
  [[nodiscard]] std::uint64_t drawn() const noexcept { return drawn_; }

 private:
  /// How one eye looks.
  struct Lens {
    glm::mat4 look, projection;
    ToothDrawing::Sight sight;
  };
  void draw_eye(const SceneView& view, int eye, int x, int width, int height);
  void draw_point(const SceneView& view);
  /// The target through hard tissue that is clear as glass.
  void draw_clear_tissue(const SceneView& view, const Lens& lens);
  void draw_bodies(const SceneView& view, const Lens& lens);
  void draw_handpiece(const SceneView& view, const Lens& lens, float opacity);
  void light(const ShaderProgram& program, const SceneView& view, const Lens& lens) const;
  [[nodiscard]] std::vector<glm::vec3> colours(bool high_contrast) const;

  ToothDrawing tooth_;
  std::vector<Tissue> tissues_;
  std::vector<GpuMesh> points_, bodies_;
  GpuMesh handpiece_, target_;
  ShaderProgram tissue_program_, plain_program_;
  RenderTarget target_picture_;
  SceneView shown_;
  std::uint64_t shown_version_ = 0;
  int shown_samples_ = 0;
  std::uint64_t drawn_ = 0;
};

/// The surface of what is to be removed, as a mesh in the colour of targets.
[[nodiscard]] struct MeshData target_mesh(const scenarios::ZoneMap& zones);

}  // namespace cavum::station
