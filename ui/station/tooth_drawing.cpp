#include "ui/station/tooth_drawing.h"

#include <epoxy/gl.h>

#include <algorithm>
#include <array>
#include <cmath>

namespace cavum::station {

ToothDrawing::Drawn ToothDrawing::made(SurfacePatches surface) {
  Drawn drawn{std::move(surface), {}, {}};
  drawn.meshes.resize(drawn.surface.count());
  drawn.extents.resize(drawn.surface.count());
  for (std::size_t i = 0; i < drawn.meshes.size(); ++i) {
    drawn.meshes[i].put(drawn.surface.patch(i));
    drawn.extents[i] = extent_of(drawn.surface.patch(i));
  }
  return drawn;
}

ToothDrawing::Extent ToothDrawing::extent_of(const SurfacePatch& patch) {
  Extent e;
  if (patch.triangles.empty()) return e;
  const auto at = [&patch](std::size_t i) {
    const auto& p = patch.vertices[i].position_mm;
    return glm::vec3(p[0], p[1], p[2]);
  };
  glm::vec3 low = at(0), high = low;
  for (std::size_t i = 1; i < patch.vertices.size(); ++i) {
    low = glm::min(low, at(i));
    high = glm::max(high, at(i));
  }
  e.middle_mm = (low + high) * 0.5F;
  e.radius_mm = glm::length(high - low) * 0.5F;
  std::vector<glm::vec3> normals;
  for (const auto& t : patch.triangles) {
    const glm::vec3 n = glm::cross(at(t[1]) - at(t[0]), at(t[2]) - at(t[0]));
    const float size = glm::length(n);
    if (!(size > 0)) continue;
    normals.push_back(n / size);
    e.axis += normals.back();
  }
  const float size = glm::length(e.axis);
  if (!(size > 0)) return e;
  e.axis /= size;
  float cosine = 1.0F;
  for (const glm::vec3& n : normals) cosine = std::min(cosine, glm::dot(n, e.axis));
  e.sine = cosine > 0 ? std::sqrt(1.0F - std::min(1.0F, cosine * cosine)) : 1.0F;
  return e;
}

ToothDrawing::ToothDrawing(const Octree& tooth)
    : by_processor_(drawn_by_processor()), leaves_(tooth), hard_(made(SurfacePatches(leaves_))), pulp_(made(SurfacePatches(leaves_, k_pulp))) {}

std::size_t ToothDrawing::update(Drawn& drawn) {
  touched_.clear();
  drawn.surface.update(leaves_, changed_, touched_);
  for (const std::uint32_t i : touched_) {
    drawn.meshes[i].put(drawn.surface.patch(i));
    drawn.extents[i] = extent_of(drawn.surface.patch(i));
  }
  return touched_.size();
}

std::size_t ToothDrawing::update() {
  if (changed_.empty()) return 0;
  const std::size_t patches = update(hard_) + update(pulp_);
  changed_.clear();
  ++version_;
  return patches;
}

void ToothDrawing::draw(const Drawn& drawn, const Sight& sight, bool by_processor) {
  // planes of the picture's sides, unit, inwards
  std::array<glm::vec4, 4> sides;
  const glm::mat4 rows = glm::transpose(sight.to_picture);
  for (std::size_t i = 0; i < sides.size(); ++i) {
    sides[i] = rows[3] + (i % 2 == 0 ? 1.0F : -1.0F) * rows[static_cast<int>(i / 2)];
    sides[i] /= glm::length(glm::vec3(sides[i]));
  }
  std::vector<std::pair<float, std::size_t>> seen;  // the nearest first: what they hide need not be shaded
  for (std::size_t i = 0; i < drawn.meshes.size(); ++i) {
    if (drawn.meshes[i].empty()) continue;
    const Extent& e = drawn.extents[i];
    const glm::vec3 there = e.middle_mm - sight.eye_mm;
    if (e.sine < 1.0F && glm::dot(there, e.axis) >= e.sine * glm::length(there) + e.radius_mm) continue;
    const auto outside = [&e](const glm::vec4& side) { return glm::dot(glm::vec3(side), e.middle_mm) + side.w < -e.radius_mm; };
    if (std::any_of(sides.begin(), sides.end(), outside)) continue;
    seen.emplace_back(glm::length(there), i);
  }
  std::sort(seen.begin(), seen.end());
  // A renderer on the processor keeps some 400 bytes a triangle until it is told to draw them, and the program never gives the peak back: told in
  // between, its memory stays the same however rich in triangles the cavity becomes.
  constexpr int k_at_once = 20'000;  // triangles, 8 MB
  int waiting = 0;
  for (const auto& [far_mm, i] : seen) {
    drawn.meshes[i].draw();
    waiting += drawn.meshes[i].triangles();
    if (!by_processor || waiting < k_at_once) continue;
    glFinish();
    waiting = 0;
  }
}

}  // namespace cavum::station
