// What rings round a crown tell of mesial, on rings of a formula: a circle of 4 mm, tilted so that
// its distal side is the higher one.
#include "engine/tooth/import/orientation.h"

#include <gtest/gtest.h>

#include <cmath>

namespace cavum {
namespace {

/// Contours and neck higher, and roots bent, as a tooth has them whose mesial is at -x.
Landmarks mesial_at_minus_x(ToothClass seen) {
  Landmarks l;
  l.tooth_class.kind = seen;
  for (int i = 0; i < 72; ++i) {
    const double a = 2 * 3.14159265358979 * i / 72, x = 4 * std::cos(a), y = 4 * std::sin(a);
    l.height_of_contour_mm.push_back({x, y, 3 - 0.1 * x});
    l.neck_mm.push_back({x, y, -0.1 * x});
  }
  l.apices_mm = {{1, 0, -14}};
  return l;
}

TEST(Orientation, ContoursOfALowerFirstPremolarTellNothing) {
  const auto mesial = [](ToothClass seen, std::optional<ToothNumber> number) {
    return seen_orientation(mesial_at_minus_x(seen), number).mesial();
  };
  for (const int fdi : {14, 15, 24, 25, 35, 45, 36, 46, 16, 27}) {
    const ToothNumber n = from_fdi(fdi, "x");
    EXPECT_EQ(mesial(n.tooth_class(), n), -1) << fdi;
  }
  for (const int fdi : {34, 44})
    EXPECT_EQ(mesial(ToothClass::premolar, from_fdi(fdi, "x")), 0) << fdi;
  EXPECT_EQ(mesial(ToothClass::premolar, std::nullopt), 0) << "it may be a lower first one";
  EXPECT_EQ(mesial(ToothClass::molar, std::nullopt), -1);
}

}  // namespace
}  // namespace cavum
