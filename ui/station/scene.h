// The picture of the work: tooth, bur and handpiece, lit by a lamp over the mouth, whose shadows
// show how far the head is from what it will touch, and by the room. A soft dark ring says that it
// touches. In practice the tooth is as clear as water, with the pulp and what is to be removed in
// colour within; an exam shows none of that. How much is done for a picture follows what the last
// ones took.
#pragma once

#include <map>
#include <memory>
#include <optional>
#include <vector>

#include "engine/base/pose.h"
#include "engine/physics/bur/bur.h"
#include "scenarios/zones/zone_map.h"
#include "ui/station/camera.h"
#include "ui/station/effects.h"
#include "ui/station/gpu.h"
#include "ui/station/light.h"
#include "ui/station/spray.h"
#include "ui/station/tooth_drawing.h"

namespace cavum::station {

/// What is to be seen.
struct SceneView {
  Camera camera;
  Pose tool;     ///< tip as the tooth allows it
  int bur = -1;  ///< of the tray; -1 = no instrument
  bool pressed =
      false;  ///< the tooth holds the instrument, also by its side or shank: seen where it is
  float spin_rad = 0;     ///< how far the running bur has turned, as shown
  bool handpiece = true;  ///< shown; it fades where one looks along it
  bool foot = true;       ///< the ring on the tissue below the head, wider the higher the head is
  bool drops = true;      ///< spray and chips, where effects have any
  Spray spray;            ///< what flies
  bool clear = false;     ///< practice: look through the tooth
  bool stereo = false;    ///< one picture for each eye, side by side
  bool high_contrast = false;
};

/// The running bur turns as far as an eye can follow from one picture to the next.
void turn_bur(SceneView& view, double rpm, double frame_s);

// What the table of an instrument's distances covers, tool frame, and where in it a place lies;
// higher than the last, a head has no ring below it.
inline constexpr float k_widest_mm = 3.0F, k_lowest_mm = -1.5F, k_highest_mm = 8.5F;
inline constexpr glm::vec3 k_tool_table(1.0F / k_widest_mm, 1.0F / (k_highest_mm - k_lowest_mm),
                                        -k_lowest_mm / (k_highest_mm - k_lowest_mm));
inline constexpr float k_foot_ends_mm = 5.0F;
[[nodiscard]] glm::mat4 to_glm(const Pose& pose);
/// 0 to 1: a handpiece would hide the work from whoever looks along it.
[[nodiscard]] float handpiece_opacity(const SceneView& view, int eye);

class Scene {
 public:
  /// `target`: of practice; null = none is shown.
  Scene(const Octree& tooth, const std::vector<Tissue>& tissues, const std::vector<Bur>& tray,
        const scenarios::ZoneMap* target);

  [[nodiscard]] ToothDrawing& tooth() noexcept { return tooth_; }
  /// Bodies seen through clear tissue, one over the other in this order, in the colours and
  /// opacities of their corners.
  void show_bodies(std::vector<GpuMesh> bodies);
  /// A texture with the picture for this size; drawn again only when something differs.
  [[nodiscard]] unsigned picture(const SceneView& view, int width, int height);
  /// Pictures drawn so far.
  [[nodiscard]] std::uint64_t drawn() const noexcept { return drawn_; }
  /// What the last drawn picture took.
  [[nodiscard]] const DrawCount& counted() const noexcept { return count_; }
  /// Of `k_effects`: as the computer keeps up with, or as set.
  [[nodiscard]] std::size_t effects_level() const noexcept {
    return fixed_level_.value_or(governor_.level());
  }
  void fix_effects(std::optional<std::size_t> level) { fixed_level_ = level; }

 private:
  /// Those of a level of effects.
  struct Programs {
    explicit Programs(const Effects& effects);
    std::unique_ptr<ShaderProgram> tooth, touched_tooth, metal;
  };
  /// What the shadow of the tooth alone depends on.
  struct ShadowOf {
    std::uint64_t version = 0;
    float turn_deg = 0;
    glm::vec3 target_mm{0};
    [[nodiscard]] bool same_lamp(const ShadowOf& other) const {
      return turn_deg == other.turn_deg && target_mm == other.target_mm;
    }
  };
  /// How much the head touches, 0..1.
  [[nodiscard]] float touch(const SceneView& view) const;
  /// How far down along its axis the head is free, mm; 5 and a little at most.
  [[nodiscard]] float above_mm(const SceneView& view) const;
  void cast_shadows(const SceneView& view, const Effects& effects);
  void draw_eye(const SceneView& view, int eye, int x, int width, int height,
                const Programs& programs);
  void draw_tooth(const SceneView& view, const ToothDrawing::Sight& sight,
                  const Programs& programs);
  /// The target through hard tissue that is clear as glass.
  void draw_clear_tissue(const SceneView& view, const ToothDrawing::Sight& sight,
                         const Programs& programs);
  void draw_bodies(const SceneView& view, const ToothDrawing::Sight& sight);
  /// Spray and chips, with the tooth before them.
  void draw_drops(const SceneView& view, const ToothDrawing::Sight& sight, float width,
                  float height);
  [[nodiscard]] bool has_drops(const SceneView& view) const;
  void draw_metal(const GpuMesh& mesh, const ShaderProgram& metal, float opacity);
  /// Where something is drawn, pixels: from x, y to x, y.
  [[nodiscard]] glm::ivec4 rectangle_drawn(const SceneView& view, int width, int height) const;
  void smooth_edges(const SceneView& view);
  void light(const ShaderProgram& program, const SceneView& view,
             const ToothDrawing::Sight& sight) const;
  [[nodiscard]] const Programs& programs(const Effects& effects);
  [[nodiscard]] bool has_tool(const SceneView& view) const;
  [[nodiscard]] static glm::mat4 tool_matrix(const SceneView& view);
  [[nodiscard]] static glm::vec3 background_of(const SceneView& view);
  /// Linear.
  [[nodiscard]] std::vector<glm::vec3> colours(bool high_contrast) const;

  ToothDrawing tooth_;
  std::vector<Tissue> tissues_;
  std::vector<GpuMesh> heads_, shanks_, bodies_;
  std::vector<Table2D> distances_;  // of the burs
  std::vector<std::vector<Vec3>> surfaces_,
      ends_;                      // of the whole heads; of their lowest millimetre
  std::vector<double> radii_mm_;  // of the heads
  GpuMesh handpiece_, target_;
  GpuDrops drops_;
  ShaderProgram depth_program_, plain_program_, glass_program_, drop_program_, smooth_program_;
  std::map<std::pair<int, bool>, std::unique_ptr<Programs>> programs_;  // by taps and reflections
  EffectGovernor governor_;
  std::optional<std::size_t> fixed_level_;
  Room room_;
  Lamp lamp_;
  DepthMap resting_shadow_, shadow_,
      no_shadow_;  // of the tooth alone; with the instrument; of nothing
  ShadowOf resting_;
  int cuts_in_a_row_ = 0;  // pictures for each of which the tooth was another
  RenderTarget target_picture_, smoothed_;
  WholePicture whole_picture_;
  SceneView shown_;
  std::uint64_t shown_version_ = 0;
  glm::ivec2 shown_size_{0};
  std::size_t shown_level_ = 0;
  unsigned shown_texture_ = 0;
  DrawCount count_;
  std::uint64_t drawn_ = 0;
};

/// The surface of what is to be removed, as a mesh in the colour of targets.
[[nodiscard]] struct MeshData target_mesh(const scenarios::ZoneMap& zones);

}  // namespace cavum::station
