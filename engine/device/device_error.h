// What can be wrong with a stylus or a foot pedal, for whoever has to tell one from another; in
// words it stands in the Error that bears it.
#pragma once

#include <string_view>
#include <utility>

#include "engine/base/error.h"
#include "engine/base/named_enum.h"

namespace cavum {

// clang-format off
#define CAVUM_DEVICE_ERRORS(ERROR) \
  /* finding and opening */ \
  ERROR(unknown_stylus)     /* no stylus of the table has this name */ \
  ERROR(not_there)          /* not plugged in */ \
  ERROR(several)            /* and none of them is chosen */ \
  ERROR(not_permitted)      /* the system lets nobody open it: a udev rule is missing */ \
  ERROR(in_use) \
  ERROR(refuses)            /* the device, or its maker's driver, does not do what it is told */ \
  ERROR(library_missing) \
  ERROR(library_too_old) \
  ERROR(no_service)         /* its maker's service does not answer */ \
  ERROR(usb_stopped) \
  ERROR(firmware_missing) \
  ERROR(wrong_firmware)     /* it does not arrive, or does not run */ \
  ERROR(bad_descriptor) \
  ERROR(no_such_axis) \
  /* while it is open */ \
  ERROR(starting) \
  ERROR(lost)               /* was there a moment ago: unplugged, or its line is cut */ \
  ERROR(silent) \
  ERROR(failed)             /* for a reason that is not the device's own */ \
  ERROR(malformed_message) \
  ERROR(needs_homing) \
  ERROR(needs_calibration) \
  ERROR(no_power) \
  ERROR(no_position) \
  ERROR(no_direction) \
  /* what a station keeps of it, and how it is set up */ \
  ERROR(incomplete_record) \
  ERROR(name_taken) \
  ERROR(not_a_setting) \
  ERROR(not_a_usb_id) \
  ERROR(no_pedal) \
  ERROR(ends_equal)         /* released and pressed are the same */ \
  ERROR(axes_still)         /* no axis moved while the pedal was pressed */ \
  ERROR(unequal_marks) \
  ERROR(marks_in_line) \
  /* its friction in air */ \
  ERROR(moves_unpushed) \
  ERROR(stuck)
// clang-format on

CAVUM_NAMED_ENUM(DeviceError, CAVUM_DEVICE_ERRORS)

/// Of the stylus that is called `id`.
[[nodiscard]] inline Error stylus_error(std::string_view id, DeviceError code, Message problem,
                                        Message advice) {
  return {code, msg("stylus {}", id), std::move(problem), std::move(advice)};
}

}  // namespace cavum
