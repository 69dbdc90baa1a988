// Which tooth of the jaw it is: its number, or as much as its name says.
#pragma once

#include <optional>
#include <string>

#include "engine/tooth/anatomy/landmarks.h"

namespace cavum {

/// A permanent tooth by its FDI number (ISO 3950): 11 to 48.
struct ToothNumber {
  int fdi = 0;
  [[nodiscard]] int quadrant() const noexcept { return fdi / 10; }  ///< 1 upper right, 2 upper left, 3 lower left, 4 lower right
  [[nodiscard]] int place() const noexcept { return fdi % 10; }     ///< 1 central incisor to 8 third molar
  [[nodiscard]] bool upper() const noexcept { return quadrant() <= 2; }
  [[nodiscard]] bool left() const noexcept { return quadrant() == 2 || quadrant() == 3; }
  /// Number of the universal system, 1 to 32.
  [[nodiscard]] int universal() const noexcept;
  [[nodiscard]] ToothClass tooth_class() const noexcept;
  /// "lower left first molar"
  [[nodiscard]] Message name() const;
  /// "36 (universal 19, lower left first molar)"
  [[nodiscard]] Message in_words() const { return msg("{} (universal {}, {})", fdi, universal(), name()); }
  /// "36 (universal 19), lower left first molar", as files keep it.
  [[nodiscard]] std::string text() const;
  /// z cross mesial, with z occlusal, points to the lips or cheek in quadrants 1 and 3, and to tongue or palate in 2 and 4.
  [[nodiscard]] bool y_is_buccal() const noexcept { return quadrant() % 2 == 1; }
  /// The same tooth on the other side of the jaw: 46 of 36.
  [[nodiscard]] ToothNumber other_side() const noexcept { return {(upper() ? 3 - quadrant() : 7 - quadrant()) * 10 + place()}; }
};
/// Throws Error(`option`, ...) for what is no permanent tooth.
[[nodiscard]] ToothNumber from_fdi(int number, const std::string& option);
[[nodiscard]] ToothNumber from_universal(int number, const std::string& option);

/// "tooth 36 (universal 19), lower left first molar": how the name of a tooth begins whose number was said.
[[nodiscard]] std::string name_with(const ToothNumber& number);
/// The number that a tooth's name begins with; none where nobody said one.
[[nodiscard]] std::optional<ToothNumber> number_in(const std::string& tooth_name);
/// Whether the name says "upper" or "lower"; none where it says neither.
[[nodiscard]] std::optional<bool> upper_in(const std::string& tooth_name);
/// Whether the name says that it is an incisor or a canine.
[[nodiscard]] bool anterior_in(const std::string& tooth_name);

}  // namespace cavum
