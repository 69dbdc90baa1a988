// How the authoring view draws over the picture of the tooth: pixels from places and lines of sight
// from pixels.
#pragma once

#include <imgui.h>

#include <cmath>
#include <glm/glm.hpp>
#include <utility>

#include "engine/base/vec.h"

namespace cavum::station {

/// Between the tooth and the picture of a window, both ways.
struct AuthorSight {
  glm::mat4 to_picture;
  ImVec2 at, size;

  [[nodiscard]] ImVec2 pixel(Vec3 p) const {
    const glm::vec4 c = to_picture * glm::vec4(p.x, p.y, p.z, 1);
    return {at.x + size.x * (0.5F + 0.5F * c.x / c.w), at.y + size.y * (0.5F - 0.5F * c.y / c.w)};
  }
  /// From the eye through a pixel: a place near the eye, and the way from there to the farthest
  /// place, mm.
  [[nodiscard]] std::pair<Vec3, Vec3> through(ImVec2 pixel) const {
    const float x = 2.0F * (pixel.x - at.x) / size.x - 1.0F,
                y = 1.0F - 2.0F * (pixel.y - at.y) / size.y;
    const glm::mat4 back = glm::inverse(to_picture);
    const glm::vec4 a = back * glm::vec4(x, y, -1, 1), b = back * glm::vec4(x, y, 1, 1);
    const Vec3 from{a.x / a.w, a.y / a.w, a.z / a.w};
    return {from, Vec3{b.x / b.w, b.y / b.w, b.z / b.w} - from};
  }
  /// Where the line of sight through a pixel meets a plane; `otherwise` when it runs along it.
  [[nodiscard]] Vec3 on_plane(ImVec2 pixel, Vec3 in_plane, Vec3 normal, Vec3 otherwise) const {
    const auto [from, way] = through(pixel);
    const double steep = dot(way, normal);
    constexpr double k_least = 0.15;  // seen nearly along the plane, a pixel is millimetres
    if (std::fabs(steep) < k_least * length(way)) return otherwise;
    return from + way * (dot(in_plane - from, normal) / steep);
  }
};

/// A line that is seen on light and on dark.
inline void author_line(ImDrawList& draw, ImVec2 a, ImVec2 b, ImU32 colour, float width) {
  draw.AddLine(a, b, IM_COL32(0, 0, 0, (colour >> IM_COL32_A_SHIFT) * 3 / 4), width + 2.5F);
  draw.AddLine(a, b, colour, width);
}
/// The same for words.
inline void author_words(ImDrawList& draw, ImVec2 at, ImU32 colour, const char* words) {
  draw.AddText({at.x + 1, at.y + 1}, IM_COL32(0, 0, 0, colour >> IM_COL32_A_SHIFT), words);
  draw.AddText(at, colour, words);
}

[[nodiscard]] inline double pixels_apart(ImVec2 a, ImVec2 b) {
  return std::hypot(static_cast<double>(a.x - b.x), static_cast<double>(a.y - b.y));
}

}  // namespace cavum::station
