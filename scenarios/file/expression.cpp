#include "scenarios/file/expression.h"

#include <muParser.h>

#include <cmath>

namespace cavum::scenarios {
namespace {

double smaller(double a, double b) { return a < b ? a : b; }
double larger(double a, double b) { return a < b ? b : a; }
double absolute(double a) { return a < 0 ? -a : a; }

void prepare(mu::Parser& parser, const std::string& text) {
  // What muParser would hand to libm, and what would assign: refused by sign, for they are
  // operators.
  if (text.find('^') != std::string::npos)
    throw ExpressionError(msg("powers (^) are not available: multiply instead"));
  for (std::size_t i = 0; i < text.size(); ++i) {
    const bool compares = (i > 0 && (text[i - 1] == '=' || text[i - 1] == '<' ||
                                     text[i - 1] == '>' || text[i - 1] == '!')) ||
                          (i + 1 < text.size() && text[i + 1] == '=');
    if (text[i] == '=' && !compares)
      throw ExpressionError(msg("a single = assigns: compare with =="));
  }
  parser.ClearFun();
  parser.ClearConst();
  parser.DefineFun("min", smaller);
  parser.DefineFun("max", larger);
  parser.DefineFun("abs", absolute);
  parser.SetExpr(text);
}

[[noreturn]] void complain(const mu::Parser::exception_type& e) {
  std::string message = e.GetMsg();
  while (!message.empty() && (message.back() == '.' || message.back() == '\n')) message.pop_back();
  throw ExpressionError(Name{message});
}

}  // namespace

struct Expression::Impl {
  mu::Parser parser;
};

Expression::Expression(const std::string& text, const std::vector<std::string>& names,
                       std::vector<double>& values)
    : impl_(std::make_unique<Impl>()) {
  try {
    for (std::size_t i = 0; i < names.size(); ++i) impl_->parser.DefineVar(names[i], &values[i]);
    prepare(impl_->parser, text);
    static_cast<void>(impl_->parser.Eval());  // compiles, so that later calls only run bytecode
  } catch (const mu::Parser::exception_type& e) {
    complain(e);
  }
}

Expression::Expression(Expression&&) noexcept = default;
Expression& Expression::operator=(Expression&&) noexcept = default;
Expression::~Expression() = default;

double Expression::value() const noexcept {
  try {
    const double v = impl_->parser.Eval();
    return std::isfinite(v) ? v : 0.0;
  } catch (...) {
    return 0.0;
  }
}

std::vector<std::string> functions_in_expression(const std::string& text) {
  std::vector<std::string> names;
  std::string name;
  for (const char c : text) {
    const bool letter =
        (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '_';
    if (letter) {
      name += c;
    } else if (c == '(' && !name.empty()) {
      names.push_back(name);
      name.clear();
    } else if (c != ' ') {
      name.clear();
    }
  }
  return names;
}

std::vector<std::string> names_in_expression(const std::string& text) {
  try {
    mu::Parser parser;
    prepare(parser, text);
    std::vector<std::string> names;
    for (const auto& [name, address] : parser.GetUsedVar())
      names.push_back(name);  // a std::map: sorted
    return names;
  } catch (const mu::Parser::exception_type& e) {
    complain(e);
  }
}

}  // namespace cavum::scenarios
