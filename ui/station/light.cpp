#include "ui/station/light.h"

#include <algorithm>
#include <cmath>
#include <glm/gtc/matrix_transform.hpp>
#include <numbers>
#include <vector>

namespace cavum::station {
namespace {

constexpr float k_pi_f = std::numbers::pi_v<float>;

/// Light from a direction.
glm::vec3 room_light(const glm::vec3& w) {
  const float up = w.z;
  const glm::vec3 sky(0.34F, 0.38F, 0.44F), wall(0.21F, 0.22F, 0.24F),
      below(0.13F, 0.10F, 0.09F);  // the mouth is warm
  glm::vec3 light = up > 0 ? glm::mix(wall, sky, glm::smoothstep(0.0F, 0.8F, up))
                           : glm::mix(wall, below, glm::smoothstep(0.0F, 0.5F, -up));
  // a long lamp under the ceiling and a window to the left behind the eye
  const auto patch = [&w](const glm::vec3& middle, float wide) {
    return std::exp((glm::dot(w, glm::normalize(middle)) - 1.0F) / wide);
  };
  light += glm::vec3(2.2F, 2.2F, 2.1F) * patch({-0.2F, -0.5F, 0.9F}, 0.03F);
  light += glm::vec3(1.1F, 1.25F, 1.45F) * patch({0.9F, 0.6F, 0.5F}, 0.05F);
  return light;
}

/// A direction of the octahedron's square, 0..1 both ways.
glm::vec3 from_octahedron(float u, float v) {
  const float x = 2.0F * u - 1.0F, y = 2.0F * v - 1.0F;
  glm::vec3 w(x, y, 1.0F - std::fabs(x) - std::fabs(y));
  if (w.z < 0) {
    const float fx = (1.0F - std::fabs(y)) * (x < 0 ? -1.0F : 1.0F),
                fy = (1.0F - std::fabs(x)) * (y < 0 ? -1.0F : 1.0F);
    w.x = fx;
    w.y = fy;
  }
  return glm::normalize(w);
}

/// Evenly over the sphere.
std::vector<glm::vec3> directions(int count) {
  std::vector<glm::vec3> all;
  const float golden = k_pi_f * (3.0F - std::sqrt(5.0F));
  for (int i = 0; i < count; ++i) {
    const float z = 1.0F - (2.0F * static_cast<float>(i) + 1.0F) / static_cast<float>(count),
                r = std::sqrt(1.0F - z * z), a = golden * static_cast<float>(i);
    all.emplace_back(r * std::cos(a), r * std::sin(a), z);
  }
  return all;
}

}  // namespace

Room::Room() {
  // Light that falls on a surface: L_lm of the room, times the cosine's own factors (1, 2/3, 1/4)
  // by order.
  constexpr int k_samples = 2048;
  const std::vector<glm::vec3> all = directions(k_samples);
  const auto basis = [](const glm::vec3& w) {
    return std::array<float, 9>{0.282095F,
                                0.488603F * w.y,
                                0.488603F * w.z,
                                0.488603F * w.x,
                                1.092548F * w.x * w.y,
                                1.092548F * w.y * w.z,
                                0.315392F * (3 * w.z * w.z - 1),
                                1.092548F * w.x * w.z,
                                0.546274F * (w.x * w.x - w.y * w.y)};
  };
  std::vector<glm::vec3> light;
  for (const glm::vec3& w : all) {
    light.push_back(room_light(w));
    const auto b = basis(w);
    for (std::size_t i = 0; i < 9; ++i)
      falling_[i] += light.back() * b[i] * (4.0F * k_pi_f / k_samples);
  }
  constexpr std::array<float, 9> k_constant{0.282095F, 0.488603F, 0.488603F, 0.488603F, 1.092548F,
                                            1.092548F, 0.315392F, 1.092548F, 0.546274F};
  for (std::size_t i = 0; i < 9; ++i)
    falling_[i] *= k_constant[i] * (i == 0 ? 1.0F : i < 4 ? 2.0F / 3.0F : 0.25F);

  // What a surface of some roughness mirrors: the room, weighted by a lobe around the direction.
  constexpr std::array<float, k_roughnesses> k_sharp{400.0F, 40.0F, 8.0F};
  std::vector<float> table;
  for (int y = 0; y < k_edge; ++y)
    for (int level = 0; level < k_roughnesses; ++level)
      for (int x = 0; x < k_edge; ++x) {
        const glm::vec3 w = from_octahedron((static_cast<float>(x) + 0.5F) / k_edge,
                                            (static_cast<float>(y) + 0.5F) / k_edge);
        glm::vec3 sum = room_light(w) * 1e-3F;
        float weight = 1e-3F;
        if (level == 0) {  // nearly a mirror
          sum = room_light(w);
          weight = 1.0F;
        } else {
          for (std::size_t i = 0; i < all.size(); ++i) {
            const float f =
                std::exp(k_sharp[static_cast<std::size_t>(level)] * (glm::dot(all[i], w) - 1.0F));
            sum += light[i] * f;
            weight += f;
          }
        }
        sum /= weight;
        for (const float c : {sum.x, sum.y, sum.z}) table.push_back(c);
      }
  mirrored_.put(k_edge * k_roughnesses, k_edge, 3, table);
}

Lamp lamp_of(const Camera& camera, int shadow_edge) {
  const float turn = glm::radians(camera.turn_deg);
  const glm::vec3 up(0, 0, 1), to_eye(-std::sin(turn), std::cos(turn), 0),
      left = glm::cross(to_eye, up);
  Lamp lamp;
  constexpr float k_lean = 0.58F;  // tangent of how far it leans
  // from behind the tooth: shadows fall towards the eye, where the instrument does not hide them
  lamp.towards = glm::normalize(up + k_lean * (0.84F * left - 0.54F * to_eye));
  constexpr float k_far_mm = 30.0F, k_above_mm = 24.0F,
                  k_below_mm = 8.0F;  // what lies lower is in the shadow of what lies above, or lit
  const glm::mat4 look =
      glm::lookAt(camera.target_mm + k_far_mm * lamp.towards, camera.target_mm, to_eye);
  lamp.to_lamp = glm::ortho(-k_lamp_reach_mm, k_lamp_reach_mm, -k_lamp_reach_mm, k_lamp_reach_mm,
                            k_far_mm - k_above_mm, k_far_mm + k_below_mm) *
                 look;
  lamp.to_room = glm::transpose(glm::mat3(left, to_eye, up));
  lamp.texel_mm = 2.0F * k_lamp_reach_mm / static_cast<float>(shadow_edge);
  return lamp;
}

}  // namespace cavum::station
