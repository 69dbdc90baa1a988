// What went wrong or stepped in during a tick, as bits. The recording keeps them; events explain
// them.
#pragma once

#include <cstdint>

namespace cavum {

enum TickNotice : std::uint16_t {
  k_notice_stale_stylus =
      1,                  ///< no fresh pose for longer than the watchdog allows: force is faded out
  k_notice_no_pedal = 2,  ///< pedal unknown: handpiece off
  k_notice_force_clamped = 4,  ///< the rendered force met the device's peak
  k_notice_slew_limited = 8,   ///< the force changed faster than the device may
  k_notice_force_budget = 16,  ///< sustained force above the continuous rating: reduced to it
  k_notice_not_finite = 32,    ///< a value was not finite: force set to zero
  k_notice_tooth_full = 64,    ///< no room left to record a carve: it was cut short in this tick
  k_notice_bad_bur = 128,      ///< no such bur in the tray: handpiece off, no contact
};

}  // namespace cavum
