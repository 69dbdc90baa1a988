#include "engine/tooth/surface_fit.h"

#include <cstddef>

namespace cavum {
namespace {

// Both planes at once, with the vector types of g++ and clang: this is most of the time that
// loading a tooth takes.
typedef std::int16_t Shorts [[gnu::vector_size(16)]];
typedef float Floats [[gnu::vector_size(16)]];
typedef double Two [[gnu::vector_size(16)]];

/// Neighbours at squared distance g, 1..5, are group g: how many, and their weight: r^-6 for the
/// near plane, r^-2 for the wide one. A guess weighs 1 wherever it is. All sums of a group fit into
/// 16 bits, and weighted sums stay below 2^24: exact in a float.
constexpr std::array<std::size_t, 6> k_count{0, 6, 12, 8, 6, 24};
constexpr std::array<float, 6> k_near_weight{0, 4096, 512, 152, 64, 33},
    k_wide_weight{0, 1800, 900, 600, 450, 360};
constexpr std::size_t k_neighbours = 56;

/// What a neighbour at x, y, z adds to the normal equations.
struct Neighbour {
  Shorts squares;  ///< 1, x, y, z, xx, yy, zz, xy
  Shorts others;   ///< 1, x, y, z (to be multiplied by its code), xz, yz
  std::int16_t step;
};

const std::array<Neighbour, k_neighbours> k_around = [] {  // group after group
  std::array<Neighbour, k_neighbours> around{};
  std::size_t n = 0;
  for (int squared = 1; squared <= 5; ++squared)
    for (int z = -2; z <= 2; ++z)
      for (int y = -2; y <= 2; ++y)
        for (int x = -2; x <= 2; ++x) {
          if (x * x + y * y + z * z != squared) continue;
          const auto s = [](int v) { return static_cast<std::int16_t>(v); };
          around[n++] = {Shorts{1, s(x), s(y), s(z), s(x * x), s(y * y), s(z * z), s(x * y)},
                         Shorts{1, s(x), s(y), s(z), s(x * z), s(y * z), 0, 0},
                         s(FitWindow::index(x, y, z) - FitWindow::index(0, 0, 0))};
        }
  return around;
}();

/// Sums over leaves; in halves, as wider vectors would be taken apart in memory.
struct Sums {
  Floats squares_low{}, squares_high{}, others_low{}, others_high{};
  void add(Shorts squares, Shorts others, float weight) noexcept {
    squares_low +=
        __builtin_convertvector(__builtin_shufflevector(squares, squares, 0, 1, 2, 3), Floats) *
        weight;
    squares_high +=
        __builtin_convertvector(__builtin_shufflevector(squares, squares, 4, 5, 6, 7), Floats) *
        weight;
    others_low +=
        __builtin_convertvector(__builtin_shufflevector(others, others, 0, 1, 2, 3), Floats) *
        weight;
    others_high +=
        __builtin_convertvector(__builtin_shufflevector(others, others, 4, 5, 6, 7), Floats) *
        weight;
  }
};

}  // namespace

SurfaceFit fit_surface(const FitWindow& window, int index) noexcept {
  Shorts guess_squares{}, guess_others{};
  Sums near, wide;
  float errors = 0, weights = 0;
  const Neighbour* to = k_around.data();
  for (std::size_t group = 1; group < k_count.size(); ++group) {
    Shorts squares{}, others{};
    int error = 0;
    for (const Neighbour* const end = to + k_count[group]; to != end; ++to) {
      const FitLeaf leaf = window.leaf[static_cast<std::size_t>(index + to->step)];
      if (leaf.error == FitLeaf::k_unused) continue;
      const std::int16_t code = leaf.code;
      const Shorts with_code = to->others * Shorts{code, code, code, code, 1, 1, 0, 0};
      if (leaf.error == FitLeaf::k_guess) {
        guess_squares += to->squares;
        guess_others += with_code;
      } else {
        squares += to->squares;
        others += with_code;
        error += leaf.error;
      }
    }
    near.add(squares, others, k_near_weight[group]);
    wide.add(squares, others, k_wide_weight[group]);
    errors += static_cast<float>(error) * k_wide_weight[group];
    weights += static_cast<float>(squares[0]) * k_wide_weight[group];
  }
  near.add(guess_squares, guess_others, 1);
  wide.add(guess_squares, guess_others, 1);
  // The plane d = p0 + p1 x + p2 y + p3 z: p0, by elimination from the last row up. The 1 and 4 on
  // the diagonal pull towards 0 where there is nothing to go by.
  const auto s = [&](int i) {
    return i < 4 ? Two{near.squares_low[i], wide.squares_low[i]}
                 : Two{near.squares_high[i - 4], wide.squares_high[i - 4]};
  };
  const auto o = [&](int i) {
    return i < 4 ? Two{near.others_low[i], wide.others_low[i]}
                 : Two{near.others_high[i - 4], wide.others_high[i - 4]};
  };
  Two m[4][5] = {{s(0) + 1.0, s(1), s(2), s(3), o(0)},
                 {s(1), s(4) + 4.0, s(7), o(4), o(1)},
                 {s(2), s(7), s(5) + 4.0, o(5), o(2)},
                 {s(3), o(4), o(5), s(6) + 4.0, o(3)}};
  for (int k = 3; k > 0; --k)
    for (int row = 0; row < k; ++row) {
      const Two factor = m[row][k] / m[k][k];
      for (int i = 0; i < k; ++i) m[row][i] -= factor * m[k][i];
      m[row][4] -= factor * m[k][4];
    }
  const Two centre = m[0][4] / m[0][0];
  return {centre[0], centre[1], weights > 0 ? static_cast<int>(8 * errors / weights) : -1};
}

}  // namespace cavum
