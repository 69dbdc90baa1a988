// The one way in which bad input is reported: which error it is, where, what, and what to do. Who catches one decides by its code; only a face puts
// it into words, `cavum: where: what; what to do` on the command line.
#pragma once

#include <optional>
#include <stdexcept>
#include <string>
#include <type_traits>
#include <utility>

#include "engine/base/message.h"

namespace cavum {

/// Which error: a value of the enum of the room that throws it. Two are equal when both enum and value are.
class ErrorCode {
 public:
  template <class E>
  requires std::is_enum_v<E>
  constexpr ErrorCode(E code) noexcept : room_(&k_room<E>), value_(static_cast<int>(code)) {}  // NOLINT(google-explicit-constructor)
  friend constexpr bool operator==(const ErrorCode&, const ErrorCode&) = default;
  /// As a value of E, where it is one.
  template <class E>
  [[nodiscard]] constexpr std::optional<E> as() const noexcept {
    return room_ == &k_room<E> ? std::optional(static_cast<E>(value_)) : std::nullopt;
  }

 private:
  template <class E>
  static constexpr char k_room{};
  const char* room_;
  int value_;
};

/// Of an error that nobody has to tell from others.
enum class General { error };

/// Unusable input or environment. `what()` is `where: problem; advice` in English, for logs.
class Error : public std::runtime_error {
 public:
  /// `where` is a file, a line of it, an option; `problem` and `advice` are sentences without their full stop.
  Error(ErrorCode code, Message where, Message problem, Message advice)
      : std::runtime_error(english_text(msg("{}: {}; {}", where, problem, advice))),
        code_(code),
        where_(std::move(where)),
        problem_(std::move(problem)),
        advice_(std::move(advice)) {}
  /// A place that is a text is a name.
  Error(const std::string& where, Message problem, Message advice) : Error(Message(Name{where}), std::move(problem), std::move(advice)) {}
  Error(const char* where, Message problem, Message advice) : Error(Message(Name{where}), std::move(problem), std::move(advice)) {}
  Error(Message where, Message problem, Message advice) : Error(General::error, std::move(where), std::move(problem), std::move(advice)) {}

  [[nodiscard]] ErrorCode code() const noexcept { return code_; }
  [[nodiscard]] const Message& where() const noexcept { return where_; }
  [[nodiscard]] const Message& problem() const noexcept { return problem_; }
  [[nodiscard]] const Message& advice() const noexcept { return advice_; }
  /// Where it is a place in a file: that; else null.
  [[nodiscard]] const FilePlace* file_place() const noexcept {
    return where_.values().size() == 1 ? std::get_if<FilePlace>(static_cast<const Value::variant*>(&where_.values()[0])) : nullptr;
  }
  [[nodiscard]] Message message() const { return msg("{}: {}; {}", where_, problem_, advice_); }
  /// For what says itself what to do.
  [[nodiscard]] Message where_and_problem() const { return msg("{}: {}", where_, problem_); }

 private:
  ErrorCode code_;
  Message where_, problem_, advice_;
};

}  // namespace cavum
