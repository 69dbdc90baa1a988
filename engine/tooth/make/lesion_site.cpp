#include "engine/tooth/make/lesion_site.h"

#include <fmt/core.h>

#include "engine/base/error.h"
#include "engine/tooth/anatomy/polylines.h"

namespace cavum {
namespace {

/// Where a lesion of that surface begins, and the way inwards.
struct Start {
  Vec3 at_mm, inwards;
};
Start start_of(const Landmarks& l, const std::string& surface) {
  if (surface == "occlusal") {
    if (l.central_pit_mm) return {*l.central_pit_mm, {0, 0, -1}};
    if (!l.central_fissure_mm.empty()) return {l.central_fissure_mm[l.central_fissure_mm.size() / 2], {0, 0, -1}};
    throw Error("--site occlusal", "no pit and no fissure is found on this tooth", "look at `cavum tooth landmarks`, or choose another surface");
  }
  const Vec3 out = surface == "mesial"    ? Vec3{1, 0, 0}
                   : surface == "distal"  ? Vec3{-1, 0, 0}
                   : surface == "buccal"  ? Vec3{0, 1, 0}
                   : surface == "lingual" ? Vec3{0, -1, 0}
                                          : Vec3{};
  if (length(out) == 0) throw Error("--site " + surface, "there is no such surface", "choose occlusal, mesial, distal, buccal or lingual");
  const Vec3* at = furthest_along(l.height_of_contour_mm, out);
  if (at == nullptr) throw Error("--site " + surface, "no height of contour is found on this tooth", "look at `cavum tooth landmarks`");
  return {*at, -out};
}

void require_range(const char* option, double value, double low, double high) {
  if (!(value >= low && value <= high)) throw Error(option, fmt::format("must lie between {} and {} mm", low, high), "choose another length");
}

}  // namespace

LesionShape place_lesion(const Tooth& tooth, const Landmarks& landmarks, const LesionSite& site) {
  require_range("--width-mm", site.width_mm, 0.5, 6);
  require_range("--depth-mm", site.depth_mm, 0.2, 4);
  const Start start = start_of(landmarks, site.surface);
  const std::uint8_t dentin = tooth.tissue_id("dentin");
  constexpr double k_furthest_mm = 6.0;
  const double step_mm = 0.5 * tooth.octree.leaf_mm();
  Vec3 border = start.at_mm;
  double way_mm = 0;
  for (; way_mm < k_furthest_mm && tooth.octree.tissue_at(border) != dentin; way_mm += step_mm) border += start.inwards * step_mm;
  if (way_mm >= k_furthest_mm)
    throw Error("--site " + site.surface, fmt::format("no dentin lies within {} mm under that surface", k_furthest_mm), "choose another surface");
  const double half = 0.5 * site.width_mm;
  const Vec3 deep{start.inwards.x * start.inwards.x, start.inwards.y * start.inwards.y, start.inwards.z * start.inwards.z};
  return {border, deep * site.depth_mm + (Vec3{1, 1, 1} - deep) * half};
}

}  // namespace cavum
