// A person who cuts a cavity by what the window shows: lays lines in it, from its opening to its
// floor, and brings the tip along them, looking at each picture where the tip is. Learns first
// which way its hand goes in the picture.
#pragma once

#include <array>
#include <vector>

#include "scenarios/zones/zone_map.h"
#include "tests/ui/person/means.h"

namespace cavum::testing_person {

/// Places for the tip, in their order, tooth frame.
using Way = std::vector<Vec3>;
/// In layers along the cavity's longer side, there and back, for a cylinder of this radius.
[[nodiscard]] std::vector<Way> ways_through(const scenarios::ZoneMap& zones, double radius_mm);

class Person {
 public:
  Person(Means& means, Eye eye) : means_(means), eye_(std::move(eye)) {}
  /// Moves a little each way, in the air.
  void learn();
  /// Brings the tip along; returns 0, or 1 when it was held up for long and the rest was left.
  int follow(const Way& way);
  /// Straight up, out of the tooth.
  void lift(double mm);

 private:
  /// A picture that began after the call.
  [[nodiscard]] Seen look() const;
  /// Where the tip comes to rest.
  [[nodiscard]] Vec3 at_rest() const;
  void want(Vec3 tip_mm);

  Means& means_;
  Eye eye_;
  std::array<Vec3, 3> per_unit_mm_;  // of the hand's units: way of the tip
  Vec3 wanted_mm_;                   // where the hand wants the tip, by what it did
  Vec3 aside_mm_;  // of the line: what holds the tip off it, as it was seen so far
};

}  // namespace cavum::testing_person
