#include "ui/station/scene.h"

#include <epoxy/gl.h>

#include <algorithm>
#include <cmath>
#include <glm/gtc/matrix_transform.hpp>
#include <tuple>

#include "engine/tooth/beside.h"
#include "engine/tooth/marching.h"
#include "engine/tooth/surface_mesh.h"
#include "ui/station/instrument_mesh.h"

namespace cavum::station {
namespace {

constexpr int k_colours = 16;  // tissues with a colour of their own; further ones share the last

constexpr const char* k_tissue_vertex = R"(#version 330 core
layout(location = 0) in vec3 at;
layout(location = 1) in vec3 normal;
layout(location = 2) in vec2 tissue;
uniform mat4 model, look, projection;
uniform vec3 colours[16];
uniform float opacity;
out vec3 eye_at, eye_normal;
out vec4 colour;
out float gloss;
void main() {
  vec4 p = look * model * vec4(at, 1.0);
  eye_at = p.xyz;
  eye_normal = mat3(look) * mat3(model) * normal;
  int inner = int(min(tissue.x, 15.0) + 0.5), outer = int(min(tissue.y, 15.0) + 0.5);
  vec3 c = colours[inner];
  if (outer == 3) c = mix(c, colours[3], 0.55);
  colour = vec4(c, opacity);
  gloss = inner == 1 ? 1.0 : 0.3;
  gl_Position = projection * p;
})";

constexpr const char* k_plain_vertex = R"(#version 330 core
layout(location = 0) in vec3 at;
layout(location = 1) in vec3 normal;
layout(location = 2) in vec4 shade;
uniform mat4 model, look, projection;
uniform float opacity;
out vec3 eye_at, eye_normal;
out vec4 colour;
out float gloss;
void main() {
  vec4 p = look * model * vec4(at, 1.0);
  eye_at = p.xyz;
  eye_normal = mat3(look) * mat3(model) * normal;
  colour = vec4(shade.rgb, shade.a * opacity);
  gloss = 0.8;
  gl_Position = projection * p;
})";

// A lamp beside the eye, a key light from the upper left, the sky above; farther places sink into the background.
constexpr const char* k_fragment = R"(#version 330 core
in vec3 eye_at, eye_normal;
in vec4 colour;
in float gloss;
uniform vec3 background;
uniform float near_mm, far_mm, flat_light, glass;
out vec4 pixel;
void main() {
  vec3 n = normalize(eye_normal);
  vec3 to_eye = normalize(-eye_at);
  if (dot(n, to_eye) < 0.0) n = -n;
  vec3 key = normalize(vec3(-0.55, 0.75, 0.62));
  float head = max(dot(n, to_eye), 0.0);
  float side = max(dot(n, key), 0.0);
  float sky = 0.5 + 0.5 * n.y;
  float lit = mix(0.17 + 0.42 * head + 0.27 * side + 0.10 * sky, 0.55 + 0.45 * head, flat_light);
  vec3 halfway = normalize(key + to_eye);
  float shine = gloss * (0.20 * pow(max(dot(n, halfway), 0.0), 60.0) + 0.06 * pow(head, 120.0));
  float rim = gloss * 0.16 * pow(1.0 - head, 3.0);
  vec3 c = colour.rgb * lit + vec3(shine) + rim * vec3(0.72, 0.82, 0.95);
  float depth = clamp((-eye_at.z - near_mm) / (far_mm - near_mm), 0.0, 1.0);
  float edge = 1.0 - head;  // glass is seen at its edges
  float opacity = mix(colour.a, colour.a * (0.30 + 1.5 * edge), glass);
  pixel = vec4(mix(c, background, 0.62 * depth), min(opacity, 1.0));
})";

bool same(const SceneView& a, const SceneView& b) {
  const auto facts = [](const SceneView& v) { return std::tie(v.camera, v.point, v.handpiece, v.clear, v.stereo, v.high_contrast); };
  return facts(a) == facts(b) && a.tool.tip_mm == b.tool.tip_mm && a.tool.rotation == b.tool.rotation;
}

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

/// The head would hide the work from whoever looks along the handpiece.
float handpiece_opacity(const SceneView& view, int eye) {
  const glm::vec3 sight_line = glm::normalize(view.camera.target_mm - view.camera.position_mm(eye));
  const float along = std::fabs(glm::dot(sight_line, glm::normalize(glm::vec3(to_glm(view.tool)[2]))));
  return 0.24F * (1.0F - glm::smoothstep(0.55F, 0.85F, along));
}

