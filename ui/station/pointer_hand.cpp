#include "ui/station/pointer_hand.h"

#define GLFW_INCLUDE_NONE
#include <GLFW/glfw3.h>

#include <cmath>

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

}  // namespace

void move_by_pointer(const InputQueue& input, const PointerView& view, Vec3& tip_mm, Quat& rotation) {
  double x = 0, y = 0, deeper = 0, lean_x = 0, lean_y = 0;
  constexpr double k_lean_px = 0.25 * k_degree;
  for (const InputEvent& e : input.played()) {
    const double share = e.shift ? k_pointer_fine : 1.0;
    if (e.kind == InputEvent::Kind::key && e.code == GLFW_KEY_0 && e.down && !e.ctrl) rotation = rotation_between({0, 0, 1}, view.out);
    if (!view.mouse || input.button_down(GLFW_MOUSE_BUTTON_RIGHT)) continue;  // which turns the view
    if (e.kind == InputEvent::Kind::wheel && !e.ctrl) deeper -= share * k_pointer_notch_mm * static_cast<double>(e.y);
    if (e.kind != InputEvent::Kind::motion) continue;
    (e.ctrl ? lean_x : x) += share * static_cast<double>(e.x) * (e.ctrl ? k_lean_px : view.mm_per_px);
    (e.ctrl ? lean_y : y) -= share * static_cast<double>(e.y) * (e.ctrl ? k_lean_px : view.mm_per_px);
  }
  const bool leans = input.down(GLFW_KEY_LEFT_CONTROL) || input.down(GLFW_KEY_RIGHT_CONTROL);
  const bool fine = input.down(GLFW_KEY_LEFT_SHIFT) || input.down(GLFW_KEY_RIGHT_SHIFT);
  const double share = fine ? k_pointer_fine : 1.0;
  const HeldKeyLaw way{share * k_pointer_step_mm, share * k_pointer_mm_s}, lean{share * k_degree, share * 40.0 * k_degree};
  const auto between = [&input](const HeldKeyLaw& law, int more, int less) { return law.travel(input.hold(more)) - law.travel(input.hold(less)); };
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

bool pointer_pedal(const InputQueue& input, bool mouse) { return input.down(GLFW_KEY_SPACE) || (mouse && input.button_down(GLFW_MOUSE_BUTTON_LEFT)); }

}  // namespace cavum::station
