#define GLFW_INCLUDE_NONE
#include <GLFW/glfw3.h>
#include <imgui.h>

#include <algorithm>
#include <cmath>

#include "ui/language/say.h"
#include "ui/station/author_screen.h"
#include "ui/station/author_sight.h"

namespace cavum::station {
namespace {

ImU32 colour_of(AuthorLayer layer, int opacity) {
  const auto c = layer_colour(layer);
  return IM_COL32(c[0], c[1], c[2], opacity);
}

void draw_outline(ImDrawList& draw, const AuthorSight& sight, const AuthorZone& zone, bool chosen,
                  float px) {
  const std::vector<Vec3>& p = zone.points_mm;
  const ImU32 colour = colour_of(zone.layer, chosen ? 255 : 130);
  const float width = chosen ? 2.0F * px : px;
  const auto pixel = [&](Vec3 v) { return sight.pixel(zone.in_tooth(v)); };
  for (std::size_t i = 0; i + (zone.closed ? 0 : 1) < p.size(); ++i) {
    const Vec3 a = p[i], b = p[(i + 1) % p.size()];
    author_line(draw, pixel(a), pixel(b), colour, zone.closed ? width : 0.5F * width);
    if (zone.closed || !(zone.half_width_mm > 0)) continue;
    // the sides of a stroke, and round its points
    const Vec3 along = normalized(b - a, {1, 0, 0}),
               aside = Vec3{-along.y, along.x, 0} * zone.half_width_mm;
    author_line(draw, pixel(a + aside), pixel(b + aside), colour, width);
    author_line(draw, pixel(a - aside), pixel(b - aside), colour, width);
    constexpr int k_parts = 12;
    for (const bool end : {false, true}) {
      const Vec3 middle = end ? b : a,
                 out = along * (end ? zone.half_width_mm : -zone.half_width_mm);
      ImVec2 last = pixel(middle + aside);
      for (int k = 1; k <= k_parts; ++k) {
        const double turn = 3.14159265358979 * k / k_parts;
        const ImVec2 now = pixel(middle + aside * std::cos(turn) + out * std::sin(turn));
        if ((!end && i == 0) || (end && i + 2 == p.size()))
          author_line(draw, last, now, colour, width);
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
  const auto targets = std::count_if(c.zones.begin(), c.zones.end(), [](const AuthorZone& z) {
    return z.layer == AuthorLayer::target;
  });
  // a floor below the surface's lowest place is deeper than the opening's mean level says
  const double floor = targets == 1 && !c.busy ? c.floor_z_mm : top.z - *zone.depth_mm;
  return {top, {top.x, top.y, floor}};
}

void draw_depth(ImDrawList& draw, const AuthorContext& c, const AuthorSight& sight,
                const AuthorZone& zone, float px) {
  const auto [top, floor] = depth_line(c, zone);
  const ImVec2 a = sight.pixel(top), b = sight.pixel(floor);
  author_line(draw, a, b, colour_of(zone.layer, 255), 1.5F * px);
  const float r = 8.0F * px;
  draw.AddQuadFilled({b.x - r, b.y}, {b.x, b.y - r}, {b.x + r, b.y}, {b.x, b.y + r},
                     IM_COL32(0, 0, 0, 220));
  const float s = r - 2.0F * px;
  draw.AddQuadFilled({b.x - s, b.y}, {b.x, b.y - s}, {b.x + s, b.y}, {b.x, b.y + s},
                     colour_of(zone.layer, 255));
  if (std::hypot(a.x - b.x, a.y - b.y) < 3 * r)
    return;  // from above the word would cover the points
  const std::string word = tr("depth {}", as_mm(*zone.depth_mm, k_as_needed));
  author_words(draw, {b.x + r + 3, b.y}, IM_COL32_WHITE, word.c_str());
}

void draw_points(ImDrawList& draw, const AuthorSight& sight, const AuthorZone& zone,
                 std::size_t chosen, float px) {
  for (std::size_t i = 0; i < zone.points_mm.size(); ++i) {
    const ImVec2 at = sight.pixel(zone.in_tooth(zone.points_mm[i]));
    const bool this_one = i == chosen;
    draw.AddCircleFilled(at, (this_one ? 9.0F : 6.5F) * px, IM_COL32(0, 0, 0, 220));
    draw.AddCircleFilled(at, (this_one ? 6.5F : 4.5F) * px,
                         this_one ? IM_COL32(255, 255, 255, 255) : colour_of(zone.layer, 255));
    if (this_one) draw.AddCircle(at, 12.0F * px, IM_COL32(255, 255, 255, 255), 24, 2.0F * px);
    const std::string number = std::to_string(i + 1);
    author_words(draw, {at.x + 13 * px, at.y - 20 * px}, IM_COL32_WHITE, number.c_str());
  }
}

void take_hold(const AuthorContext& c, const AuthorSight& sight, ImVec2 mouse) {
  AuthorState& s = c.state;
  double nearest = 16.0 * c.screen.theme.scale;
  for (std::size_t z = 0; z < c.zones.size(); ++z) {
    const AuthorZone& zone = c.zones[z];
    for (std::size_t i = 0; i < zone.points_mm.size(); ++i)
      if (const double d = pixels_apart(mouse, sight.pixel(zone.in_tooth(zone.points_mm[i])));
          d < nearest) {
        nearest = d;
        if (s.zone != z) s.number = 0;
        s.zone = z;
        s.point = i;
        s.pulls_point = true;
      }
  }
  if (s.pulls_point || s.zone >= c.zones.size() || !c.zones[s.zone].depth_mm ||
      c.zones[s.zone].points_mm.empty())
    return;
  s.pulls_depth = pixels_apart(mouse, sight.pixel(depth_line(c, c.zones[s.zone]).second)) < nearest;
}

void pull(const AuthorContext& c, const AuthorSight& sight, ImVec2 mouse) {
  AuthorState& s = c.state;
  const AuthorZone& zone = c.zones[s.zone];
  if (s.pulls_point && s.point < zone.points_mm.size()) {
    const Vec3 is = zone.in_tooth(zone.points_mm[s.point]),
               to = sight.on_plane(mouse, is, zone.frame.z, is) - zone.frame.at;
    constexpr double k_grid = 100.0;  // hundredths of a mm
    author_move_point(c, zone, s.point,
                      {std::round(k_grid * dot(to, zone.frame.x)) / k_grid,
                       std::round(k_grid * dot(to, zone.frame.y)) / k_grid, 0},
                      true);
  }
  if (s.pulls_depth && zone.depth_mm) {
    const auto [top, floor] = depth_line(c, zone);
    const ImVec2 a = sight.pixel(floor), b = sight.pixel(floor - Vec3{0, 0, 1}),
                 moved = ImGui::GetIO().MouseDelta;
    const double x = b.x - a.x, y = b.y - a.y, px_per_mm2 = x * x + y * y;
    constexpr double k_min_px = 6;  // a millimetre of depth; seen from above it is a point
    if (px_per_mm2 > k_min_px * k_min_px && (moved.x != 0 || moved.y != 0))
      author_set_number(c, zone.numbers[0],
                        *zone.depth_mm + (moved.x * x + moved.y * y) / px_per_mm2, true);
  }
}

/// The arrows move the chosen point as the picture shows it.
void arrows(const AuthorContext& c) {
  AuthorState& s = c.state;
  const ImGuiIO& io = ImGui::GetIO();
  const AuthorZone& zone = c.zones[s.zone];
  if (zone.points_mm.empty()) return;
  const int across = ImGui::IsKeyPressed(GLFW_KEY_RIGHT) - ImGui::IsKeyPressed(GLFW_KEY_LEFT);
  const int upwards = ImGui::IsKeyPressed(GLFW_KEY_UP) - ImGui::IsKeyPressed(GLFW_KEY_DOWN);
  if (across == 0 && upwards == 0) return;
  const double step = io.KeyShift ? 0.01 : 0.1;
  const Camera& camera = c.screen.state.view.camera;
  Vec3 to = zone.points_mm[s.point];
  const auto go = [&](Vec3 way, int times) {
    const double x = dot(way, zone.frame.x), y = dot(way, zone.frame.y);
    (std::fabs(x) >= std::fabs(y) ? to.x : to.y) +=
        step * times * ((std::fabs(x) >= std::fabs(y) ? x : y) >= 0 ? 1 : -1);
  };
  go(camera.right(), across);
  go(camera.up(), upwards);
  author_move_point(c, zone, s.point, to, false);
}

void draw_zones(const AuthorContext& c, ImDrawList& draw, const AuthorSight& sight) {
  const AuthorState& s = c.state;
  const float px = c.screen.theme.scale;
  for (std::size_t z = 0; z < c.zones.size(); ++z)
    if (z != s.zone && s.shown[static_cast<std::size_t>(c.zones[z].layer)]) {
      draw_outline(draw, sight, c.zones[z], false, px);
      for (const Vec3 p : c.zones[z].points_mm)
        draw.AddCircleFilled(sight.pixel(c.zones[z].in_tooth(p)), 4.0F * px,
                             colour_of(c.zones[z].layer, 200));
    }
  const AuthorZone& chosen = c.zones[s.zone];
  draw_outline(draw, sight, chosen, true, px);
  if (chosen.depth_mm && !chosen.points_mm.empty()) draw_depth(draw, c, sight, chosen, px);
  draw_points(draw, sight, chosen, s.point, px);
}

}  // namespace

void author_picture(const AuthorContext& c, ImVec2 at, ImVec2 size) {
  AuthorState& s = c.state;
  const bool over = tooth_area(c.screen, size);
  const Camera& camera = c.screen.state.view.camera;
  const AuthorSight sight{camera.projection(size.x / size.y) * camera.view(), at, size};
  const bool zones = s.zone < c.zones.size();
  ImDrawList& draw = *ImGui::GetWindowDrawList();
  draw.PushClipRect(at, {at.x + size.x, at.y + size.y}, true);
  if (zones) draw_zones(c, draw, sight);
  draw_landmarks(c, draw, sight);
  draw.PopClipRect();

  const ImVec2 mouse = ImGui::GetIO().MousePos;
  if (over && ImGui::IsMouseClicked(ImGuiMouseButton_Left) &&
      !(s.by_landmarks && take_landmark(c, sight, mouse))) {
    if (zones) take_hold(c, sight, mouse);
    if (s.pulls_point || s.pulls_depth)
      s.by_landmarks = false;
    else
      take_landmark(c, sight, mouse);
  }
  if (ImGui::IsMouseDown(ImGuiMouseButton_Left)) {
    if (s.pulls_landmark)
      pull_landmark(c, sight, mouse);
    else if (zones)
      pull(c, sight, mouse);
  } else if (s.pulls_point || s.pulls_depth || s.pulls_landmark) {
    s.pulls_point = s.pulls_depth = s.pulls_landmark = false;
    c.document.rest();
  }
  if (ImGui::GetIO().WantTextInput || ImGui::GetIO().KeyCtrl) return;
  if (s.by_landmarks)
    landmark_arrows(c);
  else if (zones)
    arrows(c);
}

}  // namespace cavum::station
