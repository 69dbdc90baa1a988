#include "scenarios/operators/expert_time.h"

#include <algorithm>
#include <cmath>

namespace cavum::scenarios {
namespace {

// Fitted to runs of the expert on the shipped tasks and on the templates;
// tests/scenarios/advice_test compares them again.
constexpr double k_recession_per_s = 0.495;  // 1/τ of hard tissue at full speed
constexpr double k_free_mm_s = 5.0, k_careful_free_mm_s = 2.0;
constexpr double k_corner_s = 0.03;  // lost at each waypoint
constexpr int k_full_cells =
    48;  // of new tissue in a step of a cell: fewer are brushed away in passing
constexpr double k_cell_mm = 0.1;

/// What is still there of the tooth around the way, in cells.
class Remains {
 public:
  /// `way` and all places are in the tool's frame.
  Remains(const std::vector<Waypoint>& way, const Mat3& held, const Tooth& tooth, const Bur& bur)
      : bur_(bur) {
    Bounds box;
    for (const auto& w : way) box.add(w.tip_mm);
    const Vec3 border{2, 2, 0.5};
    low_ = box.low - border;
    const Vec3 size = box.high + border - low_;
    n_ = {static_cast<int>(size.x / k_cell_mm) + 1, static_cast<int>(size.y / k_cell_mm) + 1,
          static_cast<int>(size.z / k_cell_mm) + 1};
    solid_.resize(cells_of(n_));
    for (int z = 0; z < n_.z; ++z)
      for (int y = 0; y < n_.y; ++y)
        for (int x = 0; x < n_.x; ++x)
          solid_[index(x, y, z)] = tooth.octree.is_solid(tooth.octree.tissue_at(
                                       held * (low_ + Vec3{x + 0.5, y + 0.5, z + 0.5} * k_cell_mm)))
                                       ? 1
                                       : 0;
  }
  /// Takes away what the head fills with its tip at `tip`; how many cells that was.
  int take(Vec3 tip) {
    int taken = 0;
    for (double h = 0.5 * k_cell_mm; h < bur_.cutting_length_mm; h += k_cell_mm) {
      const double r = bur_.profile.radius_mm(h);
      const Vec3 c = (tip + Vec3{0, 0, h} - low_) / k_cell_mm;
      const int z = static_cast<int>(c.z);
      if (z < 0 || z >= n_.z) continue;
      const double rc = r / k_cell_mm;
      const int y0 = std::max(0, static_cast<int>(c.y - rc)),
                y1 = std::min(n_.y - 1, static_cast<int>(c.y + rc));
      for (int y = y0; y <= y1; ++y) {
        const double dy = y + 0.5 - c.y, w2 = rc * rc - dy * dy;
        if (w2 <= 0) continue;
        const double w = std::sqrt(w2);
        const int x0 = std::max(0, static_cast<int>(c.x - w + 0.5)),
                  x1 = std::min(n_.x - 1, static_cast<int>(c.x + w - 0.5));
        for (int x = x0; x <= x1; ++x) {
          std::uint8_t& cell = solid_[index(x, y, z)];
          taken += cell;
          cell = 0;
        }
      }
    }
    return taken;
  }

 private:
  [[nodiscard]] std::size_t index(int x, int y, int z) const noexcept {
    return (static_cast<std::size_t>(z) * static_cast<std::size_t>(n_.y) +
            static_cast<std::size_t>(y)) *
               static_cast<std::size_t>(n_.x) +
           static_cast<std::size_t>(x);
  }
  const Bur& bur_;
  Vec3 low_;
  IVec3 n_;
  std::vector<std::uint8_t> solid_;
};

}  // namespace

double expert_time_s(const std::vector<Waypoint>& tooth_way, const Mat3& held, const Tooth& tooth,
                     const ContactTool& tool, const Skill& skill) {
  if (tooth_way.size() < 2) return 0.0;
  std::vector<Waypoint> way = tooth_way;
  for (auto& w : way) w.tip_mm = held.transposed(w.tip_mm);
  Remains remains(way, held, tooth, tool.bur);
  double time_s = 1.5;  // until the handpiece turns, and the rest at the end
  for (std::size_t i = 1; i < way.size(); ++i) {
    const Vec3 from = way[i - 1].tip_mm, whole = way[i].tip_mm - from;
    const double far_mm = length(whole),
                 press_mm =
                     (way[i].careful ? skill.careful_press_n : skill.press_n) / k_hard_n_per_mm;
    const double free_mm_s = way[i].careful ? k_careful_free_mm_s : k_free_mm_s;
    const int steps = std::max(1, static_cast<int>(far_mm / k_cell_mm + 0.5));
    for (int k = 1; k <= steps; ++k) {
      const int taken =
          way[i].cut ? remains.take(from + whole * (static_cast<double>(k) / steps)) : 0;
      const double share = std::min(1.0, static_cast<double>(taken) / k_full_cells);
      time_s += far_mm / steps * (share / (press_mm * k_recession_per_s) + (1 - share) / free_mm_s);
    }
    time_s += way[i].cut ? k_corner_s : 0.0;
  }
  return time_s;
}

}  // namespace cavum::scenarios
