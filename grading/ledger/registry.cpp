#include "grading/ledger/registry.h"

#include <algorithm>
#include <map>
#include <set>

#include "engine/base/json_fields.h"
#include "engine/base/json_reader.h"

namespace cavum {

using nlohmann::json;

namespace {

/// The result of an entry, which exports rely on: null, or in the shape that grading gives it. Throws Error for another one.
json result_in(const LedgerEntry& e) {
  const json& result = e.body.at("result");
  if (result.is_null()) return result;
  const auto text = [](const json& j, const char* name) { return j.contains(name) && j[name].is_string(); };
  const auto number = [](const json& j, const char* name) { return j.contains(name) && j[name].is_number(); };
  const auto criterion = [&](const json& c) {
    return c.is_object() && text(c, "id") && text(c, "metric") && text(c, "unit") && (!c.contains("reason") || text(c, "reason")) &&
           number(c, "points") && number(c, "max") && c.contains("value") && (c["value"].is_null() || c["value"].is_number());
  };
  const json &score = member_of(result, "score"), &criteria = member_of(result, "criteria");
  const bool sound = result.is_object() && text(result, "verdict") && score.is_object() && number(score, "points") && number(score, "max") &&
                     (!score.contains("pass_percent") || number(score, "pass_percent")) &&
                     (!score.contains("borderline_percent") || number(score, "borderline_percent")) && criteria.is_array() &&
                     std::all_of(criteria.begin(), criteria.end(), criterion);
  if (!sound) throw Error("result", "is none as grading writes it", "use an intact copy");
  return result;
}

bool contest_each_other(const FiledSession& a, const FiledSession& b) {
  return std::find(a.contested_by.begin(), a.contested_by.end(), b.seq) != a.contested_by.end();
}

/// What the entry `seq` releases, `results`: of several endings of one exam one, and once a person has chosen, that one.
void release(Registry& r, std::uint64_t seq, std::int64_t utc_ns, const std::set<std::uint64_t>& results) {
  for (auto& s : r.sessions) {
    if (!results.contains(s.result_seq)) continue;
    const auto say = [&](const std::string& what) {
      r.remarks.push_back("entry " + std::to_string(seq) + ": has not released entry " + std::to_string(s.seq) + ", for " + what);
    };
    if (const FiledSession* other = r.chosen_instead_of(s)) {
      say("entry " + std::to_string(other->seq) + ", another ending of the same exam, was chosen before");
      continue;
    }
    const bool both = std::any_of(r.sessions.begin(), r.sessions.end(),
                                  [&](const FiledSession& o) { return contest_each_other(s, o) && results.contains(o.result_seq); });
    if (both) {
      say("it names two endings of the same exam, and one counts: choose it with --session");
      continue;
    }
    for (auto& o : r.sessions)  // released before anybody knew of this ending
      if (contest_each_other(s, o)) o.released = false, o.shown = json(), o.shown_seq = 0, o.released_utc_ns = 0;
    s.released = true;
    s.shown = s.result;
    s.shown_seq = s.result_seq;
    s.released_utc_ns = utc_ns;
    s.chosen = s.questioned();
  }
}

}  // namespace

const FiledSession* Registry::chosen_instead_of(const FiledSession& session) const {
  for (const auto& o : sessions)
    if (contest_each_other(session, o) && o.chosen) return &o;
  return nullptr;
}

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
        s.result = s.filed = result_in(e);
        if (const auto sealed = content.documents.find(text_in(e.body, "sealed_sha256")); sealed != content.documents.end())
          s.sealed = parse_json_or_null({reinterpret_cast<const char*>(sealed->second.data()), sealed->second.size()}, k_json_part);
        s.grading_version = whole_in(e.body, "grading_version");
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
        s.result = result_in(e);
        s.result_seq = e.seq;
        s.regrades.push_back({e.seq, e.utc_ns, text_in(e.body, "reason"), documents_of(e), s.result});
        s.released = false;  // a new result waits for its own release, and the old one stands until then
      } else if (e.kind == "release") {
        const auto results = e.body.at("results").get<std::set<std::uint64_t>>();
        for (const auto seq : results)
          if (std::none_of(r.sessions.begin(), r.sessions.end(), [&](const FiledSession& s) { return s.result_seq == seq; }))
            say("releases a result that does not count");
        release(r, e.seq, e.utc_ns, results);
      } else if (e.kind == "station") {
        apply_station_entry(r.stations, e, content.public_key);
      } else if (e.kind != "init" && e.kind != "forget" && e.kind != "restore") {
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
