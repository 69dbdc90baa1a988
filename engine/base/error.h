// The one way in which bad input is reported: which error it is, where, what, and what to do. Who
// catches one decides by its code; only a face puts it into words, `cavum: where: what; what to do`
// on the command line.
#pragma once

#include <cstddef>
#include <optional>
#include <stdexcept>
#include <string>
#include <string_view>
#include <type_traits>
#include <utility>

#include "engine/base/message.h"
#include "engine/base/named_enum.h"

namespace cavum {

/// Which error: a value of the enum (CAVUM_NAMED_ENUM) of the room that throws it. Two are equal
/// when both enum and value are.
class ErrorCode {
 public:
  template <class E>
  requires std::is_enum_v<E>
  constexpr ErrorCode(E code) noexcept
      : names_(k_names<E>.data()),
        value_(static_cast<std::size_t>(code)) {}  // NOLINT(google-explicit-constructor)
  friend constexpr bool operator==(const ErrorCode&, const ErrorCode&) = default;
  /// As other programs know it.
  [[nodiscard]] constexpr std::string_view name() const noexcept { return names_[value_]; }
  /// As a value of E, where it is one.
  template <class E>
  [[nodiscard]] constexpr std::optional<E> as() const noexcept {
    return names_ == k_names<E>.data() ? std::optional(static_cast<E>(value_)) : std::nullopt;
  }

 private:
  template <class E>
  static constexpr auto k_names = names_of(E{});
  const std::string_view* names_;
  std::size_t value_;
};

/// `error`: one that nobody has to tell from others.
#define CAVUM_GENERAL_ERRORS(ERROR) ERROR(error)
CAVUM_NAMED_ENUM(General, CAVUM_GENERAL_ERRORS)

/// Unusable input or environment. `what()` is `where: problem; advice` in English, for logs.
class Error : public std::runtime_error {
 public:
  /// `where` is a file, a line of it, an option; `problem` and `advice` are sentences without their
  /// full stop.
  Error(ErrorCode code, Message where, Message problem, Message advice)
      : std::runtime_error(english_text(msg("{}: {}; {}", where, problem, advice))),
        code_(code),
        where_(std::move(where)),
        problem_(std::move(problem)),
        advice_(std::move(advice)) {}
  /// A place that is a text is a name.
  Error(const std::string& where, Message problem, Message advice)
      : Error(Message(Name{where}), std::move(problem), std::move(advice)) {}
  Error(const char* where, Message problem, Message advice)
      : Error(Message(Name{where}), std::move(problem), std::move(advice)) {}
  Error(Message where, Message problem, Message advice)
      : Error(General::error, std::move(where), std::move(problem), std::move(advice)) {}

  [[nodiscard]] ErrorCode code() const noexcept { return code_; }
  [[nodiscard]] const Message& where() const noexcept { return where_; }
  [[nodiscard]] const Message& problem() const noexcept { return problem_; }
  [[nodiscard]] const Message& advice() const noexcept { return advice_; }
  /// Where it is a place in a file: that; else null.
  [[nodiscard]] const FileLocation* file_place() const noexcept {
    return where_.values().size() == 1
               ? std::get_if<FileLocation>(static_cast<const Value::variant*>(&where_.values()[0]))
               : nullptr;
  }
  [[nodiscard]] Message message() const { return msg("{}: {}; {}", where_, problem_, advice_); }
  /// For what says itself what to do.
  [[nodiscard]] Message where_and_problem() const { return msg("{}: {}", where_, problem_); }

 private:
  ErrorCode code_;
  Message where_, problem_, advice_;
};

}  // namespace cavum