std::vector<GpuMesh> meshes_of(const std::vector<DiamondPoint>& tray) {
  std::vector<GpuMesh> meshes(tray.size());
  for (std::size_t i = 0; i < tray.size(); ++i) {
    const MeshData data = diamond_point_mesh(tray[i]);
    meshes[i].put(data.vertices, data.indices);
  }
  return meshes;
}

}  // namespace

MeshData target_mesh(const scenarios::ZoneMap& zones) {
  constexpr std::array<std::uint8_t, 4> k_colour{60, 190, 235, 255};
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
  const auto index = [&size](IVec3 l) { return static_cast<std::size_t>((l.z * size.y + l.y) * size.x + l.x); };
  const TriangleMesh mesh = march_tetrahedra(size, zones.centre_mm(zones.low()), zones.leaf_mm(), inside, [&](IVec3 a, IVec3 b) {
    const double from = distance[index(a)], to = distance[index(b)];
    return from < 0 && to > 0 ? std::clamp(from / (from - to), 0.05, 0.95) : 0.5;
  });
  return smooth_shaded(mesh, k_colour);
}

Scene::Scene(const Octree& tooth, const std::vector<Tissue>& tissues, const std::vector<DiamondPoint>& tray, const scenarios::ZoneMap* target)
    : tooth_(tooth),
      tissues_(tissues),
      points_(meshes_of(tray)),
      tissue_program_(k_tissue_vertex, k_fragment),
      plain_program_(k_plain_vertex, k_fragment) {
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
  // told apart by lightness as well as by hue, for eyes that see no red or green
  std::vector<glm::vec3> table(k_colours, glm::vec3(0.62F, 0.52F, 0.70F));
  table[k_air] = glm::vec3(0.5F);
  table[k_enamel] = high_contrast ? glm::vec3(1.0F) : glm::vec3(0.93F, 0.925F, 0.895F);
  table[k_dentin] = high_contrast ? glm::vec3(0.95F, 0.70F, 0.16F) : glm::vec3(0.86F, 0.70F, 0.43F);
  table[k_pulp] = high_contrast ? glm::vec3(0.62F, 0.02F, 0.14F) : glm::vec3(0.70F, 0.20F, 0.20F);
  table[k_periodontium] = glm::vec3(0.80F, 0.55F, 0.55F);
  for (const Tissue& t : tissues_) {
    if (t.id >= k_colours) continue;
    // what stands beside the tooth is cooler and greyer than it, the gum pink
    if (t.name == k_gum) table[t.id] = high_contrast ? glm::vec3(0.80F, 0.30F, 0.45F) : glm::vec3(0.84F, 0.48F, 0.50F);
    if (is_of_neighbour(t.name)) table[t.id] = high_contrast ? glm::vec3(0.35F, 0.55F, 0.80F) : glm::vec3(0.62F, 0.70F, 0.78F);
  }
  for (const Tissue& t : tissues_)
    if (t.name == "lesion" && t.id < k_colours) table[t.id] = high_contrast ? glm::vec3(0.45F, 0.25F, 0.05F) : glm::vec3(0.58F, 0.40F, 0.22F);
  return table;
}

void Scene::light(const ShaderProgram& program, const SceneView& view, const Lens& lens) const {
  program.use();
  program.set("look", lens.look);
  program.set("projection", lens.projection);
  program.set("model", glm::mat4(1.0F));
  program.set("opacity", 1.0F);
  program.set("background", view.high_contrast ? glm::vec3(0) : glm::vec3(0.085F, 0.105F, 0.130F));
  program.set("near_mm", view.camera.distance_mm);
  program.set("far_mm", view.camera.distance_mm + 34.0F);
  program.set("flat_light", 0.0F);
  program.set("glass", 0.0F);
}

void Scene::draw_point(const SceneView& view) {
  plain_program_.set("model", to_glm(view.tool));
  points_[static_cast<std::size_t>(view.point)].draw();
}

