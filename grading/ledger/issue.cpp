#include "grading/ledger/issue.h"

#include <algorithm>
#include <set>

#include "engine/base/error.h"
#include "engine/base/json_reader.h"
#include "grading/ledger/candidate_id.h"
#include "grading/ledger/csv.h"

namespace cavum {

Ticket promise(const ExamSetup& setup, const LedgerContent& ledger, std::int64_t not_before_utc_ns, std::int64_t not_after_utc_ns) {
  Ticket t;
  t.ledger = ledger.id;
  t.public_key = ledger.public_key;
  t.exam = setup.scenario.id;
  t.not_before_utc_ns = not_before_utc_ns;
  t.not_after_utc_ns = not_after_utc_ns;
  t.artifacts = examined_artifacts(setup.session);
  t.grant = accommodations_in(setup.session);
  return t;
}

std::string issue(Ledger& ledger, Ticket ticket, const std::string& candidate) {
  ticket.candidate = candidate;
  ticket.nonce = random_hex(16);
  std::string text = sign_ticket(ticket, ledger.key());
  ledger.append("ticket", [&](const LedgerContent&) { return parse_json(text, "the ticket"); });
  return text;
}

std::vector<Person> parse_people(const std::string& text, const std::string& where) {
  const auto rows = parse_csv(text, where);
  const auto column = [&](const char* name) {
    if (rows.empty()) return std::size_t{0};
    return static_cast<std::size_t>(std::find(rows[0].fields.begin(), rows[0].fields.end(), name) - rows[0].fields.begin());
  };
  const std::size_t id = column("id"), name = column("name");
  if (rows.empty() || id == rows[0].fields.size()) throw Error(where + ":1", "is no heading of candidates", "begin with id,name");
  std::vector<Person> people;
  std::set<std::string> seen;
  for (std::size_t i = 1; i < rows.size(); ++i) {
    const auto& f = rows[i].fields;
    const std::string at = where + ":" + std::to_string(rows[i].line);
    if (f[id].empty()) throw Error(at, "has no id", "give each candidate the school's own number or address");
    require_candidate_id(at + ": id", f[id]);
    if (name < f.size()) require_candidate_id(at + ": name", f[name]);
    if (!seen.insert(f[id]).second) throw Error(at, "'" + f[id] + "' stands there a second time", "leave one of them");
    people.push_back({f[id], name < f.size() ? f[name] : ""});
  }
  if (people.empty()) throw Error(where, "names no candidate", "write one on each line below the heading");
  return people;
}

}  // namespace cavum
