#include "grading/ledger/claims.h"

#include <algorithm>

#include "engine/base/error.h"
#include "engine/base/json_fields.h"
#include "engine/base/json_reader.h"
#include "engine/session/station_check.h"

namespace cavum {
namespace {

using nlohmann::json;

std::string ticket_text_in(const SessionSetup& setup) {
  for (const auto& [key, value] : setup.notes)
    if (key == k_ticket_note) return value;
  return {};
}

constexpr std::int64_t k_patience_ns = 300'000'000'000;  // by which the clocks of station and ledger may differ

/// Times that contradict one another, and a gap that changed who or what sat the exam.
std::vector<std::string> check_course(const SessionReader& session, const SessionSetup& setup, const std::optional<IssuedTicket>& ticket,
                                      std::int64_t issued_utc_ns) {
  std::vector<std::string> findings;
  const std::int64_t begun = session.created().utc_ns, closed = session.seal()->clocks.utc_ns, now = read_clocks().utc_ns;
  if (closed > now + k_patience_ns) findings.push_back("by the station's clock the exam ended on " + utc_text(closed) + ", after it was handed in");
  if (ticket && begun < issued_utc_ns - k_patience_ns)
    findings.push_back("by the station's clock the exam began on " + utc_text(begun) + ", before its ticket was issued");
  for (const auto& e : session.events()) {
    const json detail = e.kind == "gap" ? parse_json_or_null(e.detail_json) : json();
    if (!detail.is_object()) continue;
    const std::int64_t resumed = whole_in(detail, "resumed_utc_ns");
    if (ticket && resumed > ticket->ticket.not_after_utc_ns)
      findings.push_back("the exam was taken up again on " + utc_text(resumed) + ", when its ticket was no longer good");
    const std::string source = text_in(member_of(detail, "source"), "device");
    if (!source.empty() && source != setup.device)
      findings.push_back("the exam was begun with " + setup.device + ", and taken up again with " + source);
  }
  return findings;
}

/// True for what looks like a pseudonym of ours.
bool is_pseudonym(const std::string& name) { return name.size() == 16 && name.starts_with("C-") && name[6] == '-' && name[11] == '-'; }

/// Where a recording was taken up again at or after this tick: "taken up again at tick N", or nothing.
std::string resumed_from(const SessionReader& session, std::int64_t tick) {
  for (const auto& e : session.events())
    if (e.kind == "gap" && e.tick >= tick) return ", taken up again at tick " + std::to_string(e.tick);
  return {};
}

/// How far a session and one that was filed with the same ticket are one recording: an exam that was ended twice is so up to where one was cut back.
std::string other_ending(const SessionReader& session, std::uint64_t seq, const std::string& filed_path) {
  const std::string entry = "entry " + std::to_string(seq);
  try {
    const SessionReader filed(filed_path);
    const auto &mine = session.chunks(), &theirs = filed.chunks();
    std::size_t same = 0;
    while (same < std::min(mine.size(), theirs.size()) && mine[same].sha256 == theirs[same].sha256) ++same;
    if (same == 0) return entry + " holds another recording";
    const std::int64_t tick = mine[same - 1].first_tick + mine[same - 1].ticks;
    return entry + " holds another ending of the same recording: both are the same up to tick " + std::to_string(tick) + "; " + entry +
           " ends at tick " + std::to_string(filed.ticks()) + resumed_from(filed, tick) + ", this one at tick " + std::to_string(session.ticks()) +
           resumed_from(session, tick);
  } catch (const std::exception& e) {
    return entry + ", whose file cannot be compared: " + e.what();
  }
}

}  // namespace

std::string ticket_nonce_in(const SessionSetup& setup) {
  const std::string text = ticket_text_in(setup);
  if (text.empty()) return {};
  const json j = parse_json_or_null(text);
  return text_in(member_of(j, "ticket"), "nonce");
}

std::string simulated_by(const SessionReader& session, const SessionSetup& setup) {
  for (const auto& [key, value] : setup.notes)
    if (key == "operator") return value;
  for (const auto& e : session.events()) {
    if (e.kind != "gap") continue;
    const json detail = parse_json_or_null(e.detail_json);
    if (const auto& by = member_of(member_of(detail, "source"), "operator"); !by.is_null()) return by.is_string() ? by.get<std::string>() : by.dump();
  }
  return {};
}

bool is_result(const json& r) {
  const auto number = [](const json& j, const char* key) { return member_of(j, key).is_number(); };
  const auto text = [](const json& j, const char* key) { return member_of(j, key).is_string(); };
  const json& score = member_of(r, "score");
  const json& criteria = member_of(r, "criteria");
  if (!text(r, "verdict") || !number(score, "points") || !number(score, "max") || !criteria.is_array()) return false;
  return std::all_of(criteria.begin(), criteria.end(), [&](const json& c) {
    return text(c, "id") && text(c, "metric") && text(c, "unit") && text(c, "reason") && number(c, "points") && number(c, "max") &&
           c.contains("value");
  });
}

std::vector<std::string> check_claims(const LedgerContent& content, const SessionReader& session, const FilingOptions& options,
                                      const LedgerPlaces* filed) {
  if (!session.closed()) return {"the session was never closed"};
  const SessionSetup setup = session.setup();
  const std::string chain_sha256 = to_hex(session.seal()->chain_sha256), nonce = ticket_nonce_in(setup);
  std::vector<std::string> findings;
  if (!is_result(parse_json_or_null(session.result_json(), k_json_part))) findings.emplace_back("the session's result is none that grading writes");
  for (auto& f : check_stations(session)) findings.push_back(std::move(f));
  const Registry registry = read_registry(content);
  for (const auto& s : registry.sessions)
    if (s.chain_sha256 == chain_sha256) findings.push_back("this session was submitted before: entry " + std::to_string(s.seq));
  const std::string text = ticket_text_in(setup);
  if (const std::string by = simulated_by(session, setup); !by.empty() && !options.simulated)
    findings.push_back("no candidate sat this exam, but the simulated operator '" + by + "' (--simulated files it as that)");
  if (text.empty()) {
    if (!options.without_ticket) findings.emplace_back("the session holds no ticket: nobody promised this exam");
    if (is_pseudonym(setup.candidate)) findings.emplace_back("the session bears a pseudonym, and no ticket that it was given by");
    for (auto& f : check_course(session, setup, {}, 0)) findings.push_back(std::move(f));
    return findings;
  }
  try {
    const Ticket ticket = parse_ticket(text, content.public_key, "the session's ticket");
    for (auto& f : check_ticket(ticket, setup, session.created().utc_ns)) findings.push_back(std::move(f));
    if (ticket.ledger != content.id) findings.emplace_back("the ticket was issued by another ledger");
    bool issued = false;
    for (const auto& t : registry.tickets) {
      if (t.ticket.nonce != nonce) continue;
      issued = true;
      for (auto& f : check_course(session, setup, t, content.entries.at(t.seq).utc_ns)) findings.push_back(std::move(f));
      if (t.used_by) {
        const auto other =
            std::find_if(registry.sessions.begin(), registry.sessions.end(), [&](const FiledSession& s) { return s.seq == *t.used_by; });
        findings.push_back("the ticket was used before: " +
                           (filed == nullptr || other == registry.sessions.end() || other->chain_sha256 == chain_sha256
                                ? "entry " + std::to_string(*t.used_by)
                                : other_ending(session, *t.used_by, filed->session(other->file_sha256))));
      }
    }
    if (!issued) findings.emplace_back("the ledger has not issued this ticket");
  } catch (const Error& e) {
    findings.emplace_back(e.what());
  }
  return findings;
}

}  // namespace cavum
