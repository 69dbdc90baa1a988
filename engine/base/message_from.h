// What an exception says, in the reader's language where it is one of ours; what the system or a
// library says is a name.
#pragma once

#include <exception>

#include "engine/base/error.h"

namespace cavum {

[[nodiscard]] inline Message message_from(const std::exception& wrong) {
  const auto* error = dynamic_cast<const Error*>(&wrong);
  return error != nullptr ? error->message() : Message(cavum::Name{wrong.what()});
}

}  // namespace cavum
