#include "scenarios/zones/distance_transform.h"

#include <algorithm>

namespace cavum {
namespace {

constexpr std::int32_t k_none = -1;  // squared distances stay below 3·1024², so 32 bits do

/// Along one axis: the winner of line cell i is the seed that the cell at argmin_j (i-j)² + cost(j) holds.
struct LinePass {
  std::vector<std::int32_t> cost;    // squared distance so far, k_none = no seed
  std::vector<std::int32_t> seed;    // nearest seed so far
  std::vector<std::int32_t> vertex;  // parabolas of the lower envelope
  std::vector<std::int32_t> from;    // first cell where each is lowest

  explicit LinePass(std::size_t longest) : cost(longest), seed(longest), vertex(longest), from(longest) {}

  /// First whole cell at which the parabola of q lies below that of p < q.
  [[nodiscard]] std::int32_t crossing(std::int32_t p, std::int32_t q) const {
    const std::int32_t numerator = cost[static_cast<std::size_t>(q)] + q * q - cost[static_cast<std::size_t>(p)] - p * p;
    const std::int32_t denominator = 2 * (q - p);
    const std::int32_t down = numerator >= 0 ? numerator / denominator : -((-numerator + denominator - 1) / denominator);
    return down + 1;  // a tie goes to the earlier parabola
  }

  template <class Store>
  void run(std::size_t n, const Store& store) {
    std::size_t top = 0;
    bool any = false;
    for (std::size_t q = 0; q < n; ++q) {
      if (cost[q] == k_none) continue;
      if (!any) {
        vertex[0] = static_cast<std::int32_t>(q);
        from[0] = 0;
        top = 0;
        any = true;
        continue;
      }
      std::int32_t start = crossing(vertex[top], static_cast<std::int32_t>(q));
      while (top > 0 && start <= from[top]) {
        --top;
        start = crossing(vertex[top], static_cast<std::int32_t>(q));
      }
      if (top == 0 && start <= 0) {
        vertex[0] = static_cast<std::int32_t>(q);
        continue;
      }
      if (start >= static_cast<std::int32_t>(n)) continue;
      ++top;
      vertex[top] = static_cast<std::int32_t>(q);
      from[top] = start;
    }
    if (!any) return;
    std::size_t at = 0;
    for (std::size_t i = 0; i < n; ++i) {
      while (at < top && from[at + 1] <= static_cast<std::int32_t>(i)) ++at;
      const auto v = static_cast<std::size_t>(vertex[at]);
      const auto d = static_cast<std::int32_t>(i) - vertex[at];
      store(i, seed[v], d * d + cost[v]);
    }
  }
};

}  // namespace

std::vector<std::int32_t> nearest_seed(IVec3 size, const std::vector<std::uint8_t>& seed) {
  const auto nx = static_cast<std::size_t>(size.x), ny = static_cast<std::size_t>(size.y), nz = static_cast<std::size_t>(size.z);
  std::vector<std::int32_t> nearest(seed.size(), -1), squared(seed.size(), -1);
  for (std::size_t i = 0; i < seed.size(); ++i)
    if (seed[i] != 0) {
      nearest[i] = static_cast<std::int32_t>(i);
      squared[i] = 0;
    }
  LinePass pass(std::max({nx, ny, nz}));
  const auto along = [&](std::size_t start, std::size_t stride, std::size_t n) {
    for (std::size_t i = 0; i < n; ++i) {
      pass.cost[i] = squared[start + i * stride];
      pass.seed[i] = nearest[start + i * stride];
    }
    pass.run(n, [&](std::size_t i, std::int32_t s, std::int32_t d2) {
      nearest[start + i * stride] = s;
      squared[start + i * stride] = d2;
    });
  };
  for (std::size_t row = 0; row < ny * nz; ++row) along(row * nx, 1, nx);
  for (std::size_t z = 0; z < nz; ++z)
    for (std::size_t x = 0; x < nx; ++x) along(z * nx * ny + x, nx, ny);
  for (std::size_t xy = 0; xy < nx * ny; ++xy) along(xy, nx * ny, nz);
  return nearest;
}

}  // namespace cavum
