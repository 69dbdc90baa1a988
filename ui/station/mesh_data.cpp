#include "ui/station/mesh_data.h"

#include <algorithm>

namespace cavum::station {

MeshData smooth_shaded(const TriangleMesh& mesh, const std::array<std::uint8_t, 4>& colour) {
  const auto vec = [](Vec3 v) { return glm::vec3(v.x, v.y, v.z); };
  std::vector<glm::vec3> normals(mesh.vertices_mm.size(), glm::vec3(0));
  MeshData data;
  for (const auto& t : mesh.triangles) {
    const glm::vec3 a = vec(mesh.vertices_mm[t[0]]),
                    n = glm::cross(vec(mesh.vertices_mm[t[1]]) - a,
                                   vec(mesh.vertices_mm[t[2]]) - a);
    for (const std::uint32_t i : t) {
      normals[i] += n;
      data.indices.push_back(i);
    }
  }
  for (std::size_t i = 0; i < normals.size(); ++i)
    data.vertices.push_back(gpu_vertex(
        vec(mesh.vertices_mm[i]), normals[i] / std::max(1e-9F, glm::length(normals[i])), colour));
  return data;
}

}  // namespace cavum::station
