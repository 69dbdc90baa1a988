// Conditions of steps: arithmetic, comparison and logic over named quantities. Everything that goes
// through libm (sin, exp, random numbers, powers) is taken out, so a condition gives the same
// answer in every replay. Operators: + - * / < > <= >= == != && || ?: and functions min, max, abs.
#pragma once

#include <memory>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "engine/base/message.h"

namespace cavum::scenarios {

/// What is wrong with an expression, for its author.
struct ExpressionError : std::runtime_error {
  explicit ExpressionError(Message what_it_is)
      : std::runtime_error(english_text(what_it_is)), problem(std::move(what_it_is)) {}
  Message problem;
};

/// A compiled expression over a table of doubles. It reads the table by address: the table must
/// stay where it is, and its size must not change, as long as the expression lives.
class Expression {
 public:
  /// `names[i]` is the name of `values[i]`. Throws ExpressionError.
  Expression(const std::string& text, const std::vector<std::string>& names,
             std::vector<double>& values);
  Expression(Expression&&) noexcept;
  Expression& operator=(Expression&&) noexcept;
  ~Expression();

  /// Value now; a division by zero or another value that is not finite counts as 0. Allocates
  /// nothing.
  [[nodiscard]] double value() const noexcept;
  [[nodiscard]] bool is_true() const noexcept { return value() != 0.0; }

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

/// Names that an expression uses, sorted. Throws ExpressionError when it cannot be read at all.
[[nodiscard]] std::vector<std::string> names_in_expression(const std::string& text);

/// Names that stand before a bracket, in their order.
[[nodiscard]] std::vector<std::string> functions_in_expression(const std::string& text);

}  // namespace cavum::scenarios
