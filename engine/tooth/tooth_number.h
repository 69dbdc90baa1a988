// Which tooth of the jaw it is: its number, or as much as was said.
#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include "engine/base/message.h"

namespace cavum {

enum class Jaw : std::uint8_t { unknown, upper, lower };
enum class ToothClass : std::uint8_t { unknown, incisor, canine, premolar, molar };

/// A permanent tooth by its FDI number (ISO 3950): 11 to 48.
struct ToothNumber {
  int fdi = 0;
  [[nodiscard]] int quadrant() const noexcept {
    return fdi / 10;
  }  ///< 1 upper right, 2 upper left, 3 lower left, 4 lower right
  [[nodiscard]] int place() const noexcept {
    return fdi % 10;
  }  ///< 1 central incisor to 8 third molar
  [[nodiscard]] bool upper() const noexcept { return quadrant() <= 2; }
  [[nodiscard]] bool left() const noexcept { return quadrant() == 2 || quadrant() == 3; }
  /// Number of the universal system, 1 to 32.
  [[nodiscard]] int universal() const noexcept;
  [[nodiscard]] ToothClass tooth_class() const noexcept;
  /// "lower left first molar"
  [[nodiscard]] Message name() const;
  /// "36 (universal 19, lower left first molar)"
  [[nodiscard]] Message in_words() const {
    return msg("{} (universal {}, {})", fdi, universal(), name());
  }
  /// "36 (universal 19), lower left first molar", as files keep it.
  [[nodiscard]] std::string text() const;
  /// z cross mesial, with z occlusal, points to the lips or cheek in quadrants 1 and 3, and to
  /// tongue or palate in 2 and 4.
  [[nodiscard]] bool y_is_buccal() const noexcept { return quadrant() % 2 == 1; }
  /// The same tooth on the other side of the jaw: 46 of 36.
  [[nodiscard]] ToothNumber other_side() const noexcept {
    return {(upper() ? 3 - quadrant() : 7 - quadrant()) * 10 + place()};
  }
  [[nodiscard]] bool exists() const noexcept {
    return fdi > 10 && quadrant() <= 4 && place() >= 1 && place() <= 8;
  }
  friend bool operator==(const ToothNumber&, const ToothNumber&) = default;
};
/// Throws Error(`option`, ...) for what is no permanent tooth.
[[nodiscard]] ToothNumber from_fdi(int number, const std::string& option);
[[nodiscard]] ToothNumber from_universal(int number, const std::string& option);

/// "tooth 36 (universal 19), lower left first molar": how the name of a tooth begins whose number
/// was said.
[[nodiscard]] std::string name_with(const ToothNumber& number);

/// Which tooth it is, as far as that was said: of its number, where there is one, follow jaw and
/// class.
struct ToothKind {
  Jaw jaw = Jaw::unknown;
  ToothClass tooth_class = ToothClass::unknown;
  std::optional<ToothNumber> number = {};
  ToothKind() = default;
  ToothKind(Jaw of, ToothClass kind) : jaw(of), tooth_class(kind) {}
  explicit ToothKind(const ToothNumber& n)
      : jaw(n.upper() ? Jaw::upper : Jaw::lower), tooth_class(n.tooth_class()), number(n) {}
  /// Known to be an incisor or a canine.
  [[nodiscard]] bool anterior() const noexcept {
    return tooth_class == ToothClass::incisor || tooth_class == ToothClass::canine;
  }
  friend bool operator==(const ToothKind&, const ToothKind&) = default;
};

}  // namespace cavum
