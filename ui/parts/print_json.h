// The one way a verb prints JSON.
#pragma once

#include <iostream>
#include <nlohmann/json.hpp>

#include "engine/base/message_json.h"
#include "engine/base/text.h"

namespace cavum::ui {

/// One object on standard output. A file name that is no UTF-8 is shown with replacement characters, for JSON has no other text; what would command a
/// terminal is escaped.
template <class Json>
void print_json(const Json& json) {
  std::cout << terminal_json(json.dump(2, ' ', false, Json::error_handler_t::replace)) << "\n";
}

}  // namespace cavum::ui
