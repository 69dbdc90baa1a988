// The one table of styluses. A record says all that the rest of Cavum needs of a stylus: its name,
// what it measures and bears, its settings, how it is looked for and opened. Command line, station,
// calibration, device check, udev rules and help read it; a new stylus is a new record. How to add
// one: docs/howto/add_a_stylus.md.
#pragma once

#include <functional>
#include <initializer_list>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "engine/device/hardware/station_stylus.h"
#include "engine/device/simulated_stylus.h"
#include "engine/device/stylus.h"

namespace cavum {

/// Who moves it: a person who holds the device; the built-in candidate in a simulated hand; or a
/// mouse, in the exam window.
enum class StylusHand { person, candidate, mouse };

/// Vendor and product of a USB device that we open ourselves: it needs a udev rule.
struct UsbNumbers {
  std::uint16_t vendor = 0, product = 0;
};

struct StylusOptions {
  StationStylus station;  ///< placement and settings of this station
  std::function<HandIntent(double t_s)>
      hand;                   ///< of the simulated one; empty: nobody holds it, it lies free
  Vec3 free_at_mm{0, 0, 20};  ///< where it lies then, tooth frame
};

/// What a look found.
struct StylusLook {
  bool there = false;
  std::optional<Error> problem = {};  ///< why it cannot be opened
};

struct StylusKind {
  StylusFacts facts;  ///< id, name and ratings: what an open one says, unless the device itself
                      ///< knows better
  StylusHand hand = StylusHand::person;
  Placement placement =
      {};  ///< the usual one: the device in front of the candidate, its middle at the crown's
  std::vector<StylusSetting> settings = {};
  std::optional<UsbNumbers> usb = {};
  /// Looks whether it is there. With `begin` its driver may be begun, which not every driver likes
  /// twice a second. Does not throw.
  std::function<StylusLook(const StationStylus&, bool begin)> look = {};
  /// Serial number of the device that is there; empty function or text: it tells none.
  std::function<std::string(const StationStylus&)> serial = {};
  /// Throws Error when it can never work as it stands. Empty for the mouse, which needs the exam
  /// window.
  std::function<std::unique_ptr<Stylus>(const StylusOptions&)> open = {};
};

/// A table of styluses, each id once.
class StylusKinds {
 public:
  /// Throws Error naming the record that lacks something, or whose id is taken or no lower-case
  /// word.
  explicit StylusKinds(std::vector<StylusKind> kinds);

  [[nodiscard]] std::span<const StylusKind> all() const noexcept { return kinds_; }
  /// The record of `id`. Throws Error at `where` for a name that is none of `hands`, naming those
  /// that are.
  [[nodiscard]] const StylusKind& at(const std::string& id, const Message& where,
                                     std::initializer_list<StylusHand> hands) const;
  /// Ids of those that `hands` hold, in the order of the table.
  [[nodiscard]] std::vector<std::string> ids(std::initializer_list<StylusHand> hands) const;

 private:
  std::vector<StylusKind> kinds_;
};

/// Those of Cavum.
[[nodiscard]] const StylusKinds& stylus_kinds();

}  // namespace cavum
