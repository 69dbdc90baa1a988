#define GLFW_INCLUDE_NONE
#include <GLFW/glfw3.h>
#include <imgui.h>

#include <algorithm>
#include <cmath>

#include "ui/language/say.h"
#include "ui/station/screens.h"
#include "ui/station/window.h"

namespace cavum::station {
namespace {

void keys(StationState& s, double frame_s, bool arrows_turn) {
  Camera& camera = s.view.camera;
  const auto step = static_cast<float>(70.0 * frame_s);
  const auto held = [arrows_turn](int letter, int arrow) {
    return key_held(letter) || (arrows_turn && key_held(arrow));
  };
  if (held(GLFW_KEY_A, GLFW_KEY_LEFT)) camera.orbit(-step, 0);
  if (held(GLFW_KEY_D, GLFW_KEY_RIGHT)) camera.orbit(step, 0);
  if (held(GLFW_KEY_W, GLFW_KEY_UP)) camera.orbit(0, step);
  if (held(GLFW_KEY_S, GLFW_KEY_DOWN)) camera.orbit(0, -step);
  const auto zoom = static_cast<float>(std::exp(1.2 * frame_s));
  if (!ImGui::GetIO().KeyCtrl && (key_held(GLFW_KEY_EQUAL) || key_held(GLFW_KEY_KP_ADD)))
    camera.approach(1.0F / zoom);
  if (!ImGui::GetIO().KeyCtrl && (key_held(GLFW_KEY_MINUS) || key_held(GLFW_KEY_KP_SUBTRACT)))
    camera.approach(zoom);
  if (key_pressed(GLFW_KEY_1)) camera.look_from_occlusal();
  if (key_pressed(GLFW_KEY_2)) camera.look_from(0, 25);
  if (key_pressed(GLFW_KEY_3)) camera.look_from(180, 25);
  if (key_pressed(GLFW_KEY_4)) camera.look_from(-90, 25);
  if (key_pressed(GLFW_KEY_5)) camera.look_from(90, 25);
  if (key_pressed(GLFW_KEY_M)) camera.mirror = !camera.mirror;
  if (key_pressed(GLFW_KEY_R)) camera.roll_deg = std::fmod(camera.roll_deg + 15.0F, 360.0F);
  if (key_pressed(GLFW_KEY_T)) s.view.stereo = !s.view.stereo;
  if (key_pressed(GLFW_KEY_H)) s.view.handpiece = !s.view.handpiece;
  if (key_pressed(GLFW_KEY_G)) s.view.foot = !s.view.foot;
  if (key_pressed(GLFW_KEY_N)) s.view.drops = !s.view.drops;
  camera.eyes_apart_mm = s.view.stereo ? 0.06F * camera.distance_mm : 0.0F;
}

}  // namespace

bool tooth_area(const ScreenContext& c, ImVec2 size) {
  StationState& s = c.state;
  const bool mouse_is_stylus =
      c.sitting != nullptr && s.screen == Screen::exam && c.sitting->device().pointer() != nullptr;
  if (!ImGui::GetIO().WantTextInput && !ImGui::GetIO().KeyCtrl)
    keys(s, c.frame_s, !mouse_is_stylus && !s.own_arrows);
  s.view.high_contrast = s.high_contrast;
  const ImVec2 at = ImGui::GetCursorScreenPos();
  const unsigned picture =
      c.scene->picture(s.view, static_cast<int>(size.x), static_cast<int>(size.y));
  // Dear ImGui takes the number of a texture as if it were an address
  // NOLINTNEXTLINE(performance-no-int-to-ptr)
  ImGui::Image(reinterpret_cast<ImTextureID>(static_cast<std::intptr_t>(picture)), size, {0, 1},
               {1, 0});
  const bool over = ImGui::IsItemHovered();
  const ImGuiIO& io = ImGui::GetIO();
  if (over && ImGui::IsMouseDragging(ImGuiMouseButton_Right, 0))
    s.view.camera.orbit(-0.3F * io.MouseDelta.x, 0.3F * io.MouseDelta.y);
  if (c.mouse_captured && c.input.button_down(GLFW_MOUSE_BUTTON_RIGHT))
    for (const InputEvent& e : c.input.played())
      if (e.kind == InputEvent::Kind::motion) s.view.camera.orbit(-0.3F * e.x, 0.3F * e.y);
  if ((over || c.mouse_captured) && io.MouseWheel != 0 && (!mouse_is_stylus || io.KeyCtrl))
    s.view.camera.approach(std::pow(0.92F, io.MouseWheel));
  if (s.sides) draw_side_words(c.theme, *s.sides, s.view.camera, s.view.stereo, at, size);
  if (c.sitting != nullptr && c.sitting->device().simulated())
    demonstration_in_picture(c.theme, at, size);
  if (s.view.camera.mirror) {
    const std::string word = tr("MIRROR");
    ImGui::GetWindowDrawList()->AddText({at.x + size.x - c.theme.px(110), at.y + c.theme.px(14)},
                                        ink(c.theme.warn), word.c_str());
  }
  return over;
}

bool arrow_to_what_is_out(const ScreenContext& c, Vec3 place_mm, ImVec2 at, ImVec2 size) {
  const Camera& camera = c.state.view.camera;
  const float width = c.state.view.stereo ? 0.5F * size.x : size.x;
  const glm::vec4 p = camera.projection(width / size.y) * camera.view() *
                      glm::vec4(place_mm.x, place_mm.y, place_mm.z, 1.0F);
  if (p.w > 0 && std::fabs(p.x) <= p.w && std::fabs(p.y) <= p.w) return false;
  const float far = std::max(1e-6F, std::max(std::fabs(p.x), std::fabs(p.y)));
  const ImVec2 share{p.x / far, -p.y / far};
  const float words = c.theme.px(110);  // at the picture's foot
  const float edge = c.theme.px(26), r = c.theme.px(14), length = std::hypot(share.x, share.y);
  const ImVec2 middle{
      at.x + 0.5F * size.x + share.x * (0.5F * size.x - edge),
      at.y + std::min(0.5F * size.y + share.y * (0.5F * size.y - edge), size.y - words)};
  const ImVec2 d{share.x / length, share.y / length};
  const ImVec2 top{middle.x + r * d.x, middle.y + r * d.y},
      left{middle.x - r * d.x - r * d.y, middle.y - r * d.y + r * d.x},
      right{middle.x - r * d.x + r * d.y, middle.y - r * d.y - r * d.x};
  ImDrawList& draw = *ImGui::GetWindowDrawList();
  draw.AddTriangleFilled(top, left, right, ink(c.theme.warn));
  draw.AddTriangle(top, left, right, ink(c.theme.back), c.theme.px(2));
  return true;
}

void words_in_picture(const Theme& theme, ImVec2 at, ImVec2 size, const Message& upper,
                      const Message& lower, const ImVec4& colour) {
  ImDrawList& draw = *ImGui::GetWindowDrawList();
  const std::string heading = tr(upper), words = tr(lower);
  draw.AddText({at.x + theme.px(16), at.y + theme.px(14)}, ink(colour), heading.c_str());
  ImGui::LogText("%s\n%s\n", heading.c_str(), words.c_str());
  if (words.empty()) return;
  const float width = std::min(size.x - theme.px(40), theme.px(680)), pad = theme.px(12);
  const std::string lines = in_lines(words, width - 2 * pad);
  const ImVec2 text = ImGui::CalcTextSize(lines.c_str());
  const ImVec2 corner{at.x + (size.x - text.x) / 2 - pad,
                      at.y + size.y - text.y - 2 * pad - theme.px(16)};
  ImVec4 ground = theme.panel;
  ground.w = 0.9F;
  draw.AddRectFilled(corner, {corner.x + text.x + 2 * pad, corner.y + text.y + 2 * pad},
                     ink(ground), theme.px(6));
  draw.AddRect(corner, {corner.x + text.x + 2 * pad, corner.y + text.y + 2 * pad}, ink(colour),
               theme.px(6));
  draw.AddText({corner.x + pad, corner.y + pad}, ink(theme.text), lines.c_str());
}

}  // namespace cavum::station
