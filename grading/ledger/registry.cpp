#include "grading/ledger/registry.h"

#include <map>
#include <set>

#include "engine/base/json_fields.h"

namespace cavum {

using nlohmann::json;

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
        for (auto& other : r.sessions)  // two endings of one exam: the one that was filed as sound may be the wrong one
          if (!s.nonce.empty() && other.nonce == s.nonce && other.chain_sha256 != s.chain_sha256) {
            other.contested_by.push_back(s.seq);
            s.contested_by.push_back(other.seq);
          }
        by_seq[e.seq] = r.sessions.size();
        r.sessions.push_back(std::move(s));
      } else if (e.kind == "regrade") {
        FiledSession& s = r.sessions.at(by_seq.at(require_whole<std::uint64_t>(e.body, "session", "regrade")));
        s.result = e.body.at("result");
        s.result_seq = e.seq;
        s.regrades.push_back({e.seq, e.utc_ns, text_in(e.body, "reason"), documents_of(e), s.result});
        s.released = false;  // a new result waits for its own release, and the old one stands until then
      } else if (e.kind == "release") {
        for (const auto& seq : e.body.at("results")) {
          bool found = false;
          for (auto& s : r.sessions)
            if (s.result_seq == seq.get<std::uint64_t>()) s.released = found = true, s.shown = s.result, s.shown_seq = s.result_seq;
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

}  // namespace cavum
