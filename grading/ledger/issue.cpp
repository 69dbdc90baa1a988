#include "grading/ledger/issue.h"

#include <fmt/core.h>

#include <algorithm>
#include <set>

#include "engine/base/csv.h"
#include "engine/base/error.h"
#include "engine/base/text.h"
#include "grading/ledger/candidate_id.h"
#include "grading/ledger/registry.h"

namespace cavum::ledger {

Ticket promise(const scenarios::ExamSetup& setup, const LedgerContent& ledger, std::int64_t not_before_utc_ns, std::int64_t not_after_utc_ns) {
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

std::string issue(Ledger& ledger, Ticket ticket, const std::string& candidate, Another another) {
  ticket.candidate = candidate;
  ticket.nonce = random_hex(16);
  std::string text = sign_ticket(ticket, ledger.key());
  ledger.append("ticket", [&](const LedgerContent&) {
    const Registry& registry = ledger.registry();  // as it is under the lock
    const IssuedTicket* live = registry.live_ticket(candidate, ticket.exam, read_clocks().utc_ns);
    if (live != nullptr && another == Another::refuse)
      throw TicketIsLive("candidate " + candidate,
                         fmt::format("has a ticket for {} that is good until {} (entry {})", one_line(ticket.exam),
                                     utc_text(live->ticket.not_after_utc_ns), live->seq),
                         "cancel it with `cavum ledger cancel`, or add --another");
    return without_grant(text);
  });
  return text;
}

const LedgerEntry& cancel_ticket(Ledger& ledger, std::uint64_t seq, const std::string& reason) {
  constexpr std::size_t k_longest = 2000;
  if (reason.empty() || reason.size() > k_longest || !is_plain_text(reason))
    throw Error("--reason", "is no line of text of at most 2000 bytes", "say why, without names: it is kept for ever");
  return ledger.append("cancel", [&](const LedgerContent& now) -> nlohmann::json {
    const Registry registry = read_registry(now);
    const auto t = std::find_if(registry.tickets.begin(), registry.tickets.end(), [&](const IssuedTicket& issued) { return issued.seq == seq; });
    const std::string where = fmt::format("--ticket {}", seq);
    if (t == registry.tickets.end()) throw Error(where, "is no ticket's entry", "see `cavum ledger tickets`");
    if (t->used_by)
      throw Error(where, fmt::format("was used: its exam is filed as entry {}", *t->used_by),
                  "there is nothing left to cancel: what becomes of its result is decided with `cavum ledger release`");
    if (t->cancelled_by) throw Error(where, fmt::format("was cancelled before, by entry {}", *t->cancelled_by), "nothing is left to do");
    return {{"ticket", seq}, {"reason", reason}};
  });
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
    const std::string at = fmt::format("{}:{}", where, rows[i].line);
    if (f[id].empty()) throw Error(at, "has no id", "give each candidate the school's own number or address");
    require_candidate_id(at + ": id", f[id]);
    if (name < f.size()) require_candidate_id(at + ": name", f[name]);
    if (!seen.insert(f[id]).second) throw Error(at, fmt::format("'{}' stands there a second time", f[id]), "leave one of them");
    people.push_back({f[id], name < f.size() ? f[name] : ""});
  }
  if (people.empty()) throw Error(where, "names no candidate", "write one on each line below the heading");
  return people;
}

}  // namespace cavum::ledger
