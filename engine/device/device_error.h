// What can be wrong with a stylus or a foot pedal, for whoever has to tell one from another; in words it stands in the Error that bears it.
#pragma once

#include <cstdint>
#include <string_view>
#include <utility>

#include "engine/base/error.h"

namespace cavum {

enum class DeviceError : std::uint8_t {
  // finding and opening
  unknown_stylus,  ///< no stylus of the table has this name
  not_there,       ///< not plugged in
  several,         ///< and none of them is chosen
  not_permitted,   ///< the system lets nobody open it: a udev rule is missing
  in_use,
  refuses,  ///< the device, or its maker's driver, does not do what it is told
  library_missing,
  library_too_old,
  no_service,  ///< its maker's service does not answer
  usb_stopped,
  firmware_missing,
  wrong_firmware,  ///< it does not arrive, or does not run
  bad_descriptor,
  no_such_axis,
  // while it is open
  starting,
  lost,  ///< was there a moment ago: unplugged, or its line is cut
  silent,
  failed,  ///< for a reason that is not the device's own
  malformed_message,
  needs_homing,
  needs_calibration,
  no_power,
  no_position,
  no_direction,
  // what a station keeps of it, and how it is set up
  incomplete_record,
  name_taken,
  not_a_setting,
  not_a_usb_id,
  no_pedal,
  ends_equal,  ///< released and pressed are the same
  axes_still,  ///< no axis moved while the pedal was pressed
  unequal_marks,
  marks_in_line,
  // its friction in air
  moves_unpushed,
  stuck,
};

/// Of the stylus that is called `id`.
[[nodiscard]] inline Error stylus_error(std::string_view id, DeviceError code, Message problem, Message advice) {
  return {code, msg("stylus {}", id), std::move(problem), std::move(advice)};
}

}  // namespace cavum
