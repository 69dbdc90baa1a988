#define GLFW_INCLUDE_NONE
#include <GLFW/glfw3.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "engine/base/error.h"
#include "ui/language/say.h"
#include "ui/station/author_screen.h"
#include "ui/station/author_sight.h"

namespace cavum::station {
namespace {

// Found: a hollow green triangle. Put by a person: a filled orange square, with a line from where
// it was found. Of Okabe and Ito's palette.
constexpr ImU32 k_found = IM_COL32(64, 205, 160, 255), k_by_person = IM_COL32(230, 159, 0, 255);
constexpr float k_reach_px = 16.0F;

ImU32 paler(ImU32 colour) { return (colour & ~IM_COL32_A_MASK) | (90U << IM_COL32_A_SHIFT); }

Vec3 eye_of(const AuthorContext& c) {
  const glm::vec3 eye = c.screen.state.view.camera.position_mm();
  return {eye.x, eye.y, eye.z};
}

bool hidden(const AuthorContext& c, const AuthorLandmark& mark) {
  return c.findings != nullptr && c.findings->tooth &&
         hidden_in_tooth(*c.findings->tooth, eye_of(c), mark.at_mm);
}

void found_sign(ImDrawList& draw, ImVec2 at, float r, ImU32 colour) {
  const ImVec2 top{at.x, at.y - r}, left{at.x - 0.87F * r, at.y + 0.5F * r},
      right{at.x + 0.87F * r, at.y + 0.5F * r};
  draw.AddTriangle(top, left, right, IM_COL32(0, 0, 0, (colour >> IM_COL32_A_SHIFT) * 3 / 4), 4.0F);
  draw.AddTriangle(top, left, right, colour, 1.8F);
}

void put_sign(ImDrawList& draw, ImVec2 at, float r, ImU32 colour) {
  draw.AddRectFilled({at.x - r, at.y - r}, {at.x + r, at.y + r},
                     IM_COL32(0, 0, 0, colour >> IM_COL32_A_SHIFT));
  draw.AddRectFilled({at.x - r + 2, at.y - r + 2}, {at.x + r - 2, at.y + r - 2}, colour);
}

struct Box {
  ImVec2 low, high;
  [[nodiscard]] bool meets(const Box& b) const {
    return low.x < b.high.x && b.low.x < high.x && low.y < b.high.y && b.low.y < high.y;
  }
};

Message words_of(const AuthorLandmark& mark) {
  return mark.by_person ? msg("{} (by hand)", mark.title()) : msg("{}", mark.title());
}

/// The landmark's own place moved onto what it lies on; none, and a message, when the line of sight
/// misses.
std::optional<Vec3> met(const AuthorContext& c, const AuthorLandmark& mark, Vec3 from, Vec3 way) {
  if (c.findings == nullptr || !c.findings->tooth) return std::nullopt;
  const auto at = landmark_in_sight(*c.findings->tooth, mark.name, from,
                                    normalized(way, {0, 0, -1}), mark.at_mm);
  if (!at) c.state.message = msg("Nothing that a {} could lie on is seen there.", mark.title());
  return at;
}

}  // namespace

void draw_landmarks(const AuthorContext& c, ImDrawList& draw, const AuthorSight& sight) {
  const AuthorState& s = c.state;
  if (!s.landmarks_shown) return;
  const float px = c.screen.theme.scale, r = 6.5F * px;
  std::vector<std::size_t> order;  // the chosen one's words stand whatever else there is, then
                                   // those by hand, then what is in sight
  std::vector<bool> behind;
  for (std::size_t i = 0; i < c.landmarks.size(); ++i) {
    order.push_back(i);
    behind.push_back(hidden(c, c.landmarks[i]));
  }
  const auto rank = [&](std::size_t i) {
    return s.by_landmarks && i == s.landmark ? 0 : c.landmarks[i].by_person ? 1 : behind[i] ? 3 : 2;
  };
  std::stable_sort(order.begin(), order.end(),
                   [&](std::size_t a, std::size_t b) { return rank(a) < rank(b); });
  std::vector<Box> taken;  // by signs and words
  for (const AuthorLandmark& mark : c.landmarks) {
    const ImVec2 at = sight.pixel(mark.at_mm);
    taken.push_back({{at.x - r, at.y - r}, {at.x + r, at.y + r}});
  }
  for (const std::size_t i : order) {
    const AuthorLandmark& mark = c.landmarks[i];
    const bool chosen = s.by_landmarks && i == s.landmark;
    const ImVec2 at = sight.pixel(mark.at_mm);
    const auto shade = [&](ImU32 colour) { return behind[i] && !chosen ? paler(colour) : colour; };
    if (mark.by_person) {
      if (mark.found_mm) {
        const ImVec2 was = sight.pixel(*mark.found_mm);
        author_line(draw, was, at, shade(k_by_person), px);
        found_sign(draw, was, 0.7F * r, paler(k_found));
      }
      put_sign(draw, at, 0.85F * r, shade(k_by_person));
    } else {
      found_sign(draw, at, r, shade(k_found));
    }
    if (chosen) draw.AddCircle(at, 12.0F * px, IM_COL32_WHITE, 24, 2.0F * px);
    const std::string text = tr(words_of(mark));
    const ImVec2 size = ImGui::CalcTextSize(text.c_str());
    const float gap = 13 * px;
    // beside the sign, else above or below it, where nothing else stands; the chosen one's anyway
    const std::array<ImVec2, 4> corners{ImVec2{at.x + gap, at.y - 0.5F * size.y},
                                        ImVec2{at.x - gap - size.x, at.y - 0.5F * size.y},
                                        ImVec2{at.x - 0.5F * size.x, at.y - gap - size.y},
                                        ImVec2{at.x - 0.5F * size.x, at.y + gap}};
    const auto* free = std::find_if(corners.begin(), corners.end(), [&](ImVec2 corner) {
      const Box box{corner, {corner.x + size.x, corner.y + size.y}};
      return std::none_of(taken.begin(), taken.end(), [&](const Box& b) { return b.meets(box); });
    });
    if (free == corners.end() && !chosen) continue;
    const ImVec2 corner = free == corners.end() ? corners[0] : *free;
    taken.push_back({corner, {corner.x + size.x, corner.y + size.y}});
    ImGui::LogText("%s\n", text.c_str());
    author_words(draw, corner,
                 chosen ? IM_COL32_WHITE : shade(mark.by_person ? k_by_person : k_found),
                 text.c_str());
  }
}

bool take_landmark(const AuthorContext& c, const AuthorSight& sight, ImVec2 mouse) {
  AuthorState& s = c.state;
  if (!s.landmarks_shown) return false;
  const double reach = k_reach_px * c.screen.theme.scale;
  double nearest = 2 * reach;
  for (std::size_t i = 0; i < c.landmarks.size(); ++i) {
    double d = pixels_apart(mouse, sight.pixel(c.landmarks[i].at_mm));
    if (d >= reach) continue;
    if (hidden(c, c.landmarks[i])) d += reach;  // what is in sight first
    if (d >= nearest) continue;
    nearest = d;
    s.landmark = i;
    s.by_landmarks = s.pulls_landmark = true;
  }
  if (!s.pulls_landmark) return false;
  const ImVec2 is = sight.pixel(c.landmarks[s.landmark].at_mm);
  s.held_off = {is.x - mouse.x, is.y - mouse.y};
  return true;
}

void pull_landmark(const AuthorContext& c, const AuthorSight& sight, ImVec2 mouse) {
  const AuthorState& s = c.state;
  if (s.landmark >= c.landmarks.size() ||
      !ImGui::IsMouseDragging(ImGuiMouseButton_Left, 3.0F * c.screen.theme.scale))
    return;
  const ImVec2 moved = ImGui::GetIO().MouseDelta;
  if (moved.x == 0 && moved.y == 0) return;
  const AuthorLandmark& mark = c.landmarks[s.landmark];
  const auto [from, way] = sight.through({mouse.x + s.held_off.x, mouse.y + s.held_off.y});
  if (const auto to = met(c, mark, from, way)) author_move_landmark(c, mark, *to, true);
}

void landmark_arrows(const AuthorContext& c) {
  const AuthorState& s = c.state;
  if (s.landmark >= c.landmarks.size()) return;
  const int across = ImGui::IsKeyPressed(GLFW_KEY_RIGHT) - ImGui::IsKeyPressed(GLFW_KEY_LEFT);
  const int upwards = ImGui::IsKeyPressed(GLFW_KEY_UP) - ImGui::IsKeyPressed(GLFW_KEY_DOWN);
  if (across == 0 && upwards == 0) return;
  const Camera& camera = c.screen.state.view.camera;
  const AuthorLandmark& mark = c.landmarks[s.landmark];
  const double step = ImGui::GetIO().KeyShift ? 0.01 : 0.1;
  const Vec3 middle{camera.target_mm.x, camera.target_mm.y, camera.target_mm.z},
      way = normalized(middle - eye_of(c), {0, 0, -1});
  constexpr double k_before_mm = 60;  // before all of the tooth
  const Vec3 wanted =
      mark.at_mm + camera.right() * (step * across) + camera.up() * (step * upwards);
  if (const auto to = met(c, mark, wanted - way * k_before_mm, way))
    author_move_landmark(c, mark, *to, false);
}

void landmark_list(const AuthorContext& c) {
  AuthorState& s = c.state;
  const Theme& t = c.screen.theme;
  if (c.landmarks.empty()) quiet_text(t, msg("No landmark was found on this tooth."));
  const float rows = std::min(12.5F, static_cast<float>(c.landmarks.size()) + 0.5F);
  ImGui::BeginChild("landmarks", {0, rows * ImGui::GetTextLineHeightWithSpacing()}, false);
  for (std::size_t i = 0; i < c.landmarks.size(); ++i) {
    const AuthorLandmark& mark = c.landmarks[i];
    const ImVec2 at = ImGui::GetCursorScreenPos();
    const float side = ImGui::GetTextLineHeight(), half = 0.5F * side;
    if (mark.by_person)
      put_sign(*ImGui::GetWindowDrawList(), {at.x + half, at.y + half}, 0.35F * side, k_by_person);
    else
      found_sign(*ImGui::GetWindowDrawList(), {at.x + half, at.y + half}, 0.4F * side, k_found);
    ImGui::Dummy({side, side});
    ImGui::SameLine();
    ImGui::PushID(static_cast<int>(i));
    if (ImGui::Selectable(shown_label(words_of(mark)).c_str(), s.landmark == i)) s.landmark = i;
    ImGui::PopID();
    if (s.landmark == i && !ImGui::IsItemVisible()) ImGui::SetScrollHereY();
  }
  ImGui::EndChild();
  if (s.landmark >= c.landmarks.size()) return;
  ImGui::Separator();
  const AuthorLandmark& mark = c.landmarks[s.landmark];
  wrapped_text(msg("{}:  {}", mark.title(), mark.at_mm));
  if (!mark.by_person)
    quiet_text(t, msg("Found in the tooth."));
  else if (mark.found_mm)
    quiet_text(t, msg("Put by hand, {} from where it was found. X: back there.",
                      as_mm(length(mark.at_mm - *mark.found_mm))));
  else
    quiet_text(t, msg("Put by hand; none was found. X: takes it out."));
}

}  // namespace cavum::station
