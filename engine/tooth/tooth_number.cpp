#include "engine/tooth/tooth_number.h"

#include <fmt/core.h>

#include <array>

#include "engine/base/error.h"

namespace cavum {

int ToothNumber::universal() const noexcept {
  switch (quadrant()) {
    case 1:
      return 9 - place();
    case 2:
      return 8 + place();
    case 3:
      return 25 - place();
    default:
      return 24 + place();
  }
}

ToothClass ToothNumber::tooth_class() const noexcept {
  return place() <= 2   ? ToothClass::incisor
         : place() == 3 ? ToothClass::canine
         : place() <= 5 ? ToothClass::premolar
                        : ToothClass::molar;
}

Message ToothNumber::name() const {
  const std::array<Message, 8> kinds{
      msg("central incisor"), msg("lateral incisor"), msg("canine"),       msg("first premolar"),
      msg("second premolar"), msg("first molar"),     msg("second molar"), msg("third molar")};
  const Message& kind = kinds[static_cast<std::size_t>(place() - 1)];
  return upper()  ? left() ? msg("upper left {}", kind) : msg("upper right {}", kind)
          : left() ? msg("lower left {}", kind)
                  : msg("lower right {}", kind);
}

std::string ToothNumber::text() const {
  return fmt::format("{} (universal {}), {}", fdi, universal(), english_text(name()));
}

ToothNumber from_fdi(int number, const std::string& option) {
  const ToothNumber n{number};
  if (!n.exists())
    throw Error(option, msg("{} is no permanent tooth of the FDI", number),
                msg("give 11 to 18, 21 to 28, 31 to 38 or 41 to 48"));
  return n;
}

ToothNumber from_universal(int number, const std::string& option) {
  if (number < 1 || number > 32)
    throw Error(option, msg("{} is no permanent tooth of the universal system", number),
                msg("give 1 to 32"));
  const int fdi = number <= 8    ? 10 + 9 - number
                  : number <= 16 ? 20 + number - 8
                  : number <= 24 ? 30 + 25 - number
                                 : 40 + number - 24;
  return from_fdi(fdi, option);
}

std::string name_with(const ToothNumber& number) { return "tooth " + number.text(); }

}  // namespace cavum
