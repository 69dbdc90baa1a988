#include "engine/session/damage.h"

#include <nlohmann/json.hpp>

#include "engine/base/message_json.h"

namespace cavum {

std::vector<Message> words_of(const Damages& damages) {
  std::vector<Message> out;
  for (const Damage& d : damages) out.push_back(d.what);
  return out;
}

void to_json(nlohmann::json& json, const Damage& damage) { json = fact_json(name_in(damage.kind), damage.what); }

}  // namespace cavum
