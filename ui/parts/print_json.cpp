#include "ui/parts/print_json.h"

#include <iostream>
#include <nlohmann/json.hpp>

#include "engine/base/text.h"

namespace cavum::ui {
namespace {

template <class Json>
void print_any(const Json& json) {
  std::cout << terminal_json(json.dump(2, ' ', false, Json::error_handler_t::replace)) << "\n";
}

}  // namespace

void print_json(const nlohmann::json& json) { print_any(json); }
void print_json(const nlohmann::ordered_json& json) { print_any(json); }

}  // namespace cavum::ui