void Scene::draw_clear_tissue(const SceneView& view, const Lens& lens) {
  glEnable(GL_BLEND);
  glBlendFunc(GL_SRC_ALPHA, GL_ONE_MINUS_SRC_ALPHA);
  glDepthMask(GL_FALSE);
  light(plain_program_, view, lens);
  plain_program_.set("opacity", 0.45F);
  plain_program_.set("flat_light", 1.0F);
  target_.draw();
  glDepthMask(GL_TRUE);
  // the nearest surface alone, so that walls behind walls do not add up to white
  tissue_program_.use();
  glColorMask(GL_FALSE, GL_FALSE, GL_FALSE, GL_FALSE);
  tooth_.draw_hard_tissue(lens.sight);
  glColorMask(GL_TRUE, GL_TRUE, GL_TRUE, GL_TRUE);
  glDepthFunc(GL_LEQUAL);
  tissue_program_.set("opacity", 0.55F);
  tissue_program_.set("glass", 1.0F);
  tissue_program_.set("flat_light", 0.6F);
  tooth_.draw_hard_tissue(lens.sight);
  glDepthFunc(GL_LESS);
}

void Scene::draw_bodies(const SceneView& view, const Lens& lens) {
  // over all tissue, so that their colours stay what the key says
  light(plain_program_, view, lens);
  plain_program_.set("glass", 0.5F);
  plain_program_.set("flat_light", 1.0F);
  glDisable(GL_DEPTH_TEST);
  for (const GpuMesh& body : bodies_) body.draw();
  glEnable(GL_DEPTH_TEST);
}

void Scene::draw_handpiece(const SceneView& view, const Lens& lens, float opacity) {
  glEnable(GL_BLEND);
  glBlendFunc(GL_SRC_ALPHA, GL_ONE_MINUS_SRC_ALPHA);
  light(plain_program_, view, lens);
  plain_program_.set("model", to_glm(view.tool));
  glColorMask(GL_FALSE, GL_FALSE, GL_FALSE, GL_FALSE);
  handpiece_.draw();
  glColorMask(GL_TRUE, GL_TRUE, GL_TRUE, GL_TRUE);
  glDepthFunc(GL_LEQUAL);
  plain_program_.set("opacity", opacity);
  handpiece_.draw();
  glDepthFunc(GL_LESS);
}

void Scene::draw_eye(const SceneView& view, int eye, int x, int width, int height) {
  glViewport(x, 0, width, height);
  const glm::mat4 look = view.camera.view(eye), projection = view.camera.projection(static_cast<float>(width) / static_cast<float>(height));
  const Lens lens{look, projection, {view.camera.position_mm(eye), projection * look}};
  glEnable(GL_DEPTH_TEST);
  glDisable(GL_BLEND);
  glEnable(GL_CULL_FACE);
  glFrontFace(view.camera.mirror ? GL_CW : GL_CCW);

  light(plain_program_, view, lens);
  const bool tool = view.point >= 0 && static_cast<std::size_t>(view.point) < points_.size();
  if (tool) draw_point(view);
  light(tissue_program_, view, lens);
  tissue_program_.set("colours", colours(view.high_contrast));
  tooth_.draw_pulp(lens.sight);
  if (view.clear) {
    draw_clear_tissue(view, lens);
    draw_bodies(view, lens);
  } else {
    tooth_.draw_hard_tissue(lens.sight);
  }
  const float opacity = tool && view.handpiece ? handpiece_opacity(view, eye) : 0.0F;
  if (opacity > 0.01F) draw_handpiece(view, lens, opacity);
  glDisable(GL_BLEND);
  glDisable(GL_CULL_FACE);
  glDisable(GL_DEPTH_TEST);
}

unsigned Scene::picture(const SceneView& view, int width, int height, int samples) {
  width = std::max(width, 16);
  height = std::max(height, 16);
  const bool current = drawn_ > 0 && same(view, shown_) && shown_version_ == tooth_.version() && target_picture_.width() == width &&
                       target_picture_.height() == height && shown_samples_ == samples;
  if (current) return target_picture_.texture();
  target_picture_.resize(width, height, samples);
  target_picture_.begin(view.high_contrast ? glm::vec3(0) : glm::vec3(0.085F, 0.105F, 0.130F));
  if (view.stereo) {
    draw_eye(view, -1, 0, width / 2, height);
    draw_eye(view, 1, width - width / 2, width / 2, height);
  } else {
    draw_eye(view, 0, 0, width, height);
  }
  target_picture_.end();
  shown_ = view;
  shown_version_ = tooth_.version();
  shown_samples_ = samples;
  ++drawn_;
  return target_picture_.texture();
}

}  // namespace cavum::station
