// Where an input is wrong: a file or an option by its name, as it stands in every language, or a
// place in words (msg).
#pragma once

#include <string>
#include <utility>

#include "engine/base/message.h"

namespace cavum {

struct Where : Message {
  Where() = default;
  Where(const char* name) : Message(Name{name}) {}
  Where(std::string name)
      : Message(Name{std::move(name)}) {}                    // NOLINT(google-explicit-constructor)
  Where(Name name) : Message(std::move(name)) {}             // NOLINT(google-explicit-constructor)
  Where(FileLocation place) : Message(std::move(place)) {}   // NOLINT(google-explicit-constructor)
  Where(Message in_words) : Message(std::move(in_words)) {}  // NOLINT(google-explicit-constructor)
};

}  // namespace cavum
