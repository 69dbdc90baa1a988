#include "grading/records/finding.h"

#include "engine/base/json_struct.h"

namespace cavum::records {

using nlohmann::json;

Finding Finding::in_entry(std::uint64_t seq) const {
  Finding out = *this;
  out.entry = seq;
  return out;
}

Message Finding::message() const {
  const Message sentence =
      entry ? msg("entry {}: {}", *entry, TableFact::message()) : TableFact::message();
  return where.empty() ? sentence : msg("{}: {}", where, sentence);
}

std::vector<Message> words_of(const Findings& findings) {
  std::vector<Message> out;
  for (const Finding& f : findings) out.push_back(f.message());
  return out;
}

Findings named(const std::string& where, Findings findings) {
  for (Finding& f : findings) f.where = where;
  return findings;
}

void append(Findings& to, const Findings& more) { to.insert(to.end(), more.begin(), more.end()); }
void append(Findings& to, const Damages& more) { to.insert(to.end(), more.begin(), more.end()); }

void to_json(json& j, const Finding& f) {
  j = fact_json(rows_of(f.kind), static_cast<std::size_t>(f.kind), f.values, f.message());
  if (f.entry) j["entry"] = *f.entry;
  if (!f.where.empty()) j["where"] = f.where;
}

json write_json(const Finding& f) {
  json out = encode(f.row(), kept(f.values));
  if (f.entry) out["entry"] = *f.entry;
  if (!f.where.empty()) out["where"] = f.where;
  return out;
}

void read_json(const json& from, const JsonLocation& at, Finding& f) {
  json fact;
  auto all = json_inside([&](auto& of) {
    of("kind", fact["kind"]), of("values", fact["values"]);
    of("entry", f.entry), of("where", f.where, JsonField::sparse);
  });
  read_json_value(from, at, all);
  try {
    static_cast<TableFact<FindingKind>&>(f) = decode_fact<FindingKind>(fact);
  } catch (const std::invalid_argument& e) {
    at.refuse(msg("is no finding: {}", e.what()));
  }
}

}  // namespace cavum::records
