#include "engine/tooth/leaf_layers.h"

#include "engine/tooth/surface_fit.h"

namespace cavum {

LeafLayers leaf_layers(const WindowBits& solid) noexcept {
  constexpr int k_margin = FitWindow::k_margin, k_edge = FitWindow::k_edge;
  LeafLayers layers{};
  std::uint64_t rest = ~std::uint64_t{0};
  for (std::size_t layer = 0; layer + 1 < k_leaf_layers; ++layer) {
    const int squared = static_cast<int>(layer) + 1;
    WindowBits near{};  // leaves with one of the other kind at this distance; right for the brick's
                        // own leaves
    for (int z = -2; z <= 2; ++z)
      for (int y = -2; y <= 2; ++y)
        for (int x = -2; x <= 2; ++x) {
          if (x * x + y * y + z * z != squared) continue;
          const int shift = x + k_edge * y;
          for (int k = k_margin; k < k_margin + 4; ++k) {
            const std::uint64_t there = solid[static_cast<std::size_t>(k + z)],
                                here = solid[static_cast<std::size_t>(k)];
            near[static_cast<std::size_t>(k)] |=
                (shift < 0 ? there << -shift : there >> shift) ^ here;
          }
        }
    std::uint64_t own = 0;
    for (int z = 0; z < 4; ++z)
      for (int y = 0; y < 4; ++y)
        own |=
            (near[static_cast<std::size_t>(z + k_margin)] >> (k_margin + k_edge * (y + k_margin)) &
             15)
            << (4 * y + 16 * z);
    layers[layer] = own & rest;
    rest &= ~own;
  }
  layers.back() = rest;
  return layers;
}

}  // namespace cavum
