// What only the libusb back end of hidapi does: it speaks to the device itself.
#include <gtest/gtest.h>

#include <chrono>
#include <thread>

#include "engine/device/hardware/hid_pedal.h"
#include "tests/device/emulated_usb_pedal.h"
#include "tests/engine/support/basics.h"

namespace cavum {
namespace {

TEST(UsbPedal, IsNeverAskedForAReport) {
  if (!testing_device::EmulatedUsbPedal::possible())
    GTEST_SKIP() << "runs under umockdev-wrapper only: ctest does so";
  testing_device::EmulatedUsbPedal pedal;
  EXPECT_EQ(list_hid_pedals().size(), 1u);
  {
    HidPedal reader(0x068e, 0x00f2,
                    {.axis = 0, .released = 0, .pressed = 255, .speaks_on_change = false});
    for (int i = 0; i < 20000 && !reader.read().fresh; ++i) {
      pedal.report_axes(128, 0, 0);
      std::this_thread::sleep_for(std::chrono::milliseconds(1));
    }
    EXPECT_TRUE(reader.read().fresh) << testing_basics::text_of(reader.problem());
  }
  EXPECT_EQ(pedal.asked_for_reports(), 0) << "the CH pedals do not answer that";
}

}  // namespace
}  // namespace cavum
