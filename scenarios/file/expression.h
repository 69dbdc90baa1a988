// Conditions of steps: arithmetic, comparison and logic over named quantities. Everything that goes
// through libm (sin, exp, random numbers, powers) is taken out, so a condition gives the same answer in
// every replay. Operators: + - * / < > <= >= == != && || ?: and functions min, max, abs.
#pragma once

#include <memory>
#include <string>
#include <vector>

namespace cavum::scenarios {

/// A compiled expression over a table of doubles. It reads the table by address: the table must stay
/// where it is, and its size must not change, as long as the expression lives.
class Expression {
 public:
  /// `names[i]` is the name of `values[i]`. Throws std::runtime_error with a message for the author.
  Expression(const std::string& text, const std::vector<std::string>& names, std::vector<double>& values);
  Expression(Expression&&) noexcept;
  Expression& operator=(Expression&&) noexcept;
  ~Expression();

  /// Value now; a division by zero or another value that is not finite counts as 0. Allocates nothing.
  [[nodiscard]] double value() const noexcept;
  [[nodiscard]] bool is_true() const noexcept { return value() != 0.0; }

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

/// Names that an expression uses, sorted. Throws std::runtime_error when it cannot be read at all.
[[nodiscard]] std::vector<std::string> names_in_expression(const std::string& text);

/// Names that stand before a bracket, in their order.
[[nodiscard]] std::vector<std::string> functions_in_expression(const std::string& text);

}  // namespace cavum::scenarios
