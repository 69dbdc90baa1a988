#include "ui/station/tooth_drawing.h"

#include <epoxy/gl.h>

#include <algorithm>
#include <array>
#include <cmath>

namespace cavum::station {
namespace {

constexpr int k_block = 5;  // patches along a block's edge
/// Edge of a cell that becomes one vertex where nobody worked, and where somebody did: a renderer
/// on the processor draws a tenth and a third of the triangles, a graphics card a third and all.
struct Cells {
  int untouched, cut;  // leaves
};
constexpr Cells k_cells_by_processor{4, 2}, k_cells{2, 1};

glm::vec3 place_mm(const ToothVertex& v) { return {v.at_mm[0], v.at_mm[1], v.at_mm[2]}; }

IVec3 patches_of(IVec3 leaves) {
  constexpr int k_edge = SurfacePatches::k_edge;
  return {leaves.x / k_edge + 1, leaves.y / k_edge + 1, leaves.z / k_edge + 1};
}

}  // namespace

ToothDrawing::ToothDrawing(const Octree& tooth)
    : by_processor_(drawn_by_processor()),
      leaves_(tooth),
      shading_(leaves_),
      size_(patches_of(leaves_.size())),
      blocks_{(size_.x + k_block - 1) / k_block, (size_.y + k_block - 1) / k_block,
              (size_.z + k_block - 1) / k_block},
      hard_(made(SurfacePatches::k_hard_tissue)),
      pulp_(made(k_pulp)) {
  // of the whole tooth: what is cut away later makes it no larger
  box_mm_ = {glm::vec3(1e9F), glm::vec3(-1e9F)};
  for (const Block& b : hard_.blocks) {
    if (b.mesh.empty()) continue;
    box_mm_[0] = glm::min(box_mm_[0], b.extent.middle_mm - b.extent.radius_mm);
    box_mm_[1] = glm::max(box_mm_[1], b.extent.middle_mm + b.extent.radius_mm);
  }
}

ToothDrawing::Drawn ToothDrawing::made(std::uint8_t own) {
  Drawn drawn{SurfacePatches(leaves_, own), own, {}, {}, {}};
  drawn.patches.resize(drawn.surface.count());
  drawn.blocks.resize(cells_of(blocks_));
  for (std::uint32_t i = 0; i < drawn.patches.size(); ++i) remake(drawn, i);
  for (std::size_t b = 0; b < drawn.blocks.size(); ++b) send(drawn, b);
  return drawn;
}

IVec3 ToothDrawing::place_of(std::uint32_t number) const {
  const auto n = static_cast<int>(number);
  return {n % size_.x, n / size_.x % size_.y, n / size_.x / size_.y};
}
std::uint32_t ToothDrawing::number_of(IVec3 patch) const {
  return static_cast<std::uint32_t>((patch.z * size_.y + patch.y) * size_.x + patch.x);
}
std::size_t ToothDrawing::block_of(IVec3 patch) const {
  return static_cast<std::size_t>(
      ((patch.z / k_block) * blocks_.y + patch.y / k_block) * blocks_.x + patch.x / k_block);
}

template <class Visit>
void ToothDrawing::for_each_around(IVec3 patch, int reach, const Visit& visit) const {
  for (int z = std::max(0, patch.z - reach); z <= std::min(size_.z - 1, patch.z + reach); ++z)
    for (int y = std::max(0, patch.y - reach); y <= std::min(size_.y - 1, patch.y + reach); ++y)
      for (int x = std::max(0, patch.x - reach); x <= std::min(size_.x - 1, patch.x + reach); ++x)
        visit(IVec3{x, y, z});
}

void ToothDrawing::remake(Drawn& drawn, std::uint32_t number) {
  Patch& patch = drawn.patches[number];
  patch.old = false;
  const SurfacePatch& surface = drawn.surface.patch(number);
  const IVec3 at = place_of(number);
  drawn.blocks[block_of(at)].old = true;
  patch.open = std::any_of(surface.vertices.begin(), surface.vertices.end(),
                           [](const PatchVertex& v) { return v.beside == k_air; });
  if (surface.triangles.empty()) {
    patch.vertices.clear();
    patch.triangles.clear();
    return;
  }
  const Cells cells = by_processor_ ? k_cells_by_processor : k_cells;
  PatchPosition place{at, leaves_.leaf_mm(), leaves_.origin_mm(), {}};
  for_each_around(at, 1, [&](IVec3 p) {
    place.cells[PatchPosition::beside(p.x - at.x, p.y - at.y, p.z - at.z)] =
        drawn.patches[number_of(p)].cut ? cells.cut : cells.untouched;
  });
  SurfacePatch thin = thinned(surface, place);
  patch.vertices = shading_.shaded(leaves_, thin, at, drawn.own);
  patch.triangles = std::move(thin.triangles);
}

void ToothDrawing::send(Drawn& drawn, std::size_t block) {
  Block& b = drawn.blocks[block];
  b.old = b.open = false;
  vertices_.clear();
  indices_.clear();
  const auto n = static_cast<int>(block);
  const IVec3 low{n % blocks_.x * k_block, n / blocks_.x % blocks_.y * k_block,
                  n / blocks_.x / blocks_.y * k_block};
  for (int z = low.z; z < std::min(low.z + k_block, size_.z); ++z)
    for (int y = low.y; y < std::min(low.y + k_block, size_.y); ++y)
      for (int x = low.x; x < std::min(low.x + k_block, size_.x); ++x) {
        const Patch& patch = drawn.patches[number_of({x, y, z})];
        b.open = b.open || patch.open;
        const auto first = static_cast<std::uint32_t>(vertices_.size());
        vertices_.insert(vertices_.end(), patch.vertices.begin(), patch.vertices.end());
        for (const auto& t : patch.triangles)
          for (const std::uint32_t i : t) indices_.push_back(first + i);
      }
  b.mesh.put(vertices_, indices_);
  b.extent = extent_of(vertices_, indices_);
}

ToothDrawing::Extent ToothDrawing::extent_of(std::span<const ToothVertex> vertices,
                                             std::span<const std::uint32_t> indices) {
  Extent e;
  if (indices.empty()) return e;
  glm::vec3 low = place_mm(vertices[0]), high = low;
  for (const ToothVertex& v : vertices) {
    low = glm::min(low, place_mm(v));
    high = glm::max(high, place_mm(v));
  }
  e.middle_mm = (low + high) * 0.5F;
  e.radius_mm = glm::length(high - low) * 0.5F;
  const auto normal_of = [&](std::size_t i) {
    const glm::vec3 a = place_mm(vertices[indices[i]]);
    const glm::vec3 n =
        glm::cross(place_mm(vertices[indices[i + 1]]) - a, place_mm(vertices[indices[i + 2]]) - a);
    const float size = glm::length(n);
    return size > 0 ? n / size : glm::vec3(0);
  };
  for (std::size_t i = 0; i < indices.size(); i += 3) e.axis += normal_of(i);
  const float size = glm::length(e.axis);
  if (!(size > 0)) return e;
  e.axis /= size;
  float cosine = 1.0F;
  for (std::size_t i = 0; i < indices.size() && cosine > 0; i += 3)
    if (const glm::vec3 n = normal_of(i); n != glm::vec3(0))
      cosine = std::min(cosine, glm::dot(n, e.axis));
  e.sine = cosine > 0 ? std::sqrt(1.0F - std::min(1.0F, cosine * cosine)) : 1.0F;
  return e;
}

void ToothDrawing::mark(Drawn& drawn, std::span<const std::uint32_t> touched) {
  const int light = static_cast<int>(
      std::ceil(ToothShading::k_reach_mm / (SurfacePatches::k_edge * leaves_.leaf_mm())));
  for (const std::uint32_t number : touched) {
    Patch& patch = drawn.patches[number];
    const IVec3 at = place_of(number);
    patch.old = true;
    if (!patch.cut)
      for_each_around(at, 1, [&](IVec3 p) {
        drawn.patches[number_of(p)].old = true;
      });  // their borders become finer
    patch.cut = true;
    for_each_around(at, light, [&](IVec3 p) {
      if (!drawn.patches[number_of(p)].vertices.empty()) drawn.dim.push_back(number_of(p));
    });
  }
}

std::size_t ToothDrawing::update(Drawn& drawn) {
  touched_.clear();
  drawn.surface.update(leaves_, changed_, touched_);
  mark(drawn, touched_);
  // what was cut at once; the light around it a few patches a picture
  constexpr std::size_t k_lit_at_once = 12;
  std::sort(drawn.dim.begin(), drawn.dim.end());
  drawn.dim.erase(std::unique(drawn.dim.begin(), drawn.dim.end()), drawn.dim.end());
  std::size_t made = 0;
  for (std::uint32_t i = 0; i < drawn.patches.size(); ++i)
    if (drawn.patches[i].old) {
      remake(drawn, i);
      ++made;
    }
  for (std::size_t lit = 0; lit < k_lit_at_once && !drawn.dim.empty(); ++lit, ++made) {
    remake(drawn, drawn.dim.back());
    drawn.dim.pop_back();
  }
  for (std::size_t b = 0; b < drawn.blocks.size(); ++b)
    if (drawn.blocks[b].old) send(drawn, b);
  return made;
}

std::size_t ToothDrawing::update() {
  if (changed_.empty() && hard_.dim.empty() && pulp_.dim.empty()) return 0;
  shading_.update(leaves_, changed_);
  const std::size_t patches = update(hard_) + update(pulp_);
  changed_.clear();
  ++version_;
  return patches;
}

double ToothDrawing::distance_mm(Vec3 at_mm) const {
  const Vec3 p = (at_mm - leaves_.origin_mm()) / leaves_.leaf_mm() - Vec3{0.5, 0.5, 0.5};
  const IVec3 low{static_cast<int>(std::floor(p.x)), static_cast<int>(std::floor(p.y)),
                  static_cast<int>(std::floor(p.z))};
  std::array<std::uint8_t, 8> tissue;
  std::array<std::int8_t, 8> code;
  leaves_.copy_cube(low, 2, tissue.data(), code.data());
  double sum = 0;
  for (int i = 0; i < 8; ++i) {
    const double x = p.x - low.x, y = p.y - low.y, z = p.z - low.z;
    const double share =
        ((i & 1) != 0 ? x : 1 - x) * ((i & 2) != 0 ? y : 1 - y) * ((i & 4) != 0 ? z : 1 - z);
    sum += share * decode_distance(code[static_cast<std::size_t>(i)]);
  }
  return sum * leaves_.leaf_mm();
}

std::size_t ToothDrawing::triangles_kept() const noexcept {
  std::size_t n = 0;
  for (const Block& b : hard_.blocks) n += static_cast<std::size_t>(b.mesh.triangles());
  return n;
}

void ToothDrawing::draw(const Drawn& drawn, const Sight& sight, DrawCount& count, bool open_alone,
                        const Ball* ball) const {
  // planes of the picture's sides, unit, inwards
  std::array<glm::vec4, 6> sides;
  const glm::mat4 rows = glm::transpose(sight.to_picture);
  for (std::size_t i = 0; i < sides.size(); ++i) {
    sides[i] = rows[3] + (i % 2 == 0 ? 1.0F : -1.0F) * rows[static_cast<int>(i / 2)];
    sides[i] /= glm::length(glm::vec3(sides[i]));
  }
  std::vector<std::pair<float, std::size_t>>
      seen;  // the nearest first: what they hide need not be shaded
  for (std::size_t i = 0; i < drawn.blocks.size(); ++i) {
    if (drawn.blocks[i].mesh.empty() || (open_alone && !drawn.blocks[i].open)) continue;
    const Extent& e = drawn.blocks[i].extent;
    if (ball != nullptr && (glm::length(e.middle_mm - ball->middle_mm) <
                            e.radius_mm + ball->radius_mm) != ball->within)
      continue;
    const glm::vec3 there = e.middle_mm - sight.eye_mm;
    if (e.sine < 1.0F && glm::dot(there, e.axis) >= e.sine * glm::length(there) + e.radius_mm)
      continue;
    const auto outside = [&e](const glm::vec4& side) {
      return glm::dot(glm::vec3(side), e.middle_mm) + side.w < -e.radius_mm;
    };
    if (std::any_of(sides.begin(), sides.end(), outside)) continue;
    seen.emplace_back(glm::length(there), i);
  }
  std::sort(seen.begin(), seen.end());
  // A renderer on the processor keeps some 400 bytes a triangle until it is told to draw them, and
  // the program never gives the peak back: told in between, its memory stays the same however rich
  // in triangles the cavity becomes.
  constexpr int k_at_once = 20'000;  // triangles, 8 MB
  int waiting = 0;
  for (const auto& [far_mm, i] : seen) {
    drawn.blocks[i].mesh.draw(count);
    waiting += drawn.blocks[i].mesh.triangles();
    if (!by_processor_ || waiting < k_at_once) continue;
    glFinish();
    waiting = 0;
  }
}

}  // namespace cavum::station
