// The messages of one language. Boost.Locale reads the catalogues that msgfmt compiled; no locale
// of the system is needed or set.
#pragma once

#include <locale>
#include <optional>
#include <string>

namespace cavum {

class Catalogue {
 public:
  enum class Kind { english, translated, pseudo };
  /// English, which needs no file.
  Catalogue() = default;
  /// A language by its name. Throws Error when there is no catalogue of it.
  explicit Catalogue(const std::string& language);

  [[nodiscard]] Kind kind() const noexcept { return kind_; }
  [[nodiscard]] const std::string& language() const noexcept { return language_; }
  /// Between whole and decimal digits.
  [[nodiscard]] char decimal_sign() const noexcept { return decimal_sign_; }
  /// A message; nothing where the catalogue does not have it. In the pseudo-language every message
  /// is there.
  [[nodiscard]] std::optional<std::string> find(const std::string& english) const;
  [[nodiscard]] std::optional<std::string> find(const std::string& one, const std::string& many,
                                                long long count) const;

 private:
  Kind kind_ = Kind::english;
  std::string language_ = "en";
  char decimal_sign_ = '.';
  std::locale locale_;
};

/// Of the language that is shown.
[[nodiscard]] const Catalogue& catalogue() noexcept;

}  // namespace cavum
