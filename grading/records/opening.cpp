#include "grading/records/opening.h"

#include "engine/base/error.h"
#include "engine/base/hash.h"
#include "engine/base/json_fields.h"
#include "engine/base/json_reader.h"
#include "grading/records/ledger_key.h"

namespace cavum::records {

using nlohmann::json;

Opening make_opening(const json& value) {
  Opening o{{}, json{{"salt", random_hex(16)}, {"value", value}}.dump(), value};
  o.sha256 = to_hex(cavum::sha256(o.text));
  return o;
}

json opened_value(const std::string& text, const std::string& sha256, const Where& where) {
  if (to_hex(cavum::sha256(text)) != sha256)
    throw Error(where, msg("is not what was bound by its hash"), msg("use an intact copy"));
  const json j = parse_json(text, where);
  if (!j.is_object() || !j.contains("value") || text_in(j, "salt").size() != 32)
    throw Error(where, msg("is no opening: a salt and a value"), msg("use an intact copy"));
  return j.at("value");
}

}  // namespace cavum::records
