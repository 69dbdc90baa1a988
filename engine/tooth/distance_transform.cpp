#include "engine/tooth/distance_transform.h"

#include <algorithm>

namespace cavum {
namespace {

constexpr std::int32_t k_none = -1;
constexpr double k_farthest_squared = 1e9;  // more than 3·16,384², the diagonal of the largest
                                            // lattice; what is added to it fits into 32 bits
constexpr std::size_t k_lines_side_by_side = 16;  // taken together, so that memory is read in order

/// Parabolas over the cells of a line, cost[q] + (i - q)², and which is lowest at each cell i.
class LowerEnvelope {
 public:
  explicit LowerEnvelope(std::size_t cells)
      : cost(cells), lowest(cells), owner_(cells), from_(cells) {}

  std::vector<std::int32_t>
      cost;  ///< squared distance of the seed that the cell holds so far; k_none: it holds none
  std::vector<std::int32_t> lowest;  ///< the cell whose parabola is lowest; of equals the earlier

  /// Sets `lowest` from `cost`. False: no cell holds a seed.
  bool find_lowest() {
    count_ = 0;
    const auto n = static_cast<std::int32_t>(cost.size());
    for (std::int32_t q = 0; q < n; ++q)
      if (cost[static_cast<std::size_t>(q)] != k_none) add(q);
    if (count_ == 0) return false;
    for (std::size_t i = 0, k = 0; i < lowest.size(); ++i) {
      while (k + 1 < count_ && from_[k + 1] <= static_cast<std::int32_t>(i)) ++k;
      lowest[i] = owner_[k];
    }
    return true;
  }

 private:
  void add(std::int32_t q) {
    std::int32_t start = 0;
    for (; count_ > 0; --count_) {
      start = crossing(owner_[count_ - 1], q);
      if (start > from_[count_ - 1]) break;
    }
    if (count_ == 0) start = 0;
    if (start >= static_cast<std::int32_t>(cost.size())) return;
    owner_[count_] = q;
    from_[count_++] = start;
  }

  /// First cell at which the parabola of q lies below that of p < q.
  [[nodiscard]] std::int32_t crossing(std::int32_t p, std::int32_t q) const {
    const std::int32_t rise = cost[static_cast<std::size_t>(q)] + q * q -
                              cost[static_cast<std::size_t>(p)] - p * p,
                       apart = 2 * (q - p);
    return (rise >= 0 ? rise / apart : -((apart - 1 - rise) / apart)) + 1;
  }

