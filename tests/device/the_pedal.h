// The pedal that suits the back end of hidapi with which this program is linked: the same tests run
// on both.
#pragma once

#ifdef CAVUM_HIDAPI_LIBUSB
#include "tests/device/emulated_usb_pedal.h"
namespace cavum::testing_device {
using ThePedal = EmulatedUsbPedal;
}
#else
#include "tests/device/emulated_pedal.h"
namespace cavum::testing_device {
using ThePedal = EmulatedPedal;
}
#endif
