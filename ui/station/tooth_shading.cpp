#include "ui/station/tooth_shading.h"

#include <algorithm>
#include <cmath>

namespace cavum::station {
namespace {

constexpr int k_cell = 4;        // leaves of the smallest cube
constexpr int k_mix_margin = 3;  // leaves around a patch's points that the blend of tissues sees
constexpr int k_mix_window = SurfacePatches::k_edge + 1 + 2 * k_mix_margin;
constexpr int k_listed = 16;  // tissues with a colour of their own

int cells_of(int leaves, int edge) { return (leaves + edge - 1) / edge; }
std::size_t listed(std::uint8_t tissue) { return std::min<std::size_t>(tissue, k_listed - 1); }
std::uint8_t of_255(float share) {
  return static_cast<std::uint8_t>(std::lround(255.0F * std::clamp(share, 0.0F, 1.0F)));
}

/// Leaves around a patch.
struct MixWindow {
  std::vector<std::uint8_t> tissue;
  std::vector<std::int8_t> code;
  IVec3 low;
};

/// The two tissues that a place of the surface is of, by the leaves around: nearer ones count more.
std::array<std::uint8_t, 4> tissues_at(const MixWindow& window,
                                       const std::array<double, 3>& in_leaves,
                                       std::uint8_t fallback) {
  constexpr double k_wide = 2.5;  // leaves
  std::array<int, 3> first{};
  std::array<std::array<float, 5>, 3> weight{};
  const std::array<int, 3> low{window.low.x, window.low.y, window.low.z};
  for (std::size_t i = 0; i < 3; ++i) {
    const double middle = in_leaves[i] - 0.5 - low[i];  // 0 = the middle of the window's first leaf
    first[i] = std::clamp(static_cast<int>(std::lround(middle)) - 2, 0, k_mix_window - 5);
    for (int k = 0; k < 5; ++k)
      weight[i][static_cast<std::size_t>(k)] =
          static_cast<float>(std::max(0.0, k_wide - std::fabs(first[i] + k - middle)));
  }
  std::array<float, k_listed> hard{};
  float pulp = 0, hollow = 0;
  for (std::size_t z = 0; z < 5; ++z)
    for (std::size_t y = 0; y < 5; ++y) {
      const std::size_t row =
          static_cast<std::size_t>(first[0]) +
          static_cast<std::size_t>(k_mix_window) *
              (static_cast<std::size_t>(first[1]) + y +
               static_cast<std::size_t>(k_mix_window) * (static_cast<std::size_t>(first[2]) + z));
      const float of_row = weight[1][y] * weight[2][z];
      for (std::size_t x = 0; x < 5; ++x) {
        const float w = of_row * weight[0][x];
        const std::uint8_t t = window.tissue[row + x];
        if (window.code[row + x] < 0 && t != k_air && t != k_pulp)
          hard[listed(t)] += w;
        else
          (t == k_pulp ? pulp : hollow) += w;
      }
    }
  std::size_t most = listed(fallback), second = most;
  for (std::size_t i = 0; i < hard.size(); ++i)
    if (hard[i] > hard[most]) most = i;
  float next = 0;
  for (std::size_t i = 0; i < hard.size(); ++i)
    if (i != most && hard[i] > next) {
      next = hard[i];
      second = i;
    }
  // a border is sharper than what is looked at
  float share = hard[most] + next > 0 ? next / (hard[most] + next) : 0.0F;
  share = std::clamp(0.5F + 1.6F * (share - 0.5F), 0.0F, 1.0F);
  const float all = pulp + hollow;
  return {static_cast<std::uint8_t>(most), static_cast<std::uint8_t>(second), of_255(share),
          of_255(all > 0 ? pulp / all : 0.0F)};
}

}  // namespace

ToothShading::ToothShading(const LeafBlocks& leaves)
    : origin_mm_(leaves.origin_mm().x, leaves.origin_mm().y, leaves.origin_mm().z),
      cell_mm_(static_cast<float>(k_cell * leaves.leaf_mm())),
      leaf_mm_(leaves.leaf_mm()) {
  for (Pyramid* pyramid : {&filled_, &dentin_})
    for (std::size_t l = 0; l < k_levels; ++l) {
      const int edge = k_cell << l;
      Shares& s = (*pyramid)[l];
      s.size = {cells_of(leaves.size().x, edge), cells_of(leaves.size().y, edge),
                cells_of(leaves.size().z, edge)};
      s.share.assign(cells_of(s.size), 0);
    }
  const LeafBounds whole{{0, 0, 0}, leaves.size() - IVec3{1, 1, 1}};
  update(leaves, std::span(&whole, 1));
}

void ToothShading::update(const LeafBlocks& leaves, std::span<const LeafBounds> changed) {
  for (const LeafBounds& box : changed) {
    const auto cell = [](IVec3 leaf) {
      return IVec3{leaf.x / k_cell, leaf.y / k_cell, leaf.z / k_cell};
    };
    const IVec3 low = cell(box.low), high = cell(box.high);
    count(leaves, low, high);
    halve(filled_, low, high);
    halve(dentin_, low, high);
  }
}

void ToothShading::count(const LeafBlocks& leaves, IVec3 low, IVec3 high) {
  constexpr std::size_t k_in_cell = static_cast<std::size_t>(k_cell) * k_cell * k_cell;
  std::array<std::uint8_t, k_in_cell> tissue;
  std::array<std::int8_t, k_in_cell> code;
  Shares& filled = filled_[0];
  Shares& dentin = dentin_[0];
  for (int z = low.z; z <= std::min(high.z, filled.size.z - 1); ++z)
    for (int y = low.y; y <= std::min(high.y, filled.size.y - 1); ++y)
      for (int x = low.x; x <= std::min(high.x, filled.size.x - 1); ++x) {
        leaves.copy_cube({x * k_cell, y * k_cell, z * k_cell}, k_cell, tissue.data(), code.data());
        std::size_t all = 0, of_dentin = 0;
        for (std::size_t i = 0; i < k_in_cell; ++i) {
          const bool pulp = tissue[i] == k_pulp;
          all += code[i] < 0 || pulp ? 1 : 0;
          of_dentin += pulp || (code[i] < 0 && tissue[i] == k_dentin) ? 1 : 0;
        }
        const auto at = static_cast<std::size_t>((z * filled.size.y + y) * filled.size.x + x);
        filled.share[at] = static_cast<std::uint8_t>(all * 255 / k_in_cell);
        dentin.share[at] = static_cast<std::uint8_t>(of_dentin * 255 / k_in_cell);
      }
}

void ToothShading::halve(Pyramid& pyramid, IVec3 low, IVec3 high) {
  for (std::size_t l = 1; l < k_levels; ++l) {
    const Shares& fine = pyramid[l - 1];
    Shares& coarse = pyramid[l];
    low = {low.x / 2, low.y / 2, low.z / 2};
    high = {std::min(high.x / 2, coarse.size.x - 1), std::min(high.y / 2, coarse.size.y - 1),
            std::min(high.z / 2, coarse.size.z - 1)};
    for (int z = low.z; z <= high.z; ++z)
      for (int y = low.y; y <= high.y; ++y)
        for (int x = low.x; x <= high.x; ++x) {
          int sum = 0;
          for (int i = 0; i < 8; ++i)
            sum += fine.at(2 * x + (i & 1), 2 * y + (i >> 1 & 1), 2 * z + (i >> 2));
          coarse.share[static_cast<std::size_t>((z * coarse.size.y + y) * coarse.size.x + x)] =
              static_cast<std::uint8_t>(sum / 8);
        }
  }
}

float ToothShading::look_up(const Pyramid& pyramid, const glm::vec3& at_mm, float wide_mm) const {
  std::size_t level = 0;
  float cell = cell_mm_;
  for (; level + 1 < k_levels && 1.5F * cell < wide_mm; cell *= 2.0F) ++level;
  const Shares& s = pyramid[level];
  const glm::vec3 p = (at_mm - origin_mm_) / cell - 0.5F, low = glm::floor(p), f = p - low;
  const int x = static_cast<int>(low.x), y = static_cast<int>(low.y), z = static_cast<int>(low.z);
  const auto row = [&](int j, int k) {
    return static_cast<float>(s.at(x, j, k)) * (1.0F - f.x) +
           static_cast<float>(s.at(x + 1, j, k)) * f.x;
  };
  const auto plane = [&](int k) { return row(y, k) * (1.0F - f.y) + row(y + 1, k) * f.y; };
  return (plane(z) * (1.0F - f.z) + plane(z + 1) * f.z) / 255.0F;
}

float ToothShading::open(const glm::vec3& at_mm, const glm::vec3& normal) const {
  constexpr float k_side = 0.82F, k_up = 0.57F,
                  k_wide = 0.7F;  // of a cone that leans by 55 degrees
  constexpr std::array<float, 4> k_far_mm{0.25F, 0.55F, 1.1F, 2.1F};
  const glm::vec3 aside = std::fabs(normal.z) < 0.8F ? glm::vec3(0, 0, 1) : glm::vec3(1, 0, 0);
  const glm::vec3 right = glm::normalize(glm::cross(aside, normal)), up = glm::cross(normal, right);
  const glm::vec3 from = at_mm + 0.75F * cell_mm_ * normal;
  const auto seen_along = [&](const glm::vec3& way) {
    float left = 1.0F;
    for (const float far : k_far_mm)
      left *= 1.0F - look_up(filled_, from + far * way, k_wide * far);
    return left;
  };
  float light = 0.36F * seen_along(normal);
  for (const glm::vec3& side : {right, -right, up, -up})
    light += 0.16F * seen_along(k_up * normal + k_side * side);
  return light;
}

std::vector<ToothVertex> ToothShading::shaded(const LeafBlocks& leaves, const SurfacePatch& patch,
                                              IVec3 number, std::uint8_t own) const {
  constexpr auto k_leaves = static_cast<std::size_t>(k_mix_window) * k_mix_window * k_mix_window;
  constexpr float k_below_mm = 0.9F;
  MixWindow window{std::vector<std::uint8_t>(k_leaves), std::vector<std::int8_t>(k_leaves), {}};
  constexpr int k_lowest = 1 + k_mix_margin;
  constexpr int k_edge = SurfacePatches::k_edge;
  window.low = {number.x * k_edge - k_lowest, number.y * k_edge - k_lowest,
                number.z * k_edge - k_lowest};
  if (own == k_air)
    leaves.copy_cube(window.low, k_mix_window, window.tissue.data(), window.code.data());
  std::vector<ToothVertex> made;
  made.reserve(patch.vertices.size());
  for (const PatchVertex& v : patch.vertices) {
    const glm::vec3 at(v.position_mm[0], v.position_mm[1], v.position_mm[2]);
    const glm::vec3 normal = glm::vec3(v.normal[0], v.normal[1], v.normal[2]) / 32767.0F;
    const auto own_tissue = static_cast<std::uint8_t>(listed(own));
    std::array<double, 3> in_leaves{};
    for (std::size_t i = 0; i < 3; ++i)
      in_leaves[i] = (static_cast<double>(v.position_mm[i]) -
                      static_cast<double>(origin_mm_[static_cast<int>(i)])) /
                     leaf_mm_;
    made.push_back({v.position_mm, v.normal, of_255(open(at, normal)),
                    of_255(look_up(dentin_, at - k_below_mm * normal, 0.8F)),
                    own == k_air ? tissues_at(window, in_leaves, v.tissue)
                                 : std::array<std::uint8_t, 4>{own_tissue, own_tissue, 0, 0}});
  }
  return made;
}

}  // namespace cavum::station
