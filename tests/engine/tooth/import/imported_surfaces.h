// What tests of imports share: the surfaces of our makers, which a test may turn, scale and
// roughen, and how they are imported upright.
#pragma once

#include "engine/tooth/import/import_meshes.h"
#include "tests/engine/tooth/import/import_testing.h"

namespace cavum::testing_import {

/// The three surfaces of a tooth, which a test may turn, scale and roughen.
struct Surfaces {
  TriangleMesh enamel, dentin, pulp;
  explicit Surfaces(const Tooth& tooth)
      : enamel(surface_mesh(tooth, "enamel")),
        dentin(surface_mesh(tooth, "dentin")),
        pulp(surface_mesh(tooth, "pulp")) {}
  template <class Change>
  Surfaces changed(const Change& change) const {
    Surfaces out = *this;
    for (auto* m : {&out.enamel, &out.dentin, &out.pulp})
      for (auto& v : m->vertices_mm) v = change(v);
    return out;
  }
  [[nodiscard]] MeshPaths write(const fs::path& folder) const {
    MeshPaths paths{(folder / "enamel.stl").string(), (folder / "dentin.stl").string(),
                    (folder / "pulp.stl").string()};
    write_mesh_file(enamel, paths.enamel);
    write_mesh_file(dentin, paths.dentin);
    write_mesh_file(pulp, paths.pulp);
    return paths;
  }
};

/// A maker's shape without periodontium.
template <class Shape>
Shape shape_of(double leaf_mm) {
  Shape shape;
  shape.leaf_mm = leaf_mm;
  shape.periodontium_mm = 0;
  return shape;
}

inline MeshImportOptions upright(double leaf_mm) {
  MeshImportOptions o;
  o.leaf_mm = leaf_mm;
  o.periodontium_mm = 0;
  o.frame.occlusal_axis = Vec3{0, 0, 1};
  o.frame.mesial_axis = Vec3{1, 0, 0};
  return o;
}

}  // namespace cavum::testing_import
