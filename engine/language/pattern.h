// A sentence of the catalogue with gaps, "{} of {:.1f} steps" or "%d of %d steps", held against a sentence that may have been made of it.
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace cavum {

class Pattern {
 public:
  /// `message` as fmt reads it; one without `{` that has conversions as printf reads it. Throws std::invalid_argument when it is none.
  explicit Pattern(std::string_view message);
  [[nodiscard]] const std::string& message() const noexcept { return message_; }
  /// Letters of the longest text between two gaps.
  [[nodiscard]] std::size_t letters() const noexcept { return letters_; }
  /// Letters of all of them.
  [[nodiscard]] std::size_t all_letters() const noexcept { return all_letters_; }
  [[nodiscard]] std::size_t gaps() const noexcept { return arguments_.size(); }
  /// Whether an argument stands between quotation marks: '{}'.
  [[nodiscard]] bool quoted(std::size_t argument) const;
  /// What stands in the gaps, by argument; nothing where the sentence is not of this message.
  [[nodiscard]] std::optional<std::vector<std::string>> match(std::string_view sentence) const;
  /// The message, or a translation of it, with texts in its gaps, whatever those say of form ("{:.2f}").
  [[nodiscard]] static std::string fill(std::string_view message, const std::vector<std::string>& texts);
  /// Arguments of a message with the form of each, in the order of their numbers: "0:", "1:.2f". What two translations of one message have in common.
  [[nodiscard]] static std::vector<std::string> arguments(std::string_view message);

 private:
  [[nodiscard]] bool match_from(std::size_t literal, std::string_view rest, std::vector<std::string_view>& found) const;
  std::string message_;
  std::vector<std::string> literals_;   // before, between and after the gaps: one more than gaps
  std::vector<std::size_t> arguments_;  // of each gap
  std::size_t longest_ = 0, letters_ = 0, all_letters_ = 0;
};

}  // namespace cavum
