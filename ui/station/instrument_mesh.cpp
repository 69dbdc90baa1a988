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
  bool grain = false;  // diamond: each vertex a little lighter or darker, in bands that wind round
};

constexpr int k_sides = 36, k_bands = 6;
constexpr float k_two_pi = 2.0F * std::numbers::pi_v<float>;
constexpr std::array<std::uint8_t, 4> k_diamond{172, 172, 176, 60}, k_steel{196, 202, 208, 255},
    k_metal{205, 210, 216, 255}, k_dark{96, 104, 114, 200};

/// Small number in place of a random one, the same every time.
int grain_of(unsigned i) {
  i = (i ^ 61U) ^ (i >> 16U);
  i *= 9U;
  i ^= i >> 4U;
  i *= 0x27d4eb2dU;
  return static_cast<int>((i >> 15U) % 40U) - 20;
}

GpuVertex corner_of(const Ring& ring, int side, unsigned number, const glm::mat4& place) {
  const float a = k_two_pi * static_cast<float>(side) / k_sides;
  auto colour = ring.colour;
  float lean = 0.0F;  // of the normal, towards the next side
  if (ring.grain) {
    constexpr float k_pitch_per_mm = 1.1F, k_lean = 0.45F, k_contrast = 34.0F;
    const float phase = k_bands * a + k_pitch_per_mm * k_two_pi * ring.z;
    lean = k_lean * std::cos(phase);
    const int lighter = grain_of(number) + static_cast<int>(k_contrast * std::sin(phase));
    for (std::size_t c = 0; c < 3; ++c)
      colour[c] = static_cast<std::uint8_t>(glm::clamp(colour[c] + lighter, 0, 255));
  }
  const glm::vec3 out(std::cos(a), std::sin(a), 0), on(-std::sin(a), std::cos(a), 0);
  const glm::vec3 n = glm::normalize(ring.normal_r * out + lean * std::fabs(ring.normal_r) * on +
                                     glm::vec3(0, 0, ring.normal_z + 1e-6F));
  return gpu_vertex(glm::vec3(place * glm::vec4(ring.r * out + glm::vec3(0, 0, ring.z), 1.0F)),
                    glm::vec3(place * glm::vec4(n, 0.0F)), colour);
}

/// A body of revolution; rings of radius 0 close it.
void revolve(const std::vector<Ring>& rings, const glm::mat4& place, MeshData& mesh) {
  const auto first = static_cast<std::uint32_t>(mesh.vertices.size());
  for (const Ring& ring : rings)
    for (int s = 0; s < k_sides; ++s)
      mesh.vertices.push_back(
          corner_of(ring, s, static_cast<unsigned>(mesh.vertices.size()), place));
  for (std::uint32_t r = 0; r + 1 < rings.size(); ++r)
    for (std::uint32_t s = 0; s < k_sides; ++s) {
      const std::uint32_t t = (s + 1) % k_sides, low = first + r * k_sides, high = low + k_sides;
      for (const std::uint32_t i : {low + s, low + t, high + t, low + s, high + t, high + s})
        mesh.indices.push_back(i);
    }
}

/// Closes it across, facing down or up.
void close(std::vector<Ring>& rings, bool below) {
  Ring edge = below ? rings.front() : rings.back(), middle = edge;
  edge.normal_r = middle.normal_r = 0;
  edge.normal_z = middle.normal_z = below ? -1.0F : 1.0F;
  middle.r = 0;
  if (below)
    rings.insert(rings.begin(), {middle, edge});
  else
    rings.insert(rings.end(), {edge, middle});
}

/// So high is what stays while the rest fades from who looks along the instrument: the head with a
/// little neck, of a long one its lower end.
float working_end_mm(const Bur& bur) {
  constexpr float k_neck_mm = 0.7F, k_max_mm = 2.2F;
  return std::min(static_cast<float>(bur.cutting_length_mm) + k_neck_mm, k_max_mm);
}
constexpr double k_fine_mm = 0.12, k_coarse_mm = 0.5;  // from ring to ring, of head and shank

/// The profile from one height to another.
std::vector<Ring> rings_of(const Bur& bur, float from_mm, float to_mm, double step_mm) {
  std::vector<Ring> rings;
  for (const auto& p : bur.profile.walk(step_mm, bur.profile.length_mm())) {
    const auto z = static_cast<float>(p.at.z_mm);
    if (z < from_mm || z > to_mm) continue;
    const bool coated = p.at.z_mm <= bur.cutting_length_mm;
    rings.push_back({static_cast<float>(p.at.r_mm), z, static_cast<float>(p.normal.r_mm),
                     static_cast<float>(p.normal.z_mm), coated ? k_diamond : k_steel, coated});
  }
  return rings;
}

}  // namespace

MeshData diamond_head_mesh(const Bur& bur) {
  // a ring farther than where the shank begins: no gap between the two
  std::vector<Ring> rings =
      rings_of(bur, -1.0F, working_end_mm(bur) + static_cast<float>(k_fine_mm), k_fine_mm);
  MeshData mesh;
  if (rings.empty()) return mesh;
  close(rings, true);
  close(rings, false);
  revolve(rings, glm::mat4(1.0F), mesh);
  return mesh;
}

MeshData shank_mesh(const Bur& bur) {
  constexpr float k_shank_ends_mm = 13.0F;
  // the coated part finely, so that its bands wind round; the rest as its profile needs
  const auto coated_to = static_cast<float>(bur.cutting_length_mm), from_mm = working_end_mm(bur);
  std::vector<Ring> rings = rings_of(bur, from_mm, coated_to, k_fine_mm);
  for (const Ring& ring : rings_of(bur, std::max(from_mm, coated_to), k_shank_ends_mm, k_coarse_mm))
    rings.push_back(ring);
  Ring end =
      rings.empty() ? rings_of(bur, -1.0F, k_shank_ends_mm, k_coarse_mm).back() : rings.back();
  end.normal_r = 1;
  end.normal_z = 0;
  end.grain = false;
  end.colour = k_steel;
  for (const float z : {std::max(end.z, from_mm), k_shank_ends_mm}) {
    end.z = z;
    rings.push_back(end);
  }
  close(rings, true);
  close(rings, false);
  MeshData mesh;
  revolve(rings, glm::mat4(1.0F), mesh);
  return mesh;
}

MeshData handpiece_mesh() {
  MeshData mesh;
  // the head around the turbine: flat below, rounded above
  std::vector<Ring> head;
  const auto edge = [&head](float r, float z, float nr, float nz,
                            const std::array<std::uint8_t, 4>& colour) {
    head.push_back({r, z, nr, nz, colour, false});
  };
  edge(0.0F, 11.0F, 0, -1, k_dark);
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
  std::vector<Ring> neck{{2.6F, 0.0F, 1, 0, k_metal, false},
                         {2.9F, 14.0F, 1, 0, k_metal, false},
                         {3.6F, 26.0F, 1, -0.1F, k_metal, false},
                         {4.4F, 40.0F, 1, 0, k_metal, false}};
  close(neck, true);
  close(neck, false);
  revolve(neck, lean, mesh);
  return mesh;
}

}  // namespace cavum::station
