#include <epoxy/gl.h>

#include <cmath>
#include <glm/gtc/matrix_transform.hpp>

#include "ui/station/scene.h"

namespace cavum::station {
namespace {

/// How far one looks along the instrument, 0..1.
float along_tool(const SceneView& view, int eye) {
  const glm::vec3 sight_line = glm::normalize(view.camera.target_mm - view.camera.position_mm(eye));
  return std::fabs(glm::dot(sight_line, glm::normalize(glm::vec3(to_glm(view.tool)[2]))));
}
/// The shank would hide the work from whoever looks along it; the head of the bur stays.
float shank_opacity(const SceneView& view, int eye) {
  return 1.0F - 0.86F * glm::smoothstep(0.80F, 0.94F, along_tool(view, eye));
}

}  // namespace

float handpiece_opacity(const SceneView& view, int eye) {
  return 1.0F - glm::smoothstep(0.35F, 0.62F, along_tool(view, eye));
}

void Scene::cast_shadows(const SceneView& view, const Effects& effects) {
  lamp_ = lamp_of(view.camera, effects.shadow_edge);
  glEnable(GL_DEPTH_TEST);
  glEnable(GL_CULL_FACE);
  glFrontFace(GL_CCW);
  glEnable(GL_POLYGON_OFFSET_FILL);
  glPolygonOffset(1.5F, 2.0F);
  depth_program_.use();
  depth_program_.set("to_lamp", lamp_.to_lamp);
  // of the tooth only when it or the lamp moved; while it is cut in picture after picture, only in
  // each fourth
  constexpr int k_cuts_a_shadow = 4;
  const ShadowOf now{tooth_.version(), view.camera.turn_deg, view.camera.target_mm};
  cuts_in_a_row_ = now.version == shown_version_ ? 0 : cuts_in_a_row_ + 1;
  const bool fresh = resting_shadow_.resize(effects.shadow_edge),
             cut_on = cuts_in_a_row_ > 0 && cuts_in_a_row_ % k_cuts_a_shadow != 1;
  if (fresh || !now.same_lamp(resting_) || (now.version != resting_.version && !cut_on)) {
    resting_ = now;
    resting_shadow_.begin();
    depth_program_.set("model", glm::mat4(1.0F));
    constexpr float k_sun_mm = 1000.0F;
    tooth_.draw_hard_tissue({view.camera.target_mm + k_sun_mm * lamp_.towards, lamp_.to_lamp},
                            count_);
  }
  shadow_.resize(effects.shadow_edge);
  shadow_.begin_with(resting_shadow_);
  if (has_tool(view)) {
    depth_program_.set("model", tool_matrix(view));
    heads_[static_cast<std::size_t>(view.bur)].draw(count_);
    shanks_[static_cast<std::size_t>(view.bur)].draw(count_);
  }
  DepthMap::end();
  glDisable(GL_POLYGON_OFFSET_FILL);
}

void Scene::draw_tooth(const SceneView& view, const ToothDrawing::Sight& sight,
                       const Programs& programs) {
  const auto palette = colours(view.high_contrast);
  const auto prepare = [&](const ShaderProgram& program) {
    light(program, view, sight);
    program.set("colours", std::span(palette));
    program.set("plain", view.high_contrast ? 1.0F : 0.0F);
    constexpr float k_texels = 1.6F;
    program.set("away_mm", k_texels * lamp_.texel_mm);
    program.set_texture("shadow", 1, GL_TEXTURE_2D, shadow_.texture());
  };
  if (!has_tool(view)) {
    prepare(*programs.tooth);
    tooth_.draw_hard_tissue(sight, count_);
    tooth_.draw_open_pulp(sight, count_);
    return;
  }
  const ShaderProgram& touched = *programs.touched_tooth;
  prepare(touched);
  touched.set("to_tool", glm::inverse(to_glm(view.tool)));
  const float touches = touch(view);
  touched.set("tool_table", glm::vec4(k_tool_table, touches));
  const float above = view.foot ? above_mm(view) : k_foot_ends_mm;
  const float shows =
      (1.0F - touches) * (1.0F - glm::smoothstep(k_foot_ends_mm - 1.0F, k_foot_ends_mm, above));
  constexpr float k_beside_mm = 0.15F, k_opens = 0.6F, k_bends_per_mm = 0.15F, k_deeper_mm = 2.0F;
  const auto head_mm = static_cast<float>(radii_mm_[static_cast<std::size_t>(view.bur)]);
  touched.set("foot",
              glm::vec4(head_mm + k_beside_mm + k_opens * above / (1.0F + k_bends_per_mm * above),
                        -above - k_deeper_mm, shows, 0));
  touched.set("tool_axis", glm::vec3(to_glm(view.tool)[2]));
  touched.set_texture("tool_mm", 2, GL_TEXTURE_2D,
                      distances_[static_cast<std::size_t>(view.bur)].texture());
  // the tip's ball, and as far as its touch and its foot are seen
  constexpr float k_around_mm = 5.5F;
  const glm::vec3 middle(to_glm(view.tool)[3]);
  tooth_.draw_hard_tissue(sight, count_, {middle, k_around_mm, true});
  tooth_.draw_open_pulp(sight, count_);
  prepare(*programs.tooth);
  tooth_.draw_hard_tissue(sight, count_, {middle, k_around_mm, false});
}

void Scene::draw_clear_tissue(const SceneView& view, const ToothDrawing::Sight& sight,
                              const Programs& programs) {
  const auto palette = colours(view.high_contrast);
  light(*programs.tooth, view, sight);
  programs.tooth->set("colours", std::span(palette));
  programs.tooth->set("plain", 1.0F);
  programs.tooth->set_texture("shadow", 1, GL_TEXTURE_2D, no_shadow_.texture());
  tooth_.draw_pulp(sight, count_);
  glEnable(GL_BLEND);
  glBlendFunc(GL_SRC_ALPHA, GL_ONE_MINUS_SRC_ALPHA);
  glDepthMask(GL_FALSE);
  light(plain_program_, view, sight);
  plain_program_.set("opacity", 0.45F);
  plain_program_.set("flat_light", 1.0F);
  target_.draw(count_);
  glDepthMask(GL_TRUE);
  // the nearest surface alone, so that walls behind walls do not add up to white
  light(glass_program_, view, sight);
  glass_program_.set("colours", std::span(palette));
  glColorMask(GL_FALSE, GL_FALSE, GL_FALSE, GL_FALSE);
  tooth_.draw_hard_tissue(sight, count_);
  glColorMask(GL_TRUE, GL_TRUE, GL_TRUE, GL_TRUE);
  glDepthFunc(GL_LEQUAL);
  glass_program_.set("opacity", 0.55F);
  glass_program_.set("glass", 1.0F);
  glass_program_.set("flat_light", 0.6F);
  tooth_.draw_hard_tissue(sight, count_);
  glDepthFunc(GL_LESS);
}

void Scene::draw_bodies(const SceneView& view, const ToothDrawing::Sight& sight) {
  // over all tissue, so that their colours stay what the key says
  light(plain_program_, view, sight);
  plain_program_.set("glass", 0.5F);
  plain_program_.set("flat_light", 1.0F);
  glEnable(GL_BLEND);
  glDisable(GL_DEPTH_TEST);
  for (const GpuMesh& body : bodies_) body.draw(count_);
  glEnable(GL_DEPTH_TEST);
}

bool Scene::has_drops(const SceneView& view) const {
  return view.drops && has_tool(view) && (view.spray.water > 0 || view.spray.chips > 0) &&
         k_effects[effects_level()].drops > 0;
}

void Scene::draw_drops(const SceneView& view, const ToothDrawing::Sight& sight, float width,
                       float height) {
  drop_program_.use();
  drop_program_.set("model", to_glm(view.tool));
  drop_program_.set("to_picture", sight.to_picture);
  drop_program_.set("pixels", 0.5F * height * view.camera.projection(width / height)[1][1]);
  glEnable(GL_BLEND);
  glBlendFunc(GL_SRC_ALPHA, GL_ONE_MINUS_SRC_ALPHA);
  glDepthMask(GL_FALSE);
  drops_.draw(count_);
  glDepthMask(GL_TRUE);
  glDisable(GL_BLEND);
}

void Scene::draw_metal(const GpuMesh& mesh, const ShaderProgram& metal, float opacity) {
  if (opacity < 0.02F) return;
  if (opacity > 0.98F) return mesh.draw(count_);
  glEnable(GL_BLEND);
  glBlendFunc(GL_SRC_ALPHA, GL_ONE_MINUS_SRC_ALPHA);
  glColorMask(GL_FALSE, GL_FALSE, GL_FALSE, GL_FALSE);
  mesh.draw(count_);
  glColorMask(GL_TRUE, GL_TRUE, GL_TRUE, GL_TRUE);
  glDepthFunc(GL_LEQUAL);
  metal.set("opacity", opacity);
  mesh.draw(count_);
  metal.set("opacity", 1.0F);
  glDepthFunc(GL_LESS);
  glDisable(GL_BLEND);
}

void Scene::draw_eye(const SceneView& view, int eye, int x, int width, int height,
                     const Programs& programs) {
  glViewport(x, 0, width, height);
  const glm::mat4 to_picture =
      view.camera.projection(static_cast<float>(width) / static_cast<float>(height)) *
      view.camera.view(eye);
  const ToothDrawing::Sight sight{view.camera.position_mm(eye), to_picture};
  glEnable(GL_DEPTH_TEST);
  glDisable(GL_BLEND);
  glEnable(GL_CULL_FACE);
  glFrontFace(view.camera.mirror ? GL_CW : GL_CCW);

  const bool tool = has_tool(view);
  const auto metal = [&](const glm::mat4& model) {
    light(*programs.metal, view, sight);
    programs.metal->set("model", model);
    programs.metal->set_texture("shadow", 1, GL_TEXTURE_2D,
                                view.clear ? no_shadow_.texture() : resting_shadow_.texture());
  };
  if (tool) {
    metal(tool_matrix(view));
    heads_[static_cast<std::size_t>(view.bur)].draw(count_);
  }
  if (view.clear) {
    draw_clear_tissue(view, sight, programs);
    draw_bodies(view, sight);
  } else {
    draw_tooth(view, sight, programs);
  }
  if (has_drops(view))
    draw_drops(view, sight, static_cast<float>(width), static_cast<float>(height));
  if (tool) {
    metal(tool_matrix(view));
    draw_metal(shanks_[static_cast<std::size_t>(view.bur)], *programs.metal,
               shank_opacity(view, eye));
    programs.metal->set("model", to_glm(view.tool));
    if (view.handpiece) draw_metal(handpiece_, *programs.metal, handpiece_opacity(view, eye));
  }
  glDisable(GL_BLEND);
  glDisable(GL_CULL_FACE);
  glDisable(GL_DEPTH_TEST);
}

}  // namespace cavum::station
