#include "ui/station/side_words.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <tuple>

#include "engine/tooth/octree_edit.h"
#include "ui/language/say.h"
#include "ui/station/window.h"

namespace cavum::station {
namespace {

float across(ImVec2 a, ImVec2 b) { return a.x * b.y - a.y * b.x; }
ImVec2 way(ImVec2 from, ImVec2 to) { return {to.x - from.x, to.y - from.y}; }

/// Places of the tooth as pixels of a picture; none behind the eye.
struct Pixels {
  glm::mat4 to_picture;
  ImVec2 size;
  [[nodiscard]] std::optional<ImVec2> of(Vec3 p) const {
    const glm::vec4 c = to_picture * glm::vec4(p.x, p.y, p.z, 1);
    if (c.w < 1.0F) return std::nullopt;
    return ImVec2{size.x * (0.5F + 0.5F * c.x / c.w), size.y * (0.5F - 0.5F * c.y / c.w)};
  }
};

/// What a convex body covers in the picture: corners around it.
using Outline = std::vector<ImVec2>;

Outline outline_of(Outline points) {
  std::sort(points.begin(), points.end(),
            [](ImVec2 a, ImVec2 b) { return a.x < b.x || (a.x == b.x && a.y < b.y); });
  Outline around;
  for (int half = 0; half < 2; ++half) {
    const std::size_t first = around.size();
    for (const ImVec2 p : points) {
      while (around.size() > first + 1 &&
             across(way(around[around.size() - 2], around.back()), way(around.back(), p)) <= 0)
        around.pop_back();
      around.push_back(p);
    }
    around.pop_back();
    std::reverse(points.begin(), points.end());
  }
  return around;
}

/// A crown bulges: rounder than its box. From above an ellipse between the middles of the box's
/// sides and its corners.
Outline outline_of(Vec3 low, Vec3 high, bool round, const Pixels& pixels) {
  constexpr int k_around = 24;
  constexpr double k_bulge = 1.12;  // of a crown beyond the ellipse in its box, across
  Outline points;
  const Vec3 middle = (low + high) * 0.5, half = (high - low) * 0.5;
  for (const double z : {low.z, high.z})
    for (int i = 0; i < k_around; ++i) {
      const double a = 6.283185307179586 * (i + 0.5) / k_around, wide = round ? k_bulge : 2.0;
      const double x = std::clamp(wide * std::cos(a), -1.0, 1.0),
                   y = std::clamp(wide * std::sin(a), -1.0, 1.0);
      if (const auto at = pixels.of({middle.x + x * half.x, middle.y + y * half.y, z}))
        points.push_back(*at);
    }
  return points.size() < std::size_t{2} * k_around ? Outline{} : outline_of(std::move(points));
}

bool meets(const Outline& outline, ImVec2 middle, ImVec2 half) {
  const auto apart = [&](ImVec2 axis) {
    const float here = middle.x * axis.x + middle.y * axis.y,
                reach = half.x * std::fabs(axis.x) + half.y * std::fabs(axis.y);
    float least = 1e9F, most = -1e9F;
    for (const ImVec2 p : outline) {
      least = std::min(least, p.x * axis.x + p.y * axis.y);
      most = std::max(most, p.x * axis.x + p.y * axis.y);
    }
    return here + reach < least || here - reach > most;
  };
  if (apart({1, 0}) || apart({0, 1})) return false;
  for (std::size_t i = 0; i < outline.size(); ++i) {
    const ImVec2 edge = way(outline[i], outline[(i + 1) % outline.size()]);
    if (apart({-edge.y, edge.x})) return false;
  }
  return true;
}

}  // namespace

CrownSides crown_sides(const Tooth& tooth, const scenarios::ZoneMap& zones) {
  const Octree& octree = tooth.octree;
  const auto box_of = [&octree](auto counts) {
    const LeafBounds box = octree.bounds([&](std::uint8_t tissue) { return counts(tissue); });
    return std::pair(box.low, box.high);
  };
  auto [low, high] = box_of([](std::uint8_t tissue) { return tissue == k_enamel; });
  if (high.x < 0) std::tie(low, high) = box_of([](std::uint8_t) { return true; });
  const auto mm = [&octree](IVec3 leaf) {
    return octree.origin_mm() + to_vec3(leaf) * octree.leaf_mm();
  };
  CrownSides sides{mm(low), mm(high), zones.target_low_mm(), zones.target_high_mm(),
                   zones.facing().anterior};
  const Vec3 a = sides.cavity_low, b = sides.cavity_high;
  sides.low = min(sides.low, a);
  sides.high = max(sides.high, b);
  return sides;
}

std::vector<SideWord> side_words(const CrownSides& sides, const Camera& camera, int eye,
                                 ImVec2 picture, float apart,
                                 const std::function<ImVec2(const Message&)>& size_of) {
  const Pixels pixels{camera.projection(picture.x / picture.y) * camera.view(eye), picture};
  const Outline crown = outline_of(sides.low, sides.high, true, pixels),
                cavity = outline_of(sides.cavity_low, sides.cavity_high, false, pixels);
  const Vec3 middle_mm = (sides.low + sides.high) * 0.5;
  const auto middle = pixels.of(middle_mm);
  std::vector<SideWord> words;
  if (crown.empty() || cavity.empty() || !middle) return words;
  const float px_per_mm = 0.5F * picture.y * camera.projection(1.0F)[1][1] / camera.distance_mm;
  const std::array<std::pair<Message, Vec3>, 4> all{
      {{msg("mesial"), {1, 0, 0}},
       {msg("distal"), {-1, 0, 0}},
       {sides.anterior ? msg("labial") : msg("buccal"), {0, 1, 0}},
       {msg("lingual"), {0, -1, 0}}}};
  for (const auto& [word, towards] : all) {
    const auto further = pixels.of(middle_mm + towards);
    if (!further) continue;
    ImVec2 d = way(*middle, *further);
    const float length = std::hypot(d.x, d.y);
    constexpr float k_least = 0.2F;  // of its length: it is seen from its end
    if (length < k_least * px_per_mm) continue;
    d = {d.x / length, d.y / length};
    const ImVec2 size = size_of(word), half{0.5F * size.x, 0.5F * size.y},
                 room{half.x + apart, half.y + apart};
    ImVec2 at = *middle;
    const auto inside = [&](ImVec2 p) {
      return p.x >= room.x && p.y >= room.y && p.x <= picture.x - room.x &&
             p.y <= picture.y - room.y;
    };
    if (!inside(at)) continue;
    // outwards until it is beside the crown, or the picture ends
    for (ImVec2 next = at; inside(next); next = {at.x + d.x, at.y + d.y}) {
      at = next;
      if (!meets(crown, at, room)) break;
    }
    if (!meets(cavity, at, half)) words.push_back({word, at, size, towards});
  }
  return words;
}

void draw_side_words(const Theme& theme, const CrownSides& sides, const Camera& camera, bool stereo,
                     ImVec2 at, ImVec2 size) {
  push_font(Font::small);
  ImDrawList& draw = *ImGui::GetWindowDrawList();
  ImVec4 ground = theme.panel;
  ground.w = 0.8F;
  const float pad = theme.px(4);
  const auto size_of = [pad](const Message& word) {
    const ImVec2 text = ImGui::CalcTextSize(tr(word).c_str());
    return ImVec2{text.x + 2 * pad, text.y + pad};
  };
  const ImVec2 picture{stereo ? 0.5F * size.x : size.x, size.y};
  for (int eye = stereo ? -1 : 0; eye <= (stereo ? 1 : 0); eye += 2)
    for (const SideWord& w : side_words(sides, camera, eye, picture, theme.px(6), size_of)) {
      const float left = at.x + (eye > 0 ? picture.x : 0.0F) + w.middle.x - 0.5F * w.size.x,
                  top = at.y + w.middle.y - 0.5F * w.size.y;
      const std::string word = tr(w.word);
      draw.AddRectFilled({left, top}, {left + w.size.x, top + w.size.y}, ink(ground), theme.px(3));
      draw.AddText({left + pad, top + 0.5F * pad}, ink(theme.text), word.c_str());
      if (eye <= 0) ImGui::LogText("%s\n", word.c_str());
    }
  pop_font();
}

}  // namespace cavum::station