  std::vector<std::int32_t> owner_,
      from_;  // of the parabolas that are lowest somewhere: their cell, and from which cell on
  std::size_t count_ = 0;
};

/// Along x: the nearer of the last seed on the left and the next on the right, by its place in the
/// row.
std::vector<std::int32_t> nearest_in_rows(std::size_t nx, std::span<const std::uint8_t> seed,
                                          std::int32_t limit) {
  std::vector<std::int32_t> nearest(seed.size());
  for (std::size_t row = 0; row < seed.size(); row += nx) {
    const auto end = static_cast<std::int32_t>(nx);
    std::int32_t left = k_none;
    for (std::int32_t x = 0; x < end; ++x) {
      if (seed[row + static_cast<std::size_t>(x)]) left = x;
      nearest[row + static_cast<std::size_t>(x)] = left;
    }
    std::int32_t right = k_none;
    for (std::int32_t x = end; x-- > 0;) {
      if (seed[row + static_cast<std::size_t>(x)]) right = x;
      auto& best = nearest[row + static_cast<std::size_t>(x)];
      if (right != k_none && (best == k_none || right - x < x - best)) best = right;
      if (best != k_none && (best - x) * (best - x) > limit) best = k_none;
    }
  }
  return nearest;
}

/// Lines along y or z: those that begin side by side at x = 0, 1, … of each of `count` places,
/// `apart` from one another.
struct Lines {
  std::size_t count, apart;
  std::size_t length, step;  ///< cells of a line, and how far apart they are
};

/// `square(f, line, x)`: squared distance of a seed from the cell of a line that holds it as `f`;
/// `named(f, s)`: how it is held from then on, when that was cell s.
template <class Square, class Named>
void pass_along(const Lines& lines, std::size_t nx, std::int32_t limit,
                std::vector<std::int32_t>& nearest, const Square& square, const Named& named) {
  LowerEnvelope envelope(lines.length);
  std::vector<std::int32_t> held(k_lines_side_by_side * lines.length), found(held.size());
  for (std::size_t first = 0; first < nx; first += k_lines_side_by_side) {
    const std::size_t beside = std::min(k_lines_side_by_side, nx - first);
    for (std::size_t line = 0; line < lines.count; ++line) {
      const std::size_t begin = line * lines.apart + first;
      for (std::size_t s = 0; s < lines.length; ++s)
        for (std::size_t c = 0; c < beside; ++c)
          held[c * lines.length + s] = nearest[begin + s * lines.step + c];
      for (std::size_t c = 0; c < beside; ++c) {
        const std::int32_t* seed = held.data() + c * lines.length;
        std::int32_t* out = found.data() + c * lines.length;
        for (std::size_t s = 0; s < lines.length; ++s)
          envelope.cost[s] = seed[s] == k_none ? k_none : square(seed[s], line, first + c);
        const bool any = envelope.find_lowest();
        for (std::size_t s = 0; s < lines.length; ++s) {
          const auto from = static_cast<std::size_t>(any ? envelope.lowest[s] : 0);
          const auto away = static_cast<std::int32_t>(from) - static_cast<std::int32_t>(s);
          out[s] =
              any && envelope.cost[from] + away * away <= limit ? named(seed[from], from) : k_none;
        }
      }
      for (std::size_t s = 0; s < lines.length; ++s)
        for (std::size_t c = 0; c < beside; ++c)
          nearest[begin + s * lines.step + c] = found[c * lines.length + s];
    }
  }
}

std::int32_t squared(std::int32_t a, std::size_t b) {
  const std::int32_t d = a - static_cast<std::int32_t>(b);
  return d * d;
}

constexpr int k_row_bits =
    16;  // of a seed in its layer: its row above its place there, so that nothing need be divided
constexpr std::int32_t k_place = (1 << k_row_bits) - 1;

}  // namespace

std::vector<std::int32_t> nearest_seed(IVec3 size, std::span<const std::uint8_t> seed,
                                       double radius_cells) {
  const auto nx = static_cast<std::size_t>(size.x), ny = static_cast<std::size_t>(size.y),
             nz = static_cast<std::size_t>(size.z), layer = nx * ny;
  const auto limit =
      static_cast<std::int32_t>(std::min(radius_cells * radius_cells, k_farthest_squared));
  std::vector<std::int32_t> nearest = nearest_in_rows(nx, seed, limit);
  // A cell holds a seed of its own row before the pass along y, and one of its own layer before
  // that along z.
  pass_along(
      {.count = nz, .apart = layer, .length = ny, .step = nx}, nx, limit, nearest,
      [](std::int32_t place, std::size_t, std::size_t x) { return squared(place, x); },
      [](std::int32_t place, std::size_t y) {
        return static_cast<std::int32_t>(y << k_row_bits) | place;
      });
  pass_along(
      {.count = ny, .apart = nx, .length = nz, .step = layer}, nx, limit, nearest,
      [](std::int32_t in_layer, std::size_t y, std::size_t x) {
        return squared(in_layer >> k_row_bits, y) + squared(in_layer & k_place, x);
      },
      [&](std::int32_t in_layer, std::size_t z) {
        return static_cast<std::int32_t>(z * layer +
                                         static_cast<std::size_t>(in_layer >> k_row_bits) * nx +
                                         static_cast<std::size_t>(in_layer & k_place));
      });
  return nearest;
}

}  // namespace cavum
