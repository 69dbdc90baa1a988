#include "engine/tooth/make/lesion_site.h"

#include <fmt/core.h>

#include <optional>

#include "engine/base/error.h"
#include "engine/tooth/anatomy/polylines.h"

namespace cavum {
namespace {

constexpr double k_furthest_mm = 6.0;  // from the surface to the dentin under it

/// A place on the border of enamel and dentin, and the way into the dentin.
struct Border {
  Vec3 at_mm, inwards;
};

/// Under the fissure.
Border occlusal_border(const Tooth& tooth, const Landmarks& l) {
  if (!l.central_pit_mm && l.central_fissure_mm.empty())
    throw Error("--site occlusal", msg("no pit and no fissure is found on this tooth"),
                msg("look at `cavum tooth landmarks`, or choose another surface"));
  Vec3 at =
      l.central_pit_mm ? *l.central_pit_mm : l.central_fissure_mm[l.central_fissure_mm.size() / 2];
  const std::uint8_t dentin = tooth.tissue_id("dentin");
  const Vec3 step = Vec3{0, 0, -0.5} * tooth.octree.leaf_mm();
  for (double moved_mm = 0; moved_mm < k_furthest_mm; moved_mm += length(step), at += step)
    if (tooth.octree.tissue_at(at) == dentin) return {at, {0, 0, -1}};
  throw Error("--site occlusal",
              msg("no dentin lies within {} mm under the fissure", k_furthest_mm),
              msg("choose another surface"));
}

/// Where a way inwards from the outside first meets dentin, through enamel alone; none where it
/// does not.
std::optional<Vec3> through_enamel(const Tooth& tooth, Vec3 from, Vec3 inwards, std::uint8_t enamel,
                                   std::uint8_t dentin) {
  const Vec3 step = inwards * (0.5 * tooth.octree.leaf_mm());
  bool inside = false;
  for (double moved_mm = 0; moved_mm < k_furthest_mm; moved_mm += length(step), from += step) {
    const std::uint8_t t = tooth.octree.tissue_at(from);
    if (inside && t == dentin) return from;
    if (inside && t != enamel) return std::nullopt;
    inside = inside || t == enamel;
  }
  return std::nullopt;
}

/// Under the height of contour. That of a mesial or distal side, the contact, may stand higher than
/// the dentin, which ends under the marginal ridge: caries begins just below the contact, so it is
/// looked for downwards until there is dentin behind the enamel, with a side that stands upright.
Border side_border(const Tooth& tooth, const Landmarks& l, const std::string& surface) {
  const Vec3 out = surface == "mesial"    ? Vec3{1, 0, 0}
                   : surface == "distal"  ? Vec3{-1, 0, 0}
                   : surface == "buccal"  ? Vec3{0, 1, 0}
                   : surface == "lingual" ? Vec3{0, -1, 0}
                                          : Vec3{};
  if (length(out) == 0)
    throw Error("--site " + surface, msg("there is no such surface"),
                msg("choose occlusal, mesial, distal, buccal or lingual"));
  const Vec3* contour = furthest_along(l.height_of_contour_mm, out);
  if (contour == nullptr)
    throw Error("--site " + surface, msg("no height of contour is found on this tooth"),
                msg("look at `cavum tooth landmarks`"));
  constexpr double k_outside_mm = 1.0, k_deepest_mm = 4.0, k_upright_mm = 0.3;
  const std::uint8_t enamel = tooth.tissue_id("enamel"), dentin = tooth.tissue_id("dentin");
  const Vec3 from = *contour + out * k_outside_mm, above{0, 0, k_upright_mm};
  for (double down_mm = 0; down_mm < k_deepest_mm; down_mm += 0.5 * tooth.octree.leaf_mm()) {
    const auto border = through_enamel(tooth, from - Vec3{0, 0, down_mm}, -out, enamel, dentin);
    if (!border) continue;
    const auto higher =
        through_enamel(tooth, from - Vec3{0, 0, down_mm} + above, -out, enamel, dentin);
    if (higher && dot(*border - *higher, out) <= k_upright_mm) return {*border, -out};
  }
  throw Error(
      "--site " + surface,
      msg("no dentin is met through enamel alone from the height of contour down to {} mm below it",
          k_deepest_mm),
      msg("look at `cavum tooth landmarks`, or choose another surface"));
}

void require_range(const char* option, double value, double low, double high) {
  if (!(value >= low && value <= high))
    throw Error(option, msg("must lie between {} and {} mm", low, high),
                msg("choose another length"));
}

}  // namespace

LesionShape place_lesion(const Tooth& tooth, const Landmarks& landmarks, const LesionSite& site) {
  require_range("--width-mm", site.width_mm, 0.5, 6);
  require_range("--depth-mm", site.depth_mm, 0.2, 4);
  const auto [at_mm, inwards] = site.surface == "occlusal"
                                    ? occlusal_border(tooth, landmarks)
                                    : side_border(tooth, landmarks, site.surface);
  const double half = 0.5 * site.width_mm;
  const Vec3 deep{inwards.x * inwards.x, inwards.y * inwards.y, inwards.z * inwards.z};
  return {at_mm, deep * site.depth_mm + (Vec3{1, 1, 1} - deep) * half};
}

}  // namespace cavum
