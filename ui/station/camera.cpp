#include "ui/station/camera.h"

#include <glm/gtc/matrix_transform.hpp>

namespace cavum::station {
namespace {

constexpr float k_field_deg = 26.0F;

}  // namespace

void Camera::orbit(float turn, float rise) {
  turn_deg += mirror ? -turn : turn;
  rise_deg = glm::clamp(rise_deg + rise, -60.0F, 90.0F);
}

void Camera::approach(float factor) {
  distance_mm = glm::clamp(distance_mm * factor, 8.0F, 120.0F);
}
void Camera::look_from_occlusal() { look_from(0.0F, 90.0F); }
void Camera::look_from(float turn, float rise) {
  turn_deg = turn;
  rise_deg = rise;
  roll_deg = 0.0F;
}

glm::mat4 Camera::view(int eye) const {
  // seen from buccal (+y): mesial (+x) lies to the left
  glm::mat4 m(1.0F);
  if (mirror) m = glm::scale(m, glm::vec3(-1, 1, 1));
  m = glm::rotate(m, glm::radians(roll_deg), glm::vec3(0, 0, 1));
  m = glm::translate(m, glm::vec3(0, 0, -distance_mm));
  // the eyes stand on a circle round what they look at
  m = glm::rotate(m, -static_cast<float>(eye) * std::atan2(0.5F * eyes_apart_mm, distance_mm),
                  glm::vec3(0, 1, 0));
  m = glm::rotate(m, glm::radians(rise_deg - 90.0F), glm::vec3(1, 0, 0));
  m = glm::rotate(m, glm::radians(turn_deg + 180.0F), glm::vec3(0, 0, 1));
  return glm::translate(m, -target_mm);
}

glm::mat4 Camera::projection(float width_over_height) const {
  return glm::perspective(glm::radians(k_field_deg), width_over_height, 1.0F, 250.0F);
}

glm::vec3 Camera::position_mm(int eye) const {
  return glm::vec3(glm::inverse(view(eye)) * glm::vec4(0, 0, 0, 1));
}

Vec3 Camera::right() const {
  const glm::mat4 m = view();
  return {m[0][0], m[1][0], m[2][0]};
}

Vec3 Camera::up() const {
  const glm::mat4 m = view();
  return {m[0][1], m[1][1], m[2][1]};
}

}  // namespace cavum::station
