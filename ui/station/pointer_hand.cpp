#include "ui/station/pointer_hand.h"

#define GLFW_INCLUDE_NONE
#include <GLFW/glfw3.h>

#include <algorithm>
#include <cmath>
#include <optional>

namespace cavum::station {
namespace {

constexpr double k_degree = 3.14159265358979323846 / 180.0;

/// The handle leans by so many radians to the right and up, as far as it may.
void tilt(const PointerView& view, double right, double up, Quat& rotation) {
  const Vec3 handle = cavum::rotation(rotation) * Vec3{0, 0, 1};
  Vec3 wanted = normalized(handle + view.right * right + view.up * up);
  const double most = std::cos(k_pointer_tilt_deg * k_degree), along = dot(wanted, view.out);
  if (along < most) {
    const Vec3 aside = wanted - view.out * along;
    wanted = view.out * most + aside * (std::sqrt(1.0 - most * most) / length(aside));
  }
  rotation = rotation_between({0, 0, 1}, wanted);
}

constexpr double k_clear_mm = 1.0;  // around the tip, for the head and its shank
constexpr int k_bearings = 12;

/// No tissue above a place up to `rise`, nor so far around that.
bool free_above(const ReturnPath& way, Vec3 at, double rise, double around_mm) {
  constexpr double k_look_mm = 0.4;
  const Quat turn = rotation_between({0, 0, 1}, way.out);
  for (double up = k_look_mm; up < rise; up += k_look_mm)
    for (int i = 0; i <= k_bearings / 2; ++i) {
      const double a = 4.0 * 3.14159265358979323846 * i / k_bearings,
                   r = i == k_bearings / 2 ? 0.0 : around_mm;
      if (way.in_tissue(at + way.out * up +
                        rotation(turn) * Vec3{r * std::cos(a), r * std::sin(a), 0}))
        return false;
    }
  return true;
}

/// The shortest way across to where nothing is above; none where that is here, or walls stand all
/// around.
std::optional<Vec3> detour(const ReturnPath& way, Vec3 tip_mm, double rise) {
  if (free_above(way, tip_mm, rise, 0.0)) return std::nullopt;
  constexpr double k_beside_mm = 0.4, k_step_mm = 0.4,
                   k_farthest_mm = 12.0;  // the tip itself may touch
  const Quat turn = rotation_between({0, 0, 1}, way.out);
  double nearest = k_farthest_mm;
  std::optional<Vec3> aside;
  for (int i = 0; i < k_bearings; ++i) {
    const double a = 2.0 * 3.14159265358979323846 * i / k_bearings;
    const Vec3 d = rotation(turn) * Vec3{std::cos(a), std::sin(a), 0};
    for (double far = k_beside_mm; far < nearest && !way.in_tissue(tip_mm + d * far);
         far += k_step_mm)
      if (free_above(way, tip_mm + d * far, rise, k_clear_mm)) {
        nearest = far;
        aside = d;
      }
  }
  return aside;
}

}  // namespace

void move_by_pointer(const InputQueue& input, const PointerView& view, Vec3& tip_mm,
                     Quat& rotation) {
  double x = 0, y = 0, deeper = 0, lean_x = 0, lean_y = 0;
  constexpr double k_lean_px = 0.25 * k_degree;
  for (const InputEvent& e : input.played()) {
    const double share = e.shift ? k_pointer_fine : 1.0;
    if (e.kind == InputEvent::Kind::key && e.code == GLFW_KEY_0 && e.down && !e.ctrl)
      rotation = rotation_between({0, 0, 1}, view.out);
    if (!view.mouse || input.button_down(GLFW_MOUSE_BUTTON_RIGHT))
      continue;  // which turns the view
    if (e.kind == InputEvent::Kind::wheel && !e.ctrl)
      deeper -= share * k_pointer_notch_mm * static_cast<double>(e.y);
    if (e.kind != InputEvent::Kind::motion) continue;
    (e.ctrl ? lean_x : x) +=
        share * static_cast<double>(e.x) * (e.ctrl ? k_lean_px : view.mm_per_px);
    (e.ctrl ? lean_y : y) -=
        share * static_cast<double>(e.y) * (e.ctrl ? k_lean_px : view.mm_per_px);
  }
  const bool leans = input.down(GLFW_KEY_LEFT_CONTROL) || input.down(GLFW_KEY_RIGHT_CONTROL);
  const bool fine = input.down(GLFW_KEY_LEFT_SHIFT) || input.down(GLFW_KEY_RIGHT_SHIFT);
  const double share = fine ? k_pointer_fine : 1.0;
  const HeldKeyLaw way{share * k_pointer_step_mm, share * k_pointer_mm_s},
      lean{share * k_degree, share * 40.0 * k_degree};
  const auto between = [&input](const HeldKeyLaw& law, int more, int less) {
    return law.travel(input.hold(more)) - law.travel(input.hold(less));
  };
  (leans ? lean_x : x) += between(leans ? lean : way, GLFW_KEY_RIGHT, GLFW_KEY_LEFT);
  (leans ? lean_y : y) += between(leans ? lean : way, GLFW_KEY_UP, GLFW_KEY_DOWN);
  deeper += between(way, GLFW_KEY_PAGE_DOWN, GLFW_KEY_PAGE_UP);
  tip_mm += view.right * x + view.up * y - view.out * deeper;
  if (lean_x != 0 || lean_y != 0) tilt(view, lean_x, lean_y, rotation);
}

void keep_in_reach(const PointerView& view, Vec3 tip_mm, Vec3& wanted_mm) {
  const double deeper_mm = dot(tip_mm - wanted_mm, view.out);
  if (deeper_mm > k_pointer_reach_mm) wanted_mm += view.out * (deeper_mm - k_pointer_reach_mm);
}

Vec3 near_tooth(Vec3 low, Vec3 high, Vec3 start, Vec3 wanted_mm) {
  const auto within = [](double least, double most, double begin, double v) {
    return std::clamp(v, std::min(least - k_pointer_room_mm, begin),
                      std::max(most + k_pointer_room_mm, begin));
  };
  return {within(low.x, high.x, start.x, wanted_mm.x), within(low.y, high.y, start.y, wanted_mm.y),
          within(low.z, high.z, start.z, wanted_mm.z)};
}

Vec3 next_on_return_path(const ReturnPath& way, Vec3 tip_mm, double step_mm) {
  const double rise = dot(way.goal - tip_mm, way.out);
  constexpr double k_level_mm = 1e-3;
  if (rise > k_level_mm) {
    if (const auto aside = detour(way, tip_mm, rise)) return tip_mm + *aside * step_mm;
    return tip_mm + way.out * std::min(step_mm, rise);
  }
  const Vec3 left = way.goal - tip_mm;
  return length(left) <= step_mm ? way.goal : tip_mm + left * (step_mm / length(left));
}

bool pointer_pedal(const InputQueue& input, bool mouse) {
  return input.down(GLFW_KEY_SPACE) || (mouse && input.button_down(GLFW_MOUSE_BUTTON_LEFT));
}

}  // namespace cavum::station
