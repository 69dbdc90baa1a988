// A crown seen along its long axis: how high its outside stands over each place, smoothed at a
// stated scale, and what follows from it alone: peaks and hollows by their prominence, slopes and
// curvatures. Lengths mm, in the crown's frame.
#pragma once

#include <cstdint>
#include <functional>
#include <vector>

#include "engine/tooth/anatomy/crown_frame.h"

namespace cavum {

/// Heights on a lattice of cells, x fastest. Cells where nothing stands are off.
struct HeightMap {
  static constexpr double k_cell_mm = 0.1;
  int nx = 0, ny = 0;
  double low_x = 0, low_y = 0;  ///< centre of cell (0, 0)
  std::vector<double> z;
  std::vector<std::uint8_t> on;

  [[nodiscard]] int count() const noexcept { return nx * ny; }
  [[nodiscard]] int index(int x, int y) const noexcept { return y * nx + x; }
  [[nodiscard]] bool is_on(int x, int y) const noexcept {
    return x >= 0 && y >= 0 && x < nx && y < ny && on[static_cast<std::size_t>(index(x, y))] != 0;
  }
  [[nodiscard]] double at(int cell) const noexcept { return z[static_cast<std::size_t>(cell)]; }
  [[nodiscard]] Vec3 place(int cell) const noexcept {
    return {low_x + cell % nx * k_cell_mm, low_y + cell / nx * k_cell_mm, at(cell)};
  }
  /// Bilinear height; the nearest cell's beyond the lattice. Cells that are off hold the lowest
  /// height.
  [[nodiscard]] double height(double x_mm, double y_mm) const noexcept;
  /// The nearest cell of a place.
  [[nodiscard]] int cell_at(double x_mm, double y_mm) const noexcept;
  /// The same map smoothed by a bell of standard deviation `sigma_mm` (binomial passes), without
  /// what is off.
  [[nodiscard]] HeightMap smoothed(double sigma_mm) const;
};

/// Height of the outside (the first solid leaf from above) down to the enamel's lowest place.
[[nodiscard]] HeightMap crown_heights(const Tooth& tooth, const CrownFrame& frame);

/// A peak (or hollow) of a map.
struct Peak {
  int cell = 0;
  double prominence_mm = 0.0;  ///< to the highest saddle towards a higher peak; of the highest
                               ///< peak: to the lowest height
  int saddle = -1;             ///< cell of that saddle; -1 for the highest peak
};
/// Peaks of at least this prominence, highest first. Hollows: the same of the map upside down;
/// there, whoever drains off the crown has the rim's saddle.
[[nodiscard]] std::vector<Peak> find_peaks(const HeightMap& map, double least_prominence_mm);
[[nodiscard]] std::vector<Peak> find_hollows(const HeightMap& map, double least_depth_mm);
/// A peak's place between cells, by the parabola through its neighbours.
[[nodiscard]] Vec3 refined_peak(const HeightMap& map, int cell);

/// Principal curvatures of the heights (1/mm; valleys are positive) at each cell, 0 where a
/// neighbour is off.
struct Curvatures {
  std::vector<double> larger, smaller;
};
[[nodiscard]] Curvatures curvatures(const HeightMap& map);

}  // namespace cavum
