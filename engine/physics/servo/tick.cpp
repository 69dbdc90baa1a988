#include "engine/physics/servo/tick.h"

#include <array>
#include <cmath>

#include "engine/base/hash.h"

namespace cavum {
namespace {

/// Rounded, and held within 32 bits.
std::int32_t to_whole(double value) noexcept {
  if (!(value > -2147483647.0)) return -2147483647;
  if (!(value < 2147483647.0)) return 2147483647;
  return static_cast<std::int32_t>(std::floor(value + 0.5));
}

}  // namespace

TickInput make_tick_input(const Pose& pose, double pedal, std::uint16_t flags, std::uint8_t bur,
                          const TickInput& previous) noexcept {
  TickInput in = previous;
  in.flags = flags;
  in.bur = bur;
  constexpr double k_furthest_mm = 2000.0;  // nanometres in 32 bits end at 2147 mm
  const Quat q = pose.rotation;
  const double n2 = q.w * q.w + q.x * q.x + q.y * q.y + q.z * q.z;
  const Vec3 t = pose.tip_mm;
  if (is_finite(t) && std::fabs(t.x) < k_furthest_mm && std::fabs(t.y) < k_furthest_mm &&
      std::fabs(t.z) < k_furthest_mm && n2 > 0.25 && n2 < 4.0) {
    in.tip_nm = {to_whole(t.x * 1e6), to_whole(t.y * 1e6), to_whole(t.z * 1e6)};
    const Quat u = normalized(q);
    constexpr double k_one = 1 << 30;
    in.rotation_q30 = {to_whole(u.w * k_one), to_whole(u.x * k_one), to_whole(u.y * k_one),
                       to_whole(u.z * k_one)};
  } else {
    in.flags = static_cast<std::uint16_t>((in.flags & ~k_stylus_fresh) | k_stylus_fault);
  }
  if (pedal >= 0.0 && pedal <= 1.0) {
    in.pedal_q16 = static_cast<std::uint16_t>(pedal * 65535.0 + 0.5);
  } else {
    in.pedal_q16 = 0;
    in.flags = static_cast<std::uint16_t>(in.flags & ~k_pedal_fresh);
  }
  return in;
}

TickRecord make_tick_record(const TickOutput& out) noexcept {
  TickRecord r;
  r.rendered_un = {to_whole(out.rendered_force_n.x * 1e6), to_whole(out.rendered_force_n.y * 1e6),
                   to_whole(out.rendered_force_n.z * 1e6)};
  r.model_un = to_whole(out.model_force_n * 1e6);
  r.penetration_nm = to_whole(out.penetration_mm * 1e6);
  r.proxy_nm = {to_whole(out.proxy_mm.x * 1e6), to_whole(out.proxy_mm.y * 1e6),
                to_whole(out.proxy_mm.z * 1e6)};
  r.rpm = to_whole(out.rpm);
  r.removed = out.removed_count;
  r.notices = out.notices;
  return r;
}

std::uint64_t hash_of(const TickRecord& record, std::uint64_t seed) noexcept {
  const std::array<std::int64_t, 11> whole{
      record.rendered_un[0], record.rendered_un[1], record.rendered_un[2],
      record.model_un,       record.penetration_nm, record.proxy_nm[0],
      record.proxy_nm[1],    record.proxy_nm[2],    record.rpm,
      record.removed,        record.notices};
  return fast_hash(whole.data(), sizeof whole, seed);
}

}  // namespace cavum
