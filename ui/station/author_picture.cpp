#define GLFW_INCLUDE_NONE
#include <GLFW/glfw3.h>
#include <fmt/core.h>
#include <imgui.h>

#include <algorithm>
#include <cmath>

#include "ui/station/author_screen.h"

namespace cavum::station {
namespace {

/// Between the tooth and the picture, both ways.
struct Sight {
  glm::mat4 to_picture;
  ImVec2 at, size;

  [[nodiscard]] ImVec2 pixel(Vec3 p) const {
    const glm::vec4 c = to_picture * glm::vec4(p.x, p.y, p.z, 1);
    return {at.x + size.x * (0.5F + 0.5F * c.x / c.w), at.y + size.y * (0.5F - 0.5F * c.y / c.w)};
  }
  /// Where the line of sight through a pixel meets a plane; `otherwise` when it runs along it.
  [[nodiscard]] Vec3 on_plane(ImVec2 pixel, Vec3 through, Vec3 normal, Vec3 otherwise) const {
    const float x = 2.0F * (pixel.x - at.x) / size.x - 1.0F, y = 1.0F - 2.0F * (pixel.y - at.y) / size.y;
    const glm::mat4 back = glm::inverse(to_picture);
    const glm::vec4 a = back * glm::vec4(x, y, -1, 1), b = back * glm::vec4(x, y, 1, 1);
    const Vec3 from{a.x / a.w, a.y / a.w, a.z / a.w}, way = Vec3{b.x / b.w, b.y / b.w, b.z / b.w} - from;
    const double steep = dot(way, normal);
    constexpr double k_least = 0.15;  // seen nearly along the plane, a pixel is millimetres
    if (std::fabs(steep) < k_least * length(way)) return otherwise;
    return from + way * (dot(through - from, normal) / steep);
  }
};

ImU32 colour_of(AuthorLayer layer, int opacity) {
  const auto c = layer_colour(layer);
  return IM_COL32(c[0], c[1], c[2], opacity);
}

/// A line that is seen on light and on dark.
void line(ImDrawList& draw, ImVec2 a, ImVec2 b, ImU32 colour, float width) {
  draw.AddLine(a, b, IM_COL32(0, 0, 0, (colour >> IM_COL32_A_SHIFT) * 3 / 4), width + 2.5F);
  draw.AddLine(a, b, colour, width);
}

void draw_outline(ImDrawList& draw, const Sight& sight, const AuthorZone& zone, bool chosen, float px) {
  const std::vector<Vec3>& p = zone.points_mm;
  const ImU32 colour = colour_of(zone.layer, chosen ? 255 : 130);
  const float width = chosen ? 2.0F * px : px;
  const auto pixel = [&](Vec3 v) { return sight.pixel(zone.in_tooth(v)); };
  for (std::size_t i = 0; i + (zone.closed ? 0 : 1) < p.size(); ++i) {
    const Vec3 a = p[i], b = p[(i + 1) % p.size()];
    line(draw, pixel(a), pixel(b), colour, zone.closed ? width : 0.5F * width);
    if (zone.closed || !(zone.half_width_mm > 0)) continue;
    // the sides of a stroke, and round its points
    const Vec3 along = normalized(b - a, {1, 0, 0}), aside = Vec3{-along.y, along.x, 0} * zone.half_width_mm;
    line(draw, pixel(a + aside), pixel(b + aside), colour, width);
    line(draw, pixel(a - aside), pixel(b - aside), colour, width);
    constexpr int k_parts = 12;
    for (const bool end : {false, true}) {
      const Vec3 middle = end ? b : a, out = along * (end ? zone.half_width_mm : -zone.half_width_mm);
      ImVec2 last = pixel(middle + aside);
      for (int k = 1; k <= k_parts; ++k) {
        const double turn = 3.14159265358979 * k / k_parts;
        const ImVec2 now = pixel(middle + aside * std::cos(turn) + out * std::sin(turn));
        if ((!end && i == 0) || (end && i + 2 == p.size())) line(draw, last, now, colour, width);
        last = now;
      }
    }
  }
}

/// The middle of the points, and the floor below it: the handle of the depth.
std::pair<Vec3, Vec3> depth_line(const AuthorContext& c, const AuthorZone& zone) {
  Vec3 middle;
  for (const Vec3 p : zone.points_mm) middle += p / static_cast<double>(zone.points_mm.size());
  const Vec3 top = zone.in_tooth(middle);
  const auto targets = std::count_if(c.zones.begin(), c.zones.end(), [](const AuthorZone& z) { return z.layer == AuthorLayer::target; });
  // a floor below the surface's lowest place is deeper than the opening's mean level says
  const double floor = targets == 1 && !c.busy ? c.floor_z_mm : top.z - *zone.depth_mm;
  return {top, {top.x, top.y, floor}};
}

void draw_depth(ImDrawList& draw, const AuthorContext& c, const Sight& sight, const AuthorZone& zone, float px) {
  const auto [top, floor] = depth_line(c, zone);
  const ImVec2 a = sight.pixel(top), b = sight.pixel(floor);
  line(draw, a, b, colour_of(zone.layer, 255), 1.5F * px);
  const float r = 8.0F * px;
  draw.AddQuadFilled({b.x - r, b.y}, {b.x, b.y - r}, {b.x + r, b.y}, {b.x, b.y + r}, IM_COL32(0, 0, 0, 220));
  const float s = r - 2.0F * px;
  draw.AddQuadFilled({b.x - s, b.y}, {b.x, b.y - s}, {b.x + s, b.y}, {b.x, b.y + s}, colour_of(zone.layer, 255));
  if (std::hypot(a.x - b.x, a.y - b.y) < 3 * r) return;  // from above the word would cover the points
  const std::string word = fmt::format("depth {} mm", scenarios::written_number(*zone.depth_mm));
  draw.AddText({b.x + r + 4, b.y + 1}, IM_COL32(0, 0, 0, 255), word.c_str());
  draw.AddText({b.x + r + 3, b.y}, IM_COL32(255, 255, 255, 255), word.c_str());
}

void draw_points(ImDrawList& draw, const Sight& sight, const AuthorZone& zone, std::size_t chosen, float px) {
  for (std::size_t i = 0; i < zone.points_mm.size(); ++i) {
    const ImVec2 at = sight.pixel(zone.in_tooth(zone.points_mm[i]));
    const bool this_one = i == chosen;
    draw.AddCircleFilled(at, (this_one ? 9.0F : 6.5F) * px, IM_COL32(0, 0, 0, 220));
    draw.AddCircleFilled(at, (this_one ? 6.5F : 4.5F) * px, this_one ? IM_COL32(255, 255, 255, 255) : colour_of(zone.layer, 255));
    if (this_one) draw.AddCircle(at, 12.0F * px, IM_COL32(255, 255, 255, 255), 24, 2.0F * px);
    const std::string number = std::to_string(i + 1);
    draw.AddText({at.x + 13 * px + 1, at.y - 20 * px + 1}, IM_COL32(0, 0, 0, 255), number.c_str());
    draw.AddText({at.x + 13 * px, at.y - 20 * px}, IM_COL32(255, 255, 255, 255), number.c_str());
  }
}

double apart(ImVec2 a, ImVec2 b) { return std::hypot(static_cast<double>(a.x - b.x), static_cast<double>(a.y - b.y)); }

void take_hold(const AuthorContext& c, const Sight& sight, ImVec2 mouse) {
  AuthorState& s = c.state;
  double nearest = 16.0 * c.screen.theme.scale;
  for (std::size_t z = 0; z < c.zones.size(); ++z) {
    const AuthorZone& zone = c.zones[z];
    for (std::size_t i = 0; i < zone.points_mm.size(); ++i)
      if (const double d = apart(mouse, sight.pixel(zone.in_tooth(zone.points_mm[i]))); d < nearest) {
        nearest = d;
        if (s.zone != z) s.number = 0;
        s.zone = z;
        s.point = i;
        s.pulls_point = true;
      }
  }
  if (s.pulls_point || s.zone >= c.zones.size() || !c.zones[s.zone].depth_mm || c.zones[s.zone].points_mm.empty()) return;
  s.pulls_depth = apart(mouse, sight.pixel(depth_line(c, c.zones[s.zone]).second)) < nearest;
}

void pull(const AuthorContext& c, const Sight& sight, ImVec2 mouse) {
  AuthorState& s = c.state;
  const AuthorZone& zone = c.zones[s.zone];
  if (s.pulls_point && s.point < zone.points_mm.size()) {
    const Vec3 is = zone.in_tooth(zone.points_mm[s.point]), to = sight.on_plane(mouse, is, zone.frame.z, is) - zone.frame.at;
    constexpr double k_grid = 100.0;  // hundredths of a mm
    author_move_point(c, zone, s.point, {std::round(k_grid * dot(to, zone.frame.x)) / k_grid, std::round(k_grid * dot(to, zone.frame.y)) / k_grid, 0},
                      true);
  }
  if (s.pulls_depth && zone.depth_mm) {
    const auto [top, floor] = depth_line(c, zone);
    const ImVec2 a = sight.pixel(floor), b = sight.pixel(floor - Vec3{0, 0, 1}), moved = ImGui::GetIO().MouseDelta;
    const double x = b.x - a.x, y = b.y - a.y, px_per_mm2 = x * x + y * y;
    constexpr double k_least_px = 6;  // a millimetre of depth; seen from above it is a point
    if (px_per_mm2 > k_least_px * k_least_px && (moved.x != 0 || moved.y != 0))
      author_set_number(c, zone.numbers[0], *zone.depth_mm + (moved.x * x + moved.y * y) / px_per_mm2, true);
  }
}

/// The arrows move the chosen point as the picture shows it.
void arrows(const AuthorContext& c) {
  AuthorState& s = c.state;
  const ImGuiIO& io = ImGui::GetIO();
  const AuthorZone& zone = c.zones[s.zone];
  if (zone.points_mm.empty() || io.WantTextInput || io.KeyCtrl) return;
  const int across = ImGui::IsKeyPressed(GLFW_KEY_RIGHT) - ImGui::IsKeyPressed(GLFW_KEY_LEFT);
  const int upwards = ImGui::IsKeyPressed(GLFW_KEY_UP) - ImGui::IsKeyPressed(GLFW_KEY_DOWN);
  if (across == 0 && upwards == 0) return;
  const double step = io.KeyShift ? 0.01 : 0.1;
  const Camera& camera = c.screen.state.view.camera;
  Vec3 to = zone.points_mm[s.point];
  const auto go = [&](Vec3 way, int times) {
    const double x = dot(way, zone.frame.x), y = dot(way, zone.frame.y);
    (std::fabs(x) >= std::fabs(y) ? to.x : to.y) += step * times * ((std::fabs(x) >= std::fabs(y) ? x : y) >= 0 ? 1 : -1);
  };
  go(camera.right(), across);
  go(camera.up(), upwards);
  author_move_point(c, zone, s.point, to, false);
}

}  // namespace

void author_picture(const AuthorContext& c, ImVec2 at, ImVec2 size) {
  AuthorState& s = c.state;
  const bool over = tooth_area(c.screen, size);
  if (c.zones.empty() || s.zone >= c.zones.size()) return;
  const Camera& camera = c.screen.state.view.camera;
  const Sight sight{camera.projection(size.x / size.y) * camera.view(), at, size};
  ImDrawList& draw = *ImGui::GetWindowDrawList();
  const float px = c.screen.theme.scale;
  draw.PushClipRect(at, {at.x + size.x, at.y + size.y}, true);
  for (std::size_t z = 0; z < c.zones.size(); ++z)
    if (z != s.zone && c.state.shown[static_cast<std::size_t>(c.zones[z].layer)]) {
      draw_outline(draw, sight, c.zones[z], false, px);
      for (const Vec3 p : c.zones[z].points_mm)
        draw.AddCircleFilled(sight.pixel(c.zones[z].in_tooth(p)), 4.0F * px, colour_of(c.zones[z].layer, 200));
    }
  const AuthorZone& chosen = c.zones[s.zone];
  draw_outline(draw, sight, chosen, true, px);
  if (chosen.depth_mm && !chosen.points_mm.empty()) draw_depth(draw, c, sight, chosen, px);
  draw_points(draw, sight, chosen, s.point, px);
  draw.PopClipRect();

  const ImVec2 mouse = ImGui::GetIO().MousePos;
  if (over && ImGui::IsMouseClicked(ImGuiMouseButton_Left)) take_hold(c, sight, mouse);
  if (ImGui::IsMouseDown(ImGuiMouseButton_Left)) {
    pull(c, sight, mouse);
  } else if (s.pulls_point || s.pulls_depth) {
    s.pulls_point = s.pulls_depth = false;
    c.document.rest();
  }
  arrows(c);
}

}  // namespace cavum::station
