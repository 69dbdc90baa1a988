#include "engine/lab/scan/printable.h"

#include <algorithm>
#include <cmath>

#include "engine/tooth/mesh/read_mesh.h"

namespace cavum {

Printable printable_surface(const Tooth& tooth, const std::array<bool, 256>& around) {
  std::vector<TriangleMesh> parts = connected_parts(outer_surface(tooth, around));
  std::vector<double> mm3;
  for (const auto& part : parts) mm3.push_back(signed_volume_mm3(part));
  const auto largest =
      static_cast<std::size_t>(std::max_element(mm3.begin(), mm3.end()) - mm3.begin());
  Printable p{std::move(parts[largest]), mm3[largest], parts.size() - 1, 0.0};
  for (std::size_t i = 0; i < mm3.size(); ++i)
    p.left_out_mm3 += i == largest ? 0.0 : std::fabs(mm3[i]);
  return p;
}

}  // namespace cavum
