#include "engine/tooth/make/plant_lesion.h"

#include <algorithm>

#include "engine/base/error.h"
#include "engine/base/text.h"

namespace cavum {

Tooth plant_lesion(Tooth tooth, const LesionShape& lesion) {
  const std::string where = "--lesion";
  const Vec3 r = lesion.radii_mm, c = lesion.centre_mm;
  if (!(r.x > 0 && r.y > 0 && r.z > 0))
    throw Error(where, msg("a radius is not larger than 0 mm"),
                msg("give centre and radii: x,y,z,rx,ry,rz"));
  std::uint8_t id = 0;
  for (const auto& t : tooth.tissues) {
    if (t.name == "lesion")
      throw Error(where, msg("the tooth has a lesion already"),
                  msg("grow it into the tooth as it was before"));
    id = std::max(id, t.id);
  }
  if (id == 255) throw Error(where, msg("the tooth has 255 tissues"), msg("use fewer"));
  ++id;
  TissueGrid grid = tooth.octree.to_grid();
  std::size_t turned = 0;
  for (int z = 0; z < grid.size.z; ++z)
    for (int y = 0; y < grid.size.y; ++y)
      for (int x = 0; x < grid.size.x; ++x) {
        const Vec3 d = grid.centre_mm({x, y, z}) - c;
        const Vec3 u{d.x / r.x, d.y / r.y, d.z / r.z};
        auto& tissue = grid.tissue[grid.index({x, y, z})];
        if (tissue != k_dentin || dot(u, u) >= 1.0) continue;
        tissue = id;
        ++turned;
        for (const IVec3 step : {IVec3{1, 0, 0}, IVec3{-1, 0, 0}, IVec3{0, 1, 0}, IVec3{0, -1, 0},
                                 IVec3{0, 0, 1}, IVec3{0, 0, -1}}) {
          const IVec3 n = IVec3{x, y, z} + step;
          const std::uint8_t beside =
              grid.inside(n) ? grid.tissue[grid.index(n)] : std::uint8_t{k_air};
          if (beside != id && !tooth.octree.is_solid(beside))
            throw Error(where, msg("the lesion would open into {}", tooth.tissue_name(beside)),
                        msg("move it deeper into the dentin, or make it smaller"));
        }
      }
  if (turned == 0)
    throw Error(where, msg("no dentin lies there"),
                msg("move it, in the tooth frame: see `cavum tooth info` for the bounds"));
  tooth.tissues.push_back({id, "lesion", true});
  tooth.octree = Octree(grid, tooth.tissues);
  tooth.name += ", hidden lesion";
  tooth.source.push_back(LesionPlanted{.centre_mm = c, .radii_mm = r, .surface = {}});
  return tooth;
}

}  // namespace cavum
