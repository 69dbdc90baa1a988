#include "ui/station/instrument_mesh.h"

#include <cmath>
#include <glm/gtc/matrix_transform.hpp>
#include <numbers>

namespace cavum::station {
namespace {

struct Ring {
  float r = 0, z = 0;  // mm
  float normal_r = 1, normal_z = 0;
  std::array<std::uint8_t, 4> colour{};
  bool grain = false;  // diamond: each vertex a little lighter or darker
};

constexpr int k_sides = 40;

/// Small number in place of a random one, the same every time.
int grain_of(unsigned i) {
  i = (i ^ 61U) ^ (i >> 16U);
  i *= 9U;
  i ^= i >> 4U;
  i *= 0x27d4eb2dU;
  return static_cast<int>((i >> 15U) % 46U) - 23;
}

void revolve(const std::vector<Ring>& rings, const glm::mat4& place, MeshData& mesh) {
  const auto first = static_cast<std::uint32_t>(mesh.vertices.size());
  for (const Ring& ring : rings)
    for (int s = 0; s < k_sides; ++s) {
      const float a = 2.0F * std::numbers::pi_v<float> * static_cast<float>(s) / k_sides;
      auto colour = ring.colour;
      if (ring.grain)
        for (std::size_t c = 0; c < 3; ++c)
          colour[c] = static_cast<std::uint8_t>(glm::clamp(colour[c] + grain_of(static_cast<unsigned>(mesh.vertices.size())), 0, 255));
      const glm::vec4 at = place * glm::vec4(ring.r * std::cos(a), ring.r * std::sin(a), ring.z, 1.0F);
      const glm::vec4 n = place * glm::vec4(ring.normal_r * std::cos(a), ring.normal_r * std::sin(a), ring.normal_z, 0.0F);
      mesh.vertices.push_back(gpu_vertex(glm::vec3(at), glm::vec3(n), colour));
    }
  for (std::uint32_t r = 0; r + 1 < rings.size(); ++r)
    for (std::uint32_t s = 0; s < k_sides; ++s) {
      const std::uint32_t t = (s + 1) % k_sides, low = first + r * k_sides, high = low + k_sides;
      for (const std::uint32_t i : {low + s, low + t, high + t, low + s, high + t, high + s}) mesh.indices.push_back(i);
    }
}

}  // namespace

MeshData diamond_point_mesh(const DiamondPoint& point) {
  constexpr std::array<std::uint8_t, 4> k_diamond{150, 152, 156, 255}, k_steel{196, 202, 208, 255};
  constexpr float k_shank_ends_mm = 13.0F;
  std::vector<Ring> rings;
  for (const auto& p : point.profile.walk(0.06, point.profile.length_mm())) {
    const bool coated = p.at.z_mm <= point.cutting_length_mm;
    rings.push_back({static_cast<float>(p.at.r_mm), static_cast<float>(p.at.z_mm), static_cast<float>(p.normal.r_mm),
                     static_cast<float>(p.normal.z_mm), coated ? k_diamond : k_steel, coated});
  }
  if (!rings.empty() && rings.back().z < k_shank_ends_mm) {
    Ring end = rings.back();
    end.normal_r = 1;
    end.normal_z = 0;
    rings.push_back(end);
    end.z = k_shank_ends_mm;
    rings.push_back(end);
  }
  MeshData mesh;
  revolve(rings, glm::mat4(1.0F), mesh);
  return mesh;
}

MeshData handpiece_mesh() {
  constexpr std::array<std::uint8_t, 4> k_metal{205, 210, 216, 255}, k_dark{96, 104, 114, 255};
  MeshData mesh;
  // the head around the turbine: flat below, rounded above
  std::vector<Ring> head;
  const auto edge = [&head](float r, float z, float nr, float nz, const std::array<std::uint8_t, 4>& colour) {
    head.push_back({r, z, nr, nz, colour, false});
  };
  edge(0.8F, 11.0F, 0, -1, k_dark);
  edge(3.6F, 11.0F, 0, -1, k_dark);
  edge(3.9F, 11.2F, 0.7F, -0.7F, k_metal);
  edge(4.5F, 12.4F, 1, 0, k_metal);
  edge(4.5F, 20.0F, 1, 0, k_metal);
  for (int i = 1; i <= 8; ++i) {
    const float a = static_cast<float>(i) / 8.0F * 0.5F * std::numbers::pi_v<float>;
    edge(3.3F + 1.2F * std::cos(a), 20.0F + 1.2F * std::sin(a), std::cos(a), std::sin(a), k_metal);
  }
  edge(0.0F, 21.2F, 0, 1, k_dark);
  revolve(head, glm::mat4(1.0F), mesh);
  // the neck, leaning back
  glm::mat4 lean = glm::translate(glm::mat4(1.0F), glm::vec3(0, -2.0F, 16.5F));
  lean = glm::rotate(lean, glm::radians(68.0F), glm::vec3(1, 0, 0));
  revolve({{3.2F, 0.0F, 1, 0, k_metal, false},
           {2.9F, 14.0F, 1, 0, k_metal, false},
           {3.6F, 26.0F, 1, -0.1F, k_metal, false},
           {4.4F, 40.0F, 1, 0, k_metal, false}},
          lean, mesh);
  return mesh;
}

}  // namespace cavum::station
