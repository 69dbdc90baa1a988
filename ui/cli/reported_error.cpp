#include "ui/cli/reported_error.h"

#include <nlohmann/json.hpp>

#include "engine/base/message_json.h"
#include "ui/parts/print_json.h"
#include "ui/parts/say.h"

namespace cavum::ui {
namespace {

using Json = nlohmann::ordered_json;

Json where_json(const Error& error) {
  if (error.file_place() == nullptr) return {{"name", error.where()}};
  Json place = {{"file", error.file_place()->file}};
  if (error.file_place()->line > 0) place["line"] = error.file_place()->line;
  if (error.file_place()->column > 0) place["column"] = error.file_place()->column;
  return place;
}

Json to_json(const Error& error) {
  return {{"code", error.code().name()},
          {"where", where_json(error)},
          {"what", error.problem()},
          {"values", values_json(error.problem())},
          {"advice", error.advice()}};
}

}  // namespace

void report_errors(const std::vector<Error>& errors, bool as_json) {
  for (const Error& e : errors) say_error(e.message());
  if (!as_json) return;
  Json j = {{"error", to_json(errors.at(0))}};
  if (errors.size() > 1)
    for (const Error& e : errors) j["errors"].push_back(to_json(e));
  print_json(j);
}

}  // namespace cavum::ui
