#include "ui/station/scene.h"

#include <epoxy/gl.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <glm/gtc/matrix_transform.hpp>
#include <tuple>

#include "engine/tooth/marching.h"
#include "engine/tooth/surface_mesh.h"
#include "ui/station/instrument_mesh.h"
#include "ui/station/shaders.h"
#include "ui/station/tissue_colours.h"

namespace cavum::station {
namespace {

constexpr int k_colours = 16;  // tissues with a colour of their own; further ones share the last
constexpr glm::vec3 k_night(0.085F, 0.105F, 0.130F);

bool same(const SceneView& a, const SceneView& b) {
  const auto facts = [](const SceneView& v) {
    return std::tie(v.camera, v.bur, v.pressed, v.spin_rad, v.handpiece, v.foot, v.drops, v.spray,
                    v.clear, v.stereo, v.high_contrast);
  };
  return facts(a) == facts(b) && a.tool.tip_mm == b.tool.tip_mm &&
         a.tool.rotation == b.tool.rotation;
}

template <class Make>
std::vector<GpuMesh> meshes_of(const std::vector<Bur>& tray, const Make& make) {
  std::vector<GpuMesh> meshes(tray.size());
  for (std::size_t i = 0; i < tray.size(); ++i) {
    const MeshData data = make(tray[i]);
    meshes[i].put(data.vertices, data.indices);
  }
  return meshes;
}

// The instrument's distance as a table: to the tooth's shader it is what tells how near the head
// is.
constexpr int k_radii = 96, k_heights = 256;

Table2D distances_of(const Bur& bur) {
  std::vector<float> mm;
  for (int j = 0; j < k_heights; ++j)
    for (int i = 0; i < k_radii; ++i)
      mm.push_back(static_cast<float>(bur.profile.distance_mm(
          {(i + 0.5) / k_radii * static_cast<double>(k_widest_mm), 0,
           k_lowest_mm +
               (j + 0.5) / k_heights * static_cast<double>(k_highest_mm - k_lowest_mm)})));
  Table2D table;
  table.put(k_radii, k_heights, 1, mm);
  return table;
}

/// Places of the head's surface, tool frame: enough to tell whether it touches.
std::vector<Vec3> surface_of_head(const Bur& bur, double up_to_mm, int around) {
  constexpr double k_step_mm = 0.12;
  std::vector<Vec3> all;
  for (const auto& p : bur.head.walk(k_step_mm, up_to_mm))
    for (int i = 0; i < around; ++i) {
      const double a = 6.283185307179586 * i / around;
      all.push_back({p.at.r_mm * std::cos(a), p.at.r_mm * std::sin(a), p.at.z_mm});
    }
  return all;
}

/// A renderer on the processor leaves a core to the servo and shows ten pictures a second at least;
/// a graphics card has more to spare.
constexpr double k_budget_by_processor_ms = 60.0, k_budget_ms = 12.0;
constexpr std::size_t k_level_by_processor = 3;

}  // namespace

glm::mat4 to_glm(const Pose& pose) {
  const Mat3 r = rotation(pose.rotation);
  glm::mat4 m(1.0F);
  const auto row = [&m](int i, Vec3 v, double t) {
    m[0][i] = static_cast<float>(v.x);
    m[1][i] = static_cast<float>(v.y);
    m[2][i] = static_cast<float>(v.z);
    m[3][i] = static_cast<float>(t);
  };
  row(0, r.row_x, pose.tip_mm.x);
  row(1, r.row_y, pose.tip_mm.y);
  row(2, r.row_z, pose.tip_mm.z);
  return m;
}

void turn_bur(SceneView& view, double rpm, double frame_s) {
  constexpr double k_two_pi = 6.283185307179586,
                   k_seen_rad = 0.3;  // a third of the way from one band of the head to the next
  view.spin_rad = static_cast<float>(
      std::fmod(view.spin_rad + std::min(k_seen_rad, rpm / 60.0 * k_two_pi * frame_s), k_two_pi));
}

MeshData target_mesh(const scenarios::ZoneMap& zones) {
  const IVec3 size = zones.size();
  std::vector<std::uint8_t> inside;
  std::vector<double> distance;
  const auto at_border = [](int i, int n) { return i == 0 || i == n - 1; };
  zones.for_each_leaf([&](IVec3 leaf, scenarios::Zone zone) {
    const IVec3 l = leaf - zones.low();
    const bool rim = at_border(l.x, size.x) || at_border(l.y, size.y) || at_border(l.z, size.z);
    inside.push_back(zone == scenarios::Zone::target && !rim ? 1 : 0);
    distance.push_back(zones.distance_mm(leaf));
  });
  const auto index = [&size](IVec3 l) {
    return static_cast<std::size_t>((l.z * size.y + l.y) * size.x + l.x);
  };
  const TriangleMesh mesh = march_tetrahedra(
      size, zones.centre_mm(zones.low()), zones.leaf_mm(), inside, [&](IVec3 a, IVec3 b) {
        const double from = distance[index(a)], to = distance[index(b)];
        return from < 0 && to > 0 ? std::clamp(from / (from - to), 0.05, 0.95) : 0.5;
      });
  return smooth_shaded(mesh, k_target_colour);
}

Scene::Programs::Programs(const Effects& effects) {
  const std::string defines =
      "TAPS=" + std::to_string(effects.shadow_taps) + (effects.reflections ? " REFLECTIONS" : "");
  tooth = std::make_unique<ShaderProgram>(tooth_vertex(), tooth_fragment(), defines);
  touched_tooth =
      std::make_unique<ShaderProgram>(tooth_vertex(), tooth_fragment(), defines + " TOOL");
  metal = std::make_unique<ShaderProgram>(metal_vertex(), metal_fragment(), defines);
}

Scene::Scene(const Octree& tooth, const std::vector<Tissue>& tissues, const std::vector<Bur>& tray,
             const scenarios::ZoneMap* target)
    : tooth_(tooth),
      tissues_(tissues),
      heads_(meshes_of(tray, diamond_head_mesh)),
      shanks_(meshes_of(tray, shank_mesh)),
      depth_program_(depth_vertex(), depth_fragment()),
      plain_program_(plain_vertex(), plain_fragment()),
      glass_program_(glass_vertex(), plain_fragment()),
      drop_program_(drop_vertex(), drop_fragment()),
      smooth_program_(WholePicture::vertex_shader, smooth_fragment()),
      governor_(drawn_by_processor()
                    ? EffectGovernor(k_budget_by_processor_ms, k_level_by_processor)
                    : EffectGovernor(k_budget_ms, 0)) {
  for (const Bur& bur : tray) {
    distances_.push_back(distances_of(bur));
    surfaces_.push_back(surface_of_head(bur, bur.cutting_length_mm, 18));
    ends_.push_back(surface_of_head(bur, std::min(1.0, bur.cutting_length_mm), 9));
    radii_mm_.push_back(bur.head_radius_mm);
  }
  const MeshData handpiece = handpiece_mesh();
  handpiece_.put(handpiece.vertices, handpiece.indices);
  if (target != nullptr) {
    const MeshData data = target_mesh(*target);
    target_.put(data.vertices, data.indices);
  }
}

void Scene::show_bodies(std::vector<GpuMesh> bodies) {
  bodies_ = std::move(bodies);
  shown_version_ = 0;  // drawn anew
}

std::vector<glm::vec3> Scene::colours(bool high_contrast) const {
  std::vector<glm::vec3> table(k_colours, tissue_colour("", high_contrast));
  table[k_air] = glm::vec3(0.5F);
  for (const auto& tissues : {standard_tissues(), tissues_})
    for (const Tissue& t : tissues)
      if (t.id < k_colours) table[t.id] = tissue_colour(t.name, high_contrast);
  for (glm::vec3& c : table) c *= c;  // light adds up in linear colours
  return table;
}

const Scene::Programs& Scene::programs(const Effects& effects) {
  auto& made = programs_[{effects.shadow_taps, effects.reflections}];
  if (!made) made = std::make_unique<Programs>(effects);
  return *made;
}

glm::mat4 Scene::tool_matrix(const SceneView& view) {
  return glm::rotate(to_glm(view.tool), view.spin_rad, glm::vec3(0, 0, 1));
}

void Scene::light(const ShaderProgram& program, const SceneView& view,
                  const ToothDrawing::Sight& sight) const {
  program.use();
  program.set("to_picture", sight.to_picture);
  program.set("eye_mm", sight.eye_mm);
  program.set("lamp", lamp_.towards);
  program.set("lamp_colour", glm::vec3(0.66F, 0.61F, 0.54F));
  program.set("to_lamp", lamp_.to_lamp);
  program.set("to_room", lamp_.to_room);
  program.set("falling", std::span(room_.falling()));
  const glm::vec3 background = background_of(view);
  program.set("background", background * background);
  constexpr float k_fade_mm = 44.0F;
  program.set("far_mm", glm::vec2(view.camera.distance_mm + 2.0F, 1.0F / k_fade_mm));
  program.set("shadow_px", 1.0F / static_cast<float>(std::max(1, shadow_.edge())));
  program.set_texture("room", 0, GL_TEXTURE_2D, room_.mirrored().texture());
  program.set("opacity", 1.0F);
  program.set("flat_light", 0.0F);
  program.set("glass", 0.0F);
}

glm::vec3 Scene::background_of(const SceneView& view) {
  return view.high_contrast ? glm::vec3(0) : k_night;
}

bool Scene::has_tool(const SceneView& view) const {
  return view.bur >= 0 && static_cast<std::size_t>(view.bur) < heads_.size();
}

float Scene::touch(const SceneView& view) const {
  if (view.pressed) return 1.0F;
  const Mat3 r = rotation(view.tool.rotation);
  double nearest_mm = 1.0;
  for (const Vec3 p : surfaces_[static_cast<std::size_t>(view.bur)])
    nearest_mm = std::min(
        nearest_mm, tooth_.distance_mm(view.tool.tip_mm +
                                       Vec3{dot(r.row_x, p), dot(r.row_y, p), dot(r.row_z, p)}));
  constexpr float k_touching_mm = 0.03F,
                  k_clear_mm = 0.09F;  // the surface is cut a little wider than the head
  return 1.0F - glm::smoothstep(k_touching_mm, k_clear_mm, static_cast<float>(nearest_mm));
}

float Scene::above_mm(const SceneView& view) const {
  const Mat3 r = rotation(view.tool.rotation);
  const Vec3 axis{r.row_x.z, r.row_y.z, r.row_z.z};
  const auto touches = [&](double down_mm) {
    const Vec3 tip = view.tool.tip_mm - axis * down_mm;
    return std::ranges::any_of(ends_[static_cast<std::size_t>(view.bur)], [&](Vec3 p) {
      return tooth_.distance_mm(tip + Vec3{dot(r.row_x, p), dot(r.row_y, p), dot(r.row_z, p)}) <=
             0.0;
    });
  };
  constexpr double k_step_mm = 0.15;
  double free = 0.0;
  while (free < static_cast<double>(k_foot_ends_mm) && !touches(free + k_step_mm))
    free += k_step_mm;
  double blocked = free + k_step_mm;
  for (int i = 0; i < 4; ++i) {
    const double middle = 0.5 * (free + blocked);
    (touches(middle) ? blocked : free) = middle;
  }
  return static_cast<float>(free);
}

glm::ivec4 Scene::rectangle_drawn(const SceneView& view, int width, int height) const {
  const glm::ivec4 whole(0, 0, width, height);
  const bool tool = has_tool(view);
  if (view.stereo || view.clear || (tool && view.handpiece && handpiece_opacity(view, 0) > 0))
    return whole;
  const glm::mat4 to_picture =
      view.camera.projection(static_cast<float>(width) / static_cast<float>(height)) *
      view.camera.view(0);
  glm::vec2 low(1.0F), high(-1.0F);
  bool behind = false;
  const auto hold = [&](const glm::mat4& model, const std::array<glm::vec3, 2>& box) {
    for (int i = 0; i < 8; ++i) {
      const glm::vec3 corner(box[i & 1].x, box[i >> 1 & 1].y, box[i >> 2].z);
      const glm::vec4 p = to_picture * model * glm::vec4(corner, 1.0F);
      behind = behind || p.w < 1.0F;
      low = glm::min(low, glm::vec2(p) / p.w);
      high = glm::max(high, glm::vec2(p) / p.w);
    }
  };
  hold(glm::mat4(1.0F), tooth_.box_mm());
  constexpr float k_widest = 1.5F, k_longest = 13.2F;
  const float wide = has_drops(view) ? k_spray_reach_mm : k_widest;
  if (tool)
    hold(to_glm(view.tool), {glm::vec3(-wide, -wide, -0.2F), glm::vec3(wide, wide, k_longest)});
  if (behind) return whole;
  const glm::vec2 size(width, height), from = glm::clamp(0.5F + 0.5F * low, 0.0F, 1.0F) * size,
                                       to = glm::clamp(0.5F + 0.5F * high, 0.0F, 1.0F) * size;
  return {static_cast<int>(from.x), static_cast<int>(from.y), static_cast<int>(std::ceil(to.x)),
          static_cast<int>(std::ceil(to.y))};
}

void Scene::smooth_edges(const SceneView& view) {
  smoothed_.resize(target_picture_.width(), target_picture_.height(), 1);
  smoothed_.begin(background_of(view));
  const glm::ivec4 rectangle = rectangle_drawn(view, smoothed_.width(), smoothed_.height());
  glEnable(GL_SCISSOR_TEST);
  glScissor(rectangle.x, rectangle.y, std::max(0, rectangle.z - rectangle.x),
            std::max(0, rectangle.w - rectangle.y));
  smooth_program_.use();
  smooth_program_.set_texture("drawn", 0, GL_TEXTURE_2D, target_picture_.texture());
  smooth_program_.set("pixel_size", glm::vec2(1.0F / static_cast<float>(smoothed_.width()),
                                              1.0F / static_cast<float>(smoothed_.height())));
  whole_picture_.draw(count_);
  glDisable(GL_SCISSOR_TEST);
  smoothed_.end();
}

unsigned Scene::picture(const SceneView& view, int width, int height) {
  width = std::max(width, 16);
  height = std::max(height, 16);
  const std::size_t level = effects_level();
  const Effects& effects = k_effects[level];
  const bool current = drawn_ > 0 && same(view, shown_) && shown_version_ == tooth_.version() &&
                       shown_size_ == glm::ivec2(width, height) && shown_level_ == level &&
                       (view.clear || resting_.version == shown_version_);
  if (current) return shown_texture_;
  const auto began = std::chrono::steady_clock::now();
  count_ = {};
  const auto scaled = [&effects](int pixels) {
    return static_cast<int>(std::lround(effects.scale * static_cast<float>(pixels)));
  };
  const int wide = scaled(width), high = scaled(height);
  const Programs& made = programs(effects);
  if (no_shadow_.resize(1)) no_shadow_.begin();
  if (view.clear)
    lamp_ = lamp_of(view.camera, effects.shadow_edge);
  else
    cast_shadows(view, effects);
  if (has_drops(view))
    drops_.put(drops_of(view.spray, radii_mm_[static_cast<std::size_t>(view.bur)], effects.drops));
  target_picture_.resize(wide, high, effects.samples);
  target_picture_.begin(background_of(view));
  if (view.stereo) {
    draw_eye(view, -1, 0, wide / 2, high, made);
    draw_eye(view, 1, wide - wide / 2, wide / 2, high, made);
  } else {
    draw_eye(view, 0, 0, wide, high, made);
  }
  target_picture_.end();
  shown_texture_ = target_picture_.texture();
  if (effects.smooth_edges) {
    smooth_edges(view);
    shown_texture_ = smoothed_.texture();
  }
  glFinish();  // what it took is measured
  governor_.took(1e3 *
                 std::chrono::duration<double>(std::chrono::steady_clock::now() - began).count());
  shown_ = view;
  shown_version_ = tooth_.version();
  shown_size_ = {width, height};
  shown_level_ = level;
  ++drawn_;
  return shown_texture_;
}

}  // namespace cavum::station
