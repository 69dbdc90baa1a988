#include "engine/session/damage.h"

#include <nlohmann/json.hpp>

namespace cavum {

std::vector<Message> words_of(const Damages& damages) {
  std::vector<Message> out;
  for (const Damage& d : damages) out.push_back(d.message());
  return out;
}

void to_json(nlohmann::json& json, const Damage& damage) {
  json = fact_json(rows_of(damage.kind), static_cast<std::size_t>(damage.kind), damage.values,
                   damage.message());
}

}  // namespace cavum
