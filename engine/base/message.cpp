#include "engine/base/message.h"

#include <fmt/args.h>
#include <fmt/format.h>

#include <algorithm>
#include <array>

#include "engine/base/figures.h"
#include "engine/base/pseudo.h"
#include "engine/base/text.h"

namespace cavum {
namespace {

struct UnitRow {
  std::string_view id, sign;
};
constexpr std::array<UnitRow, 16> k_units{{{"", ""},
                                           {"mm", "mm"},
                                           {"mm2", "mm²"},
                                           {"mm3", "mm³"},
                                           {"um", "µm"},
                                           {"N", "N"},
                                           {"deg", "°"},
                                           {"s", "s"},
                                           {"min", "min"},
                                           {"ms", "ms"},
                                           {"rpm", "rpm"},
                                           {"%", "%"},
                                           {"Hz", "Hz"},
                                           {"mm/s", "mm/s"},
                                           {"N/mm", "N/mm"},
                                           {"bytes", "bytes"}}};
static_assert(k_units.size() == static_cast<std::size_t>(Unit::byte) + 1);

template <class... F>
struct Overloaded : F... {
  using F::operator()...;
};
template <class... F>
Overloaded(F...) -> Overloaded<F...>;

class English final : public Locale {
 public:
  [[nodiscard]] std::string sentence(const char* english) const override {
    return source_sentence(english);
  }
  [[nodiscard]] std::string sentence(const char* one, const char* many,
                                     std::int64_t count) const override {
    return source_sentence(count == 1 ? one : many);
  }
  [[nodiscard]] std::string term(const std::string& english) const override { return english; }
  [[nodiscard]] std::string authored(const std::string& english) const override { return english; }
  [[nodiscard]] std::string name(const std::string& text) const override { return text; }
  [[nodiscard]] char decimal_sign() const noexcept override { return '.'; }
};

std::string figure(double value, int digits, const Locale& locale) {
  std::string text = digits < 0 ? plain_number(value) : fixed(value, digits);
  std::replace(text.begin(), text.end(), '.', locale.decimal_sign());
  return text;
}

std::string rendered(const Number& n, const Locale& locale) {
  std::string text = (n.sign && n.value >= 0 ? "+" : "") + figure(n.value, n.digits, locale);
  if (n.bound > 0) text += " ± " + figure(n.bound, n.digits, locale);
  if (n.unit == Unit::none) return text;
  const std::string sign(unit_sign(n.unit));
  return text + (n.unit == Unit::deg ? "" : " ") +
         (n.unit == Unit::rpm ? locale.term(sign) : sign);  // the only one that is a word
}

std::string rendered(Vec3 p, const Locale& locale) {
  constexpr int k_digits = 2;
  const std::string between = locale.decimal_sign() == ',' ? "; " : ", ";
  return fmt::format("[{}{}{}{}{}] mm", figure(p.x, k_digits, locale), between,
                     figure(p.y, k_digits, locale), between, figure(p.z, k_digits, locale));
}

std::string filled(const std::string& sentence, const std::vector<std::string>& texts) {
  fmt::dynamic_format_arg_store<fmt::format_context> store;
  for (const std::string& t : texts) store.push_back(std::string_view(t));
  return fmt::vformat(sentence, store);
}

}  // namespace

std::string_view unit_sign(Unit unit) noexcept {
  return k_units[static_cast<std::size_t>(unit)].sign;
}
std::string_view unit_id(Unit unit) noexcept { return k_units[static_cast<std::size_t>(unit)].id; }
std::optional<Unit> unit_of(std::string_view id) noexcept {
  const auto* const row =
      std::find_if(k_units.begin(), k_units.end(), [&](const UnitRow& u) { return u.id == id; });
  return row == k_units.end() ? std::nullopt
                              : std::optional(static_cast<Unit>(row - k_units.begin()));
}

Message::Message(Name name) : english_("{}"), values_{Value(std::move(name))} {}

Message::Message(FileLocation place) : english_("{}"), values_{Value(std::move(place))} {}

Message::Message(const char* english, const char* plural, std::int64_t count,
                 std::vector<Value> values)
    : english_(english), plural_(plural), count_(count), values_(std::move(values)) {}

bool operator==(const Message& a, const Message& b) {
  if (a.empty() || b.empty()) return a.empty() == b.empty();
  return std::string_view(a.english_) == b.english_ && a.count_ == b.count_ &&
         a.values_ == b.values_;
}

std::string render(const Value& value, const Locale& locale) {
  return std::visit(
      Overloaded{
          [](std::int64_t whole) { return std::to_string(whole); },
          [&](const Number& n) { return rendered(n, locale); },
          [](const ClockTime& c) { return clock_text(c.seconds); },
          [&](const Vec3& p) { return rendered(p, locale); },
          [&](const Name& n) { return locale.name(n.text); },
          [&](const FileLocation& p) {
            const std::string line = p.line > 0 ? fmt::format(":{}", p.line) : "",
                              column = p.column > 0 ? fmt::format(":{}", p.column) : "";
            return locale.name(p.file + line + column);
          },
          [&](const Term& t) { return locale.term(t.english); },
          [&](const Authored& a) { return locale.authored(a.english); },
          [&](const List& list) {
            std::string all;
            for (const Message& m : list.items)
              all += (all.empty() ? "" : list.sentences ? "; " : ", ") + render(m, locale);
            return all;
          },
          [&](const Message& m) { return render(m, locale); },
      },
      static_cast<const Value::variant&>(value));
}

std::string render(const Message& m, const Locale& locale) {
  if (m.empty()) return {};
  if (m.values().size() == 1 && std::string_view(m.english()) == "{}")
    return render(m.values().front(), locale);
  std::vector<std::string> texts;
  for (const Value& v : m.values()) texts.push_back(render(v, locale));
  const std::string sentence = m.plural() == nullptr
                                   ? locale.sentence(m.english())
                                   : locale.sentence(m.english(), m.plural(), m.count());
  try {
    return filled(sentence, texts);
  } catch (const fmt::format_error&) {  // a translation with other gaps
    return filled(m.plural() == nullptr || m.count() == 1 ? m.english() : m.plural(), texts);
  }
}

std::string english_text(const Message& message) {
  static const English k_english;
  return render(message, k_english);
}

}  // namespace cavum
