// Report descriptors: two worked by hand from the HID specification, ranges that read ambiguously,
// and damaged ones.
#include "engine/device/hardware/hid_descriptor.h"

#include <gtest/gtest.h>

#include <random>

#include "engine/device/device_error.h"
#include "tests/engine/support/basics.h"

namespace cavum {
namespace {

using Descriptor = std::vector<std::uint8_t>;

/// The mouse of the specification's appendix E.10: three buttons, five constant bits, two relative
/// axes.
const Descriptor k_mouse{0x05, 0x01, 0x09, 0x02, 0xa1, 0x01, 0x09, 0x01, 0xa1, 0x00,
                         0x05, 0x09, 0x19, 0x01, 0x29, 0x03, 0x15, 0x00, 0x25, 0x01,
                         0x95, 0x03, 0x75, 0x01, 0x81, 0x02, 0x95, 0x01, 0x75, 0x05,
                         0x81, 0x01, 0x05, 0x01, 0x09, 0x30, 0x09, 0x31, 0x15, 0x81,
                         0x25, 0x7f, 0x75, 0x08, 0x95, 0x02, 0x81, 0x06, 0xc0, 0xc0};
/// A pedal with a report number, a 10-bit accelerator, a 12-bit signed rudder and padding between.
const Descriptor k_numbered{0x05, 0x02, 0x09, 0x04, 0xa1, 0x01, 0x85, 0x03, 0x09, 0xc4, 0x15,
                            0x00, 0x26, 0xff, 0x03, 0x75, 0x0a, 0x95, 0x01, 0x81, 0x02, 0x75,
                            0x06, 0x81, 0x03, 0x09, 0xba, 0x16, 0x00, 0xf8, 0x26, 0xff, 0x07,
                            0x75, 0x0c, 0x81, 0x02, 0x75, 0x04, 0x81, 0x03, 0xc0};

TEST(HidDescriptor, MouseOfTheSpecification) {
  const HidLayout layout = parse_hid_descriptor(k_mouse);
  ASSERT_EQ(layout.fields.size(), 5u);
  EXPECT_EQ(layout.report_bytes(0), 3u);
  EXPECT_FALSE(layout.numbered);
  EXPECT_EQ(layout.fields[2].usage, 3);
  EXPECT_EQ(layout.fields[2].page, 9);
  EXPECT_EQ(layout.fields[4].first_bit, 16u);
  EXPECT_TRUE(layout.fields[4].relative);
  EXPECT_TRUE(layout.axes().empty()) << "a mouse is no pedal";
  const Descriptor report{0x05, 0x81, 0x7f};
  EXPECT_EQ(hid_value(layout.fields[0], false, report), 1);
  EXPECT_EQ(hid_value(layout.fields[1], false, report), 0);
  EXPECT_EQ(hid_value(layout.fields[3], false, report), -127);
  EXPECT_EQ(hid_value(layout.fields[4], false, report), 127);
}

TEST(HidDescriptor, NumbersAndFieldsAcrossBytes) {
  const HidLayout layout = parse_hid_descriptor(k_numbered);
  const auto axes = layout.axes();
  ASSERT_EQ(axes.size(), 2u);
  EXPECT_EQ(layout.report_bytes(3), 5u);
  EXPECT_EQ(layout.report_bytes(1), 0u);
  EXPECT_EQ(axes[0].first_bit, 8u);
  EXPECT_EQ(axes[1].first_bit, 24u);
  EXPECT_EQ(axes[1].least, -2048);
  const Descriptor report{0x03, 0xff, 0x02, 0x00, 0x08};  // 0x2ff; 0x800 = -2048
  EXPECT_EQ(hid_value(axes[0], true, report), 0x2ff);
  EXPECT_EQ(hid_value(axes[1], true, report), -2048);
  EXPECT_FALSE(hid_value(axes[0], true, Descriptor{0x04, 0xff, 0x02, 0, 0})) << "another report";
  EXPECT_FALSE(hid_value(axes[1], true, std::span(report).first(4))) << "cut off";
}

TEST(HidDescriptor, LargestValueOfOneByteIsPositiveWhereTheSmallestIs) {
  const auto axes = parse_hid_descriptor(Descriptor{0x05, 0x01, 0x09, 0x30, 0x15, 0x00, 0x25, 0xff,
                                                    0x75, 0x08, 0x95, 0x01, 0x81, 0x02})
                        .axes();
  ASSERT_EQ(axes.size(), 1u);
  EXPECT_EQ(axes[0].most, 255);
}

TEST(HidDescriptor, PushAndPopAndUsageRanges) {
  const HidLayout layout = parse_hid_descriptor(
      Descriptor{0x05, 0x01, 0x15, 0x00, 0x26, 0xff, 0x00, 0x75, 0x08, 0x95, 0x03, 0xa4,
                 0x05, 0x09, 0x75, 0x01, 0xb4, 0x19, 0x30, 0x29, 0x31, 0x81, 0x02});
  ASSERT_EQ(layout.fields.size(), 3u);
  EXPECT_EQ(layout.fields[0].page, 1);
  EXPECT_EQ(layout.fields[0].bits, 8u);
  EXPECT_EQ(layout.fields[1].usage, 0x31);
  EXPECT_EQ(layout.fields[2].usage, 0x31) << "the last usage holds for what is left";
}

TEST(HidDescriptor, WhatCannotBeIsRefused) {
  for (const Descriptor& wrong :
       {Descriptor{}, Descriptor{0x26, 0xff}, Descriptor{0xa1, 0x01, 0x09, 0x30}, Descriptor{0xc0},
        Descriptor{0xb4}, Descriptor{0x85, 0x00}, Descriptor{0x77, 0xff, 0xff, 0xff, 0x7f},
        Descriptor{0xfe, 0x05, 0x10}, Descriptor(5000, 0x00)})
    EXPECT_EQ(testing_basics::code_of([&] { static_cast<void>(parse_hid_descriptor(wrong)); }),
              DeviceError::bad_descriptor);
}

/// Any bytes: either refused, or a layout whose fields all lie within their reports, readable
/// whatever the report holds.
TEST(HidDescriptor, AMillionDamagedDescriptorsNeverReadOutside) {
  std::mt19937_64 random(testing_basics::drawn_seed("damaged descriptors"));
  int accepted = 0;
  for (int i = 0; i < 1'000'000; ++i) {
    Descriptor d = i % 3 == 0 ? k_mouse : i % 3 == 1 ? k_numbered : Descriptor(random() % 40);
    if (i % 3 == 2) {
      for (auto& byte : d) byte = static_cast<std::uint8_t>(random());
    } else {
      for (auto damage = 1 + random() % 4; damage > 0; --damage)
        d[random() % d.size()] = static_cast<std::uint8_t>(random());
      if (random() % 8 == 0) d.resize(random() % d.size());
    }
    HidLayout layout;
    try {
      layout = parse_hid_descriptor(d);
    } catch (const Error&) {
      continue;
    }
    ++accepted;
    ASSERT_LE(layout.longest_bytes(), 4097u);
    Descriptor report(layout.longest_bytes());
    for (auto& byte : report) byte = static_cast<std::uint8_t>(random());
    for (const HidField& f : layout.fields) {
      ASSERT_LE(f.first_bit + f.bits, 8 * layout.report_bytes(f.report_id));
      static_cast<void>(hid_value(f, layout.numbered, report));
    }
  }
  std::printf("%d of a million accepted\n", accepted);
  EXPECT_GT(accepted, 1000);
}

}  // namespace
}  // namespace cavum
