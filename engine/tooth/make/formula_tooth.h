// Builds a tooth of our own from formulae: a class that says where its outer surface, its pulp, its
// dentin core and its neck lie becomes enamel, dentin, pulp and periodontium on the leaves, with a
// true distance to the surface.
#pragma once

#include <algorithm>
#include <cmath>
#include <concepts>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "engine/base/vec.h"
#include "engine/tooth/tooth.h"

namespace cavum {

/// Which of our teeth; without a seed the parametric one.
struct FormulaKind {
  ToothDesign design{};
  std::optional<std::uint64_t> seed = {};
};

/// How fast the functions of a shape may change, mm per mm: of its class, or of each tooth.
template <class T>
[[nodiscard]] double steepest_of(const T& shape) {
  if constexpr (requires { shape.steepest(); })
    return shape.steepest();
  else
    return T::k_steepest;
}

/// The shape of a tooth in the tooth frame, mm. Each function is negative inside its body and about
/// a distance near its surface; where it says v, its zero is no nearer than |v| / steepest.
template <class T>
concept FormulaTooth = requires(const T& t, Vec3 p) {
  { t.outside(p) } -> std::same_as<double>;         // the whole tooth, whatever it is made of
  { t.pulp(p) } -> std::same_as<double>;            // chamber, horns, canals
  { t.core(p) } -> std::same_as<double>;            // dentin of the crown: enamel lies outside it
  { t.neck_mm(p.x, p.y) } -> std::same_as<double>;  // z of the cervical line: no enamel below it
  { steepest_of(t) } -> std::same_as<double>;       // a k_steepest or a steepest()
};

struct FormulaBox {
  Vec3 low_mm, high_mm;
};

/// Throws Error(name, ...) unless low <= value <= high.
void check_choice(const char* name, double value, double low, double high);

/// The lattice for a box, with four leaves around. Throws Error on a leaf outside 0.03..0.5 mm or a
/// periodontium outside 0..5 mm.
[[nodiscard]] TissueGrid formula_grid(const FormulaBox& box, double leaf_mm, double periodontium_mm,
                                      const std::string& name);
/// Leaves that the lattice cut off from their tissue, such as a sliver of enamel at the neck, go to
/// the tissue around them: enamel, dentin and pulp are one body each then (leaves joined by faces).
/// `field` stays negative exactly in the solid leaves.
void join_tissues(TissueGrid& grid, std::vector<float>& field);
/// Surface, periodontium and octree from labels and field; `solid` is the field anywhere, mm.
[[nodiscard]] Tooth finish_formula_tooth(TissueGrid& grid, const std::vector<float>& field,
                                         const std::function<double(Vec3)>& solid,
                                         double periodontium_mm, const std::string& name,
                                         const FormulaKind& what);

/// Distances are true distances to a triangulation whose corners lie on the formulae's zero (a few
/// micrometres at a 0.05 mm leaf). About 9 s for a molar at 0.05 mm.
template <FormulaTooth T>
[[nodiscard]] Tooth build_formula_tooth(const T& shape, const FormulaBox& box, double leaf_mm,
                                        double periodontium_mm, const std::string& name,
                                        const FormulaKind& what) {
  TissueGrid grid = formula_grid(box, leaf_mm, periodontium_mm, name);
  std::vector<float> field(grid.count());
  // The centre of a block of leaves speaks for all of them while its value is larger than the
  // functions can change within the block and two leaves around it.
  constexpr int k_block = 4;
  const double reach = steepest_of(shape) * leaf_mm * (k_block * 0.8660254037844386 + 2.0);
  for (std::int32_t bz = 0; bz < grid.size.z; bz += k_block)
    for (std::int32_t by = 0; by < grid.size.y; by += k_block)
      for (std::int32_t bx = 0; bx < grid.size.x; bx += k_block) {
        const Vec3 middle =
            grid.centre_mm({bx, by, bz}) + Vec3{1, 1, 1} * ((k_block - 1) * 0.5 * leaf_mm);
        const double outside = shape.outside(middle);
        const double pulp = outside > reach ? 1.0 : shape.pulp(middle),
                     core = outside > reach ? 1.0 : shape.core(middle);
        for (std::int32_t z = bz; z < std::min(bz + k_block, grid.size.z); ++z)
          for (std::int32_t y = by; y < std::min(by + k_block, grid.size.y); ++y)
            for (std::int32_t x = bx; x < std::min(bx + k_block, grid.size.x); ++x) {
              const auto i = grid.index({x, y, z});
              const Vec3 p = grid.centre_mm({x, y, z});
              const double to_outside = std::fabs(outside) > reach ? outside : shape.outside(p);
              field[i] = static_cast<float>(to_outside);
              if (to_outside >= 0) continue;
              const double to_pulp = std::fabs(pulp) > reach ? pulp : shape.pulp(p);
              field[i] = static_cast<float>(std::max(to_outside, -to_pulp));
              if (to_pulp <= 0) {
                grid.tissue[i] = k_pulp;
                continue;
              }
              // The neck is asked first: it is cheap, and most of a tooth lies below it.
              const auto outside_core = [&] {
                return (std::fabs(core) > reach ? core : shape.core(p)) > 0;
              };
              grid.tissue[i] =
                  p.z > shape.neck_mm(p.x, p.y) && outside_core() ? k_enamel : k_dentin;
              field[i] = std::min(field[i], -1e-12f);  // solid, however near the surface
            }
      }
  if constexpr (requires { T::k_join; }) join_tissues(grid, field);
  return finish_formula_tooth(
      grid, field, [&shape](Vec3 p) { return std::max(shape.outside(p), -shape.pulp(p)); },
      periodontium_mm, name, what);
}

}  // namespace cavum
