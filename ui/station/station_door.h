// One station at a time: while an exam is locked, a second start of the program at the same station
// is refused, and the first one hears of it. The door is a socket of the system that belongs to the
// station's own folder ($CAVUM_HOME); it goes with the program, however that ends.
#pragma once

#include <string>

namespace cavum::station {

class StationDoor {
 public:
  /// Keeps it shut. Throws Error when another program does.
  StationDoor();
  ~StationDoor();
  StationDoor(const StationDoor&) = delete;
  StationDoor& operator=(const StationDoor&) = delete;
  /// How many starts were refused since it was asked last.
  [[nodiscard]] int knocks();
  /// For any other start: throws Error when a locked station keeps the door shut, which hears of
  /// it.
  static void pass();

 private:
  int socket_ = -1;
};

}  // namespace cavum::station
