#include "grading/ledger/filing.h"

#include <algorithm>
#include <filesystem>
#include <map>
#include <set>

#include "engine/base/file.h"
#include "engine/base/json_fields.h"
#include "engine/session/session_reader.h"
#include "engine/session/verify.h"
#include "scenarios/parse.h"

namespace cavum {
namespace {

using nlohmann::json;

std::string ticket_text_in(const SessionSetup& setup) {
  for (const auto& [key, value] : setup.notes)
    if (key == k_ticket_note) return value;
  return {};
}

constexpr std::int64_t k_patience_ns = 300'000'000'000;  // by which the clocks of station and ledger may differ

/// Operator that moved the stylus, in the beginning or after a gap; empty for a hand.
std::string simulated_by(const SessionReader& session, const SessionSetup& setup) {
  for (const auto& [key, value] : setup.notes)
    if (key == "operator") return value;
  for (const auto& e : session.events()) {
    if (e.kind != "gap") continue;
    const json detail = json::parse(e.detail_json, nullptr, false);
    if (const auto& by = member_of(member_of(detail, "source"), "operator"); !by.is_null()) return by.is_string() ? by.get<std::string>() : by.dump();
  }
  return {};
}

/// Times that contradict one another, and a gap that changed who or what sat the exam.
std::vector<std::string> check_course(const SessionReader& session, const SessionSetup& setup, const std::optional<IssuedTicket>& ticket,
                                      std::int64_t issued_utc_ns) {
  std::vector<std::string> findings;
  const std::int64_t begun = session.created().utc_ns, closed = session.seal()->clocks.utc_ns, now = read_clocks().utc_ns;
  if (closed > now + k_patience_ns) findings.push_back("by the station's clock the exam ended on " + utc_text(closed) + ", after it was handed in");
  if (ticket && begun < issued_utc_ns - k_patience_ns)
    findings.push_back("by the station's clock the exam began on " + utc_text(begun) + ", before its ticket was issued");
  for (const auto& e : session.events()) {
    const json detail = e.kind == "gap" ? json::parse(e.detail_json, nullptr, false) : json();
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

/// True for a result as grading writes it: everything that exports and figures of a class read is there, each of its type.
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

/// Ticket and claims of a session against the entries so far.
std::vector<std::string> check_claims(const LedgerContent& content, const SessionReader& session, const SessionSetup& setup,
                                      const std::string& chain_sha256, const std::string& nonce, const FilingOptions& options) {
  std::vector<std::string> findings;
  if (!is_result(json::parse(session.result_json(), nullptr, false))) findings.emplace_back("the session's result is none that grading writes");
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
      if (t.used_by) findings.push_back("the ticket was used before: entry " + std::to_string(*t.used_by));
    }
    if (!issued) findings.emplace_back("the ledger has not issued this ticket");
  } catch (const Error& e) {
    findings.emplace_back(e.what());
  }
  return findings;
}

std::string nonce_in(const SessionSetup& setup) {
  const std::string text = ticket_text_in(setup);
  if (text.empty()) return {};
  const json j = json::parse(text, nullptr, false);
  return text_in(member_of(j, "ticket"), "nonce");
}

}  // namespace

Registry read_registry(const LedgerContent& content) {
  Registry r;
  std::map<std::uint64_t, std::size_t> by_seq;  // sessions
  std::map<std::string, std::size_t> by_nonce;
  std::set<std::string> chains;
  for (const auto& e : content.entries) {
    const auto say = [&](const std::string& what) { r.findings.push_back("entry " + std::to_string(e.seq) + ": " + what); };
    try {
      if (e.kind == "ticket") {
        IssuedTicket t{e.seq, parse_ticket(e.body.dump(), content.public_key, "ticket"), {}};
        if (!by_nonce.emplace(t.ticket.nonce, r.tickets.size()).second) say("a ticket with a number that another one has");
        r.tickets.push_back(std::move(t));
      } else if (e.kind == "session") {
        FiledSession s;
        s.seq = s.result_seq = e.seq;
        s.received_utc_ns = e.utc_ns;
        s.file_sha256 = e.body.at("file_sha256");
        s.chain_sha256 = e.body.at("chain_sha256");
        s.candidate = e.body.at("candidate");
        s.scenario_id = e.body.at("scenario_id");
        s.station_key = e.body.at("station_key");
        s.nonce = e.body.at("nonce");
        s.result = e.body.at("result");
        s.simulated = e.body.at("simulated");
        s.findings = e.body.at("findings").get<std::vector<std::string>>();
        if (!chains.insert(s.chain_sha256).second && s.findings.empty()) say("a session that was entered before");
        if (!s.nonce.empty() && s.findings.empty()) {
          const auto t = by_nonce.find(s.nonce);
          if (t == by_nonce.end())
            say("a session with a ticket that was not issued");
          else if (r.tickets[t->second].used_by)
            say("a ticket that was used before");
          else
            r.tickets[t->second].used_by = e.seq;
        }
        by_seq[e.seq] = r.sessions.size();
        r.sessions.push_back(std::move(s));
      } else if (e.kind == "regrade") {
        FiledSession& s = r.sessions.at(by_seq.at(require_whole<std::uint64_t>(e.body, "session", "regrade")));
        s.result = e.body.at("result");
        s.result_seq = e.seq;
        s.released = false;  // a new result waits for its own release, and the old one stands until then
      } else if (e.kind == "release") {
        for (const auto& seq : e.body.at("results")) {
          bool found = false;
          for (auto& s : r.sessions)
            if (s.result_seq == seq.get<std::uint64_t>()) s.released = found = true, s.shown = s.result;
          if (!found) say("releases a result that does not count");
        }
      } else if (e.kind != "init" && e.kind != "forget") {
        say("is of a kind that this version does not know: '" + e.kind + "'");
      }
    } catch (const std::out_of_range&) {
      say("speaks of a session that is not there");
    } catch (const std::exception& error) {
      say(error.what());
    }
  }
  return r;
}

std::vector<std::string> check_claims(const LedgerContent& content, const SessionReader& session, const FilingOptions& options) {
  if (!session.closed()) return {"the session was never closed"};
  const SessionSetup setup = session.setup();
  return check_claims(content, session, setup, to_hex(session.seal()->chain_sha256), nonce_in(setup), options);
}

Filing file_session(Ledger& ledger, const std::string& path, const FilingOptions& options) {
  Filing out;
  ledger.refresh();
  const VerifyReport report = verify_session(path);
  const SessionReader session(path);
  if (!report.closed)
    throw Error(path, "was never closed", "resume the exam, or close it as it stands: `cavum exam --resume --end --out " + path + "`");
  out.findings = report.findings;
  const Bytes bytes = read_file(path);
  const SessionSetup setup = session.setup();
  const std::string file_sha256 = to_hex(sha256(bytes)), chain = to_hex(session.seal()->chain_sha256), nonce = nonce_in(setup);
  const std::int64_t begun = session.created().utc_ns;

  const auto refused = [&] { return !out.findings.empty() && !options.with_findings; };
  const auto claims = [&](const LedgerContent& c) { return check_claims(c, session, setup, chain, nonce, options); };
  for (auto& f : claims(ledger.content())) out.findings.push_back(std::move(f));
  if (refused()) return out;

  std::filesystem::create_directories(ledger.places().folder + "/sessions");
  write_file(ledger.places().session(file_sha256), bytes);
  std::string scenario_id;
  try {
    scenario_id = parse_scenario(setup.scenario_toml, "scenario.toml").id;
  } catch (const std::exception&) {
    scenario_id = "";  // a damaged session filed for an appeal
  }
  struct Refused {};
  try {
    out.seq = ledger
                  .append("session",
                          [&](const LedgerContent& now) -> json {
                            // again under the lock: somebody may have used the ticket meanwhile
                            auto late = claims(now);
                            if (!late.empty() && out.findings.empty()) out.findings = std::move(late);
                            if (refused()) throw Refused();
                            json result = json::parse(session.result_json(), nullptr, false);
                            return {{"candidate", setup.candidate},
                                    {"chain_sha256", chain},
                                    {"file_sha256", file_sha256},
                                    {"findings", out.findings},
                                    {"begun_utc_ns", begun},
                                    {"closed_utc_ns", session.seal()->clocks.utc_ns},
                                    {"nonce", nonce},
                                    {"simulated", simulated_by(session, setup)},
                                    {"result", is_result(result) ? result : json(nullptr)},
                                    {"scenario_id", scenario_id},
                                    {"station_key", report.station_key},
                                    {"ticks", report.ticks}};
                          })
                  .seq;
  } catch (const Refused&) {
    return out;
  }
  return out;
}

LedgerCheck check_ledger(const LedgerPlaces& places, bool replay) {
  const LedgerContent content = read_ledger(places);
  LedgerCheck out{content.findings, content.remarks};
  auto& findings = out.findings;
  const Registry registry = read_registry(content);
  findings.insert(findings.end(), registry.findings.begin(), registry.findings.end());
  for (const auto& s : registry.sessions) {
    const std::string name = "entry " + std::to_string(s.seq) + " (session of " + s.candidate + ")", path = places.session(s.file_sha256);
    if (!std::filesystem::exists(path)) {
      findings.push_back(name + ": its file is gone: " + path);
      continue;
    }
    if (to_hex(sha256(read_file(path))) != s.file_sha256) {
      findings.push_back(name + ": its file was changed: " + path);
      continue;
    }
    if (replay && s.findings.empty())
      for (const auto& f : verify_session(path).findings) findings.push_back(name + ": " + f);
  }
  std::error_code none;
  std::set<std::string> filed;
  for (const auto& s : registry.sessions) filed.insert(s.file_sha256 + ".cavum");
  for (const auto& f : std::filesystem::directory_iterator(places.folder + "/sessions", none))
    if (!filed.contains(f.path().filename().string())) out.remarks.push_back(f.path().string() + ": belongs to no entry");
  return out;
}

}  // namespace cavum
