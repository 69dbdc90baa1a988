#include "grading/records/exports.h"

#include <fmt/core.h>

#include <algorithm>
#include <map>
#include <set>
#include <vector>

#include "engine/base/json_fields.h"
#include "engine/base/json_reader.h"
#include "engine/base/json_struct.h"
#include "engine/base/message_from.h"
#include "engine/base/text.h"
#include "engine/session/session.h"
#include "grading/records/history.h"
#include "grading/result/result_json.h"

namespace cavum::records {
namespace {

using nlohmann::json;

/// A number in full, or nothing.
std::string number_in(const json& j) { return j.is_number() ? j.dump() : ""; }

constexpr char k_simulated[] = "SIMULATED";

/// What stands before verdict and feedback of a result that no student sat.
std::string simulated_mark(const FiledSession& s) {
  return s.simulated.empty() ? ""
                             : fmt::format("{} (operator {}, no student sat this): ", k_simulated,
                                           one_line(s.simulated));
}

/// Whose row it is: the school's own number, or a simulated operator's, whom no gradebook knows.
/// Empty when nobody knows who sat.
std::string number_of(const FiledSession& s, Identities& identities) {
  if (!s.simulated.empty()) return fmt::format("{} {}", k_simulated, s.candidate);
  const auto identity = identities.of_pseudonym(s.candidate);
  return identity ? identity->id : "";
}

Bytes results_message(const json& facts) {
  const std::string text = "CVRESULT" + facts.dump();
  return {text.begin(), text.end()};
}

}  // namespace

std::string moodle_csv(const Registry& registry, Identities& identities, int& left_out, Wording say,
                       bool with_simulated) {
  struct Columns {
    std::vector<std::string> criteria;
    std::map<std::string, const FiledSession*> by_number;
  };
  const auto scales = own_scales(registry);
  std::map<std::string, Columns> exams;
  std::set<std::string> numbers, unknown;
  for (const auto& s : registry.sessions) {
    if (s.shown->is_null() || (!s.simulated.empty() && !with_simulated)) continue;
    Columns& exam = exams[s.scenario_id];
    const std::string number = number_of(s, identities);
    if (number.empty())
      unknown.insert(s.candidate);
    else
      numbers.insert(number), exam.by_number[number] = &s;
    if (exported_grade(s, scales).by_another_rubric) continue;
    for (const auto& c : s.shown->at("criteria"))
      if (const std::string id = c.at("id");
          std::find(exam.criteria.begin(), exam.criteria.end(), id) == exam.criteria.end())
        exam.criteria.push_back(id);
  }
  left_out = static_cast<int>(unknown.size());
  std::string out = "ID number";
  for (const auto& [id, exam] : exams) {
    out += "," + csv_field(id);
    out += fmt::format(",{},{}", csv_field(id + " verdict"), csv_field(id + " points"));
    for (const auto& c : exam.criteria) out += "," + csv_field(fmt::format("{} {}", id, c));
    out += "," + csv_field(id + " feedback");
  }
  out += "\n";
  for (const auto& number : numbers) {
    out += csv_field(number);
    for (const auto& [id, exam] : exams) {
      const auto found = exam.by_number.find(number);
      if (found == exam.by_number.end()) {
        out += std::string(exam.criteria.size() + 4, ',');
        continue;
      }
      const json& result = *found->second->shown;
      const std::string mark = simulated_mark(*found->second);
      const ExportedGrade g = exported_grade(*found->second, scales);
      out += fmt::format(",{},{},{}", number_in(g.grade), csv_field(mark + g.verdict),
                         number_in(g.points));
      for (const auto& wanted : exam.criteria) {
        out += ",";
        for (const auto& c : result.at("criteria"))
          if (!g.by_another_rubric && c.at("id") == wanted) out += number_in(c.at("points"));
      }
      out += "," + csv_field(mark + feedback_text(g, say));
    }
    out += "\n";
  }
  return out;
}

json lti_scores(const Registry& registry, Identities& identities, Wording say,
                bool with_simulated) {
  std::map<std::pair<std::string, std::string>, const FiledSession*>
      last;  // of several attempts the last one that is released, else the last
  for (const auto& s : registry.sessions) {
    if ((!s.simulated.empty() && !with_simulated) || s.made_up_by) continue;
    const std::string user =
        s.simulated.empty() ? number_of(s, identities) : "simulated:" + s.candidate;
    if (user.empty()) continue;  // the platform knows nobody by a pseudonym
    const FiledSession*& counts = last[{s.scenario_id, user}];
    if (counts == nullptr || s.shown->is_object() || !counts->shown->is_object()) counts = &s;
  }
  const auto scales = own_scales(registry);
  json out = json::array();
  for (const auto& [key, s] : last) {
    const bool shown = s->shown->is_object();
    const bool review =
        s->result->is_object() && grading::verdict_in(*s->result) == grading::Verdict::review;
    json score = {{"userId", key.second},
                  {"timestamp", utc_ms_text(shown ? s->released_utc_ns : s->received_utc_ns)},
                  {"activityProgress", "Completed"},
                  {"gradingProgress", shown    ? "FullyGraded"
                                      : review ? "PendingManual"
                                               : "Pending"}};
    if (const std::string mark = simulated_mark(*s); !mark.empty()) score["comment"] = mark;
    if (shown) {
      const ExportedGrade g = exported_grade(*s, scales);
      if (g.grade.is_null()) {  // released undecided
        score["gradingProgress"] = "PendingManual";
      } else {
        score["scoreGiven"] = g.grade;
        score["scoreMaximum"] = g.max;
      }
      score["comment"] = simulated_mark(*s) + feedback_text(g, say);
    }
    out.push_back({{"resourceId", s->scenario_id}, {"score", std::move(score)}});
  }
  return out;
}

std::size_t released_simulated(const Registry& registry) {
  return static_cast<std::size_t>(std::count_if(
      registry.sessions.begin(), registry.sessions.end(),
      [](const FiledSession& s) { return !s.simulated.empty() && !s.shown->is_null(); }));
}

std::string signed_results(const Registry& registry, const Ledger& ledger) {
  json results = json::array();
  for (const auto& s : registry.sessions)
    results.push_back({{"session", s.seq},
                       {"candidate", s.candidate},
                       {"file_sha256", s.file_sha256},
                       {"released", s.released},
                       {"result", *s.result},
                       {"shown", *s.shown},
                       {"simulated", s.simulated},
                       {"contested_by", s.contested_by},
                       {"chosen", s.chosen},
                       {"makes_up", s.makes_up ? json(s.makes_up->ticket) : json()},
                       {"made_up_by", s.made_up_by ? json(*s.made_up_by) : json()},
                       {"findings", to_json_value(s.findings)}});
  const Checkpoint& p = ledger.content().checkpoints.back();
  json facts = {{"results", results},
                {"ledger", ledger.content().id},
                {"public_key", ledger.content().public_key},
                {"checkpoint", checkpoint_note(ledger.content().id, ledger.content().key_of(p.size),
                                               p, cosignatures_of(ledger.content(), p.size))}};
  const std::string signature = to_hex(ledger.key().sign(results_message(facts)));
  facts["signature"] = signature;
  return facts.dump();
}

Findings check_results(const std::string& text, const std::string& public_key,
                       const LedgerContent* ledger) {
  Findings findings;
  try {
    json facts = parse_json(text, msg("results"));
    const std::string written = text.substr(0, text.find_last_not_of("\r\n") + 1);
    if (facts.dump() != written) findings.push_back(finding<FindingKind::results_rewritten>());
    const std::string key = facts.at("public_key");
    const auto signature = fixed_from_hex<64>(facts.at("signature"), msg("signature"));
    facts.erase("signature");
    if (ledger == nullptr && !public_key.empty() && key != public_key)
      findings.push_back(finding<FindingKind::results_other_school>());
    if (!is_signed_by(fixed_from_hex<32>(key, "public_key"), results_message(facts), signature))
      findings.push_back(finding<FindingKind::results_signature>());
    if (ledger != nullptr) {
      const std::string id = facts.at("ledger");
      const Checkpoint seen = checkpoint_in(facts.at("checkpoint"), id, key, msg("results"));
      if (key != ledger->key_of(seen.size))
        findings.push_back(finding<FindingKind::results_other_key>());
      if (!is_signed_by_school(id, key, seen))
        findings.push_back(finding<FindingKind::results_checkpoint>());
      check_history(*ledger, id, seen, msg("the export"), findings);
    }
  } catch (const json::exception&) {
    findings.push_back(finding<FindingKind::no_results>());
  } catch (const std::bad_alloc&) {
    throw;
  } catch (const std::exception& e) {
    findings.push_back(finding<FindingKind::results_unreadable>(message_from(e)));
  }
  return findings;
}

std::string tidy_csv(const Registry& registry) {
  std::string out =
      "session,candidate,scenario,station,simulated,regraded,findings,contested,chosen,makes_up,made_up_by,verdict,released,criterion,metric,value,"
      "unit,points,max\n";
  for (const auto& s : registry.sessions) {
    if (!s.result->is_object()) continue;
    for (const auto& c : s.result->at("criteria"))
      out += std::to_string(s.seq) + "," + csv_field(s.candidate) + "," + csv_field(s.scenario_id) +
             "," + csv_field(s.station_key.substr(0, 16)) + "," + csv_field(s.simulated) + "," +
             (s.result_seq != s.seq ? "1" : "0") + "," + std::to_string(s.findings.size()) + "," +
             std::to_string(s.contested_by.size()) + "," + (s.chosen ? "1" : "0") + "," +
             (s.makes_up ? std::to_string(s.makes_up->ticket) : "") + "," +
             (s.made_up_by ? std::to_string(*s.made_up_by) : "") + "," +
             csv_field(s.result->value("verdict", "")) + "," + (s.released ? "1" : "0") + "," +
             csv_field(c.value("id", "")) + "," + csv_field(c.value("metric", "")) + "," +
             number_in(c.at("value")) + "," + csv_field(c.value("unit", "")) + "," +
             number_in(c.at("points")) + "," + number_in(c.at("max")) + "\n";
  }
  return out;
}

}  // namespace cavum::records
