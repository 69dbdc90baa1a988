#include "engine/tooth/surface_fit.h"

#include <cstddef>

namespace cavum {
namespace {

/// Weight of a leaf by the square of its distance, 1..6: r^-6 for the near plane, r^-2 for the wide one. A guess weighs 1.
constexpr std::array<std::int32_t, 7> k_near_weight{0, 4096, 512, 152, 64, 33, 19}, k_wide_weight{0, 3600, 1800, 1200, 900, 720, 600};
constexpr int k_reach_squared = 6, k_neighbours = 80;

/// 1, x, y, z, xx, yy, zz, xy, xz, yz of a neighbour: what it adds to the normal equations.
using Terms = std::array<std::int32_t, 12>;
struct Neighbour {
  int step = 0;
  std::int32_t wide_weight = 0;
  Terms guess, near, wide;
};

constexpr std::array<Neighbour, k_neighbours> k_around = [] {
  std::array<Neighbour, k_neighbours> around{};
  std::size_t n = 0;
  for (int z = -2; z <= 2; ++z)
    for (int y = -2; y <= 2; ++y)
      for (int x = -2; x <= 2; ++x) {
        const int squared = x * x + y * y + z * z;
        if (squared == 0 || squared > k_reach_squared) continue;
        auto& to = around[n++];
        to.step = FitWindow::index(x, y, z) - FitWindow::index(0, 0, 0);
        to.wide_weight = k_wide_weight[static_cast<std::size_t>(squared)];
        to.guess = {1, x, y, z, x * x, y * y, z * z, x * y, x * z, y * z};
        for (std::size_t i = 0; i < to.guess.size(); ++i) {
          to.near[i] = to.guess[i] * k_near_weight[static_cast<std::size_t>(squared)];
          to.wide[i] = to.guess[i] * to.wide_weight;
        }
      }
  return around;
}();

/// Normal equations of the plane d = p0 + p1 x + p2 y + p3 z.
struct Plane {
  Terms sum{};
  std::array<std::int32_t, 4> right{};
  void add(const Terms& terms, std::int32_t code) noexcept {
    for (std::size_t i = 0; i < terms.size(); ++i) sum[i] += terms[i];
    for (std::size_t i = 0; i < right.size(); ++i) right[i] += terms[i] * code;
  }
  /// p0, by elimination from the last row up. The 1 and 4 on the diagonal pull towards 0 where there is nothing to go by.
  [[nodiscard]] double at_centre() const noexcept {
    const auto s = [this](std::size_t i) { return static_cast<double>(sum[i]); };
    const auto r = [this](std::size_t i) { return static_cast<double>(right[i]); };
    double m[4][5] = {{s(0) + 1, s(1), s(2), s(3), r(0)},
                      {s(1), s(4) + 4, s(7), s(8), r(1)},
                      {s(2), s(7), s(5) + 4, s(9), r(2)},
                      {s(3), s(8), s(9), s(6) + 4, r(3)}};
    for (int k = 3; k > 0; --k)
      for (int row = 0; row < k; ++row) {
        const double factor = m[row][k] / m[k][k];
        for (int i = 0; i < k; ++i) m[row][i] -= factor * m[k][i];
        m[row][4] -= factor * m[k][4];
      }
    return m[0][4] / m[0][0];
  }
};

}  // namespace

SurfaceFit fit_surface(const FitWindow& window, int index) noexcept {
  Plane near, wide;
  std::int32_t errors = 0, weights = 0;
  for (const auto& to : k_around) {
    const FitLeaf leaf = window.leaf[static_cast<std::size_t>(index + to.step)];
    if (leaf.error == FitLeaf::k_unused) continue;
    if (leaf.error == FitLeaf::k_guess) {
      near.add(to.guess, leaf.code);
      wide.add(to.guess, leaf.code);
      continue;
    }
    near.add(to.near, leaf.code);
    wide.add(to.wide, leaf.code);
    errors += to.wide_weight * leaf.error;
    weights += to.wide_weight;
  }
  return {near.at_centre(), wide.at_centre(), weights > 0 ? 8 * errors / weights : -1};
}

}  // namespace cavum
