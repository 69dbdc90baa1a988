#include "grading/ledger/exports.h"

#include <algorithm>
#include <map>
#include <vector>

#include "engine/base/text.h"
#include "engine/session/session.h"

namespace cavum {
namespace {

using nlohmann::json;

/// A number in full, or nothing.
std::string number_in(const json& j) { return j.is_number() ? j.dump() : ""; }

/// Criteria that fail the exam by themselves, whatever the sum.
std::vector<std::string> critical_in(const json& result) {
  std::vector<std::string> out;
  for (const auto& c : result.at("criteria"))
    if (c.contains("critical_failed") && c["critical_failed"] == json(true)) out.push_back(c.value("id", ""));
  return out;
}

constexpr char k_simulated[] = "SIMULATED";

/// What stands before verdict and feedback of a result that no student sat.
std::string simulated_mark(const FiledSession& s) {
  return s.simulated.empty() ? "" : std::string(k_simulated) + " (operator " + one_line(s.simulated) + ", no student sat this): ";
}

/// Whom a row is for: a candidate, or a simulated operator in a candidate's place, who is somebody else.
std::string sitter_of(const FiledSession& s) { return s.simulated.empty() ? s.candidate : std::string(k_simulated) + " " + s.candidate; }

/// "fail (critical: perforation)"
std::string verdict_of(const json& result) {
  std::string out = result.value("verdict", "");
  std::string critical;
  for (const auto& id : critical_in(result)) critical += (critical.empty() ? "" : ", ") + id;
  return critical.empty() ? out : out + " (critical: " + critical + ")";
}

/// The exam was failed although the sum alone might pass: by a critical criterion, or by one below the pass mark where none makes up for another.
bool is_failed_beside_points(const json& result) {
  const json& score = result.at("score");
  const double pass_points = 0.01 * score.value("pass_percent", 0.0) * score.at("max").get<double>();
  return result.value("verdict", "") == "fail" && (!critical_in(result).empty() || score.at("points").get<double>() >= pass_points);
}

/// What a gradebook may add up and compare with its own pass mark: the points, but none where they do not decide.
json grade_of(const json& result) { return is_failed_beside_points(result) ? json(0) : result.at("score").at("points"); }

/// "Verdict: pass. floor_depth 8 of 10: deepest place 0.2 mm over ..."
std::string feedback_of(const json& result) {
  std::string out = "Verdict: " + verdict_of(result) + ".";
  if (is_failed_beside_points(result))
    out += std::string(" Failed by ") + (critical_in(result).empty() ? "a criterion below the pass mark" : "what is critical") + ": the " +
           plain_number(result.at("score").at("points")) + " of " + plain_number(result.at("score").at("max")) + " points do not count.";
  for (const auto& c : result.at("criteria"))
    if (c.at("points").get<double>() < c.at("max").get<double>())
      out += " " + c.value("id", "") + " " + plain_number(c.at("points")) + " of " + plain_number(c.at("max")) + ": " + c.value("reason", "") + ".";
  return one_line(out);
}

/// Milliseconds, as LTI wants: a platform keeps the score with the later time.
std::string utc_ms(std::int64_t utc_ns) {
  std::string seconds = utc_text(utc_ns);
  seconds.pop_back();
  const auto ms = utc_ns / 1'000'000 % 1000;
  return seconds + "." + std::string(ms < 10 ? "00" : ms < 100 ? "0" : "") + std::to_string(ms) + "Z";
}

Bytes results_message(const json& facts) {
  const std::string text = "CVRESULT" + facts.dump();
  return {text.begin(), text.end()};
}

}  // namespace

std::string csv_field(const std::string& text) {
  std::string out = text;
  // a minus sign before a number is a number
  const bool formula = !out.empty() && (out[0] == '=' || out[0] == '+' || out[0] == '@' || out[0] == '\t' || out[0] == '\r' ||
                                        (out[0] == '-' && out.find_first_not_of("-0123456789.eE+") != std::string::npos));
  if (formula) out.insert(out.begin(), '\'');
  if (out.find_first_of(",\"\r\n;") == std::string::npos) return out;
  std::string quoted = "\"";
  for (const char c : out) {
    if (c == '"') quoted += '"';
    quoted += c;
  }
  return quoted + "\"";
}

std::string moodle_csv(const Registry& registry, Identities& identities, int& left_out, bool with_simulated) {
  struct Exam {
    std::vector<std::string> criteria;
    std::map<std::string, const FiledSession*> by_candidate;
    /// What most were marked out of. A gradebook has one scale an exam; a regrade by another rubric may have another.
    [[nodiscard]] double scale() const {
      std::map<double, std::size_t> of;
      for (const auto& [candidate, s] : by_candidate) ++of[s->shown.at("score").at("max").get<double>()];
      return std::max_element(of.begin(), of.end(), [](const auto& a, const auto& b) { return a.second < b.second; })->first;
    }
  };
  std::map<std::string, Exam> exams;
  for (const auto& s : registry.sessions) {
    if (s.shown.is_null() || (!s.simulated.empty() && !with_simulated)) continue;
    Exam& exam = exams[s.scenario_id];
    exam.by_candidate[sitter_of(s)] = &s;
    for (const auto& c : s.shown.at("criteria"))
      if (const std::string id = c.at("id"); std::find(exam.criteria.begin(), exam.criteria.end(), id) == exam.criteria.end())
        exam.criteria.push_back(id);
  }
  std::string out = "ID number";
  for (const auto& [id, exam] : exams) {
    out += "," + csv_field(id);
    out += "," + csv_field(id + " verdict") + "," + csv_field(id + " points");
    for (const auto& c : exam.criteria) out += "," + csv_field(id + " " + c);
    out += "," + csv_field(id + " feedback");
  }
  out += "\n";
  std::map<std::string, std::string> rows;  // by the school's own number
  left_out = 0;
  std::vector<std::string> candidates;
  for (const auto& [id, exam] : exams)
    for (const auto& [candidate, session] : exam.by_candidate) candidates.push_back(candidate);
  std::sort(candidates.begin(), candidates.end());
  candidates.erase(std::unique(candidates.begin(), candidates.end()), candidates.end());
  for (const auto& candidate : candidates) {
    std::string number = candidate;  // of a simulated operator: none that a gradebook knows
    if (!candidate.starts_with(k_simulated)) {
      const auto identity = identities.of_pseudonym(candidate);
      if (!identity) {
        ++left_out;
        continue;
      }
      number = identity->id;
    }
    std::string& row = rows[number];
    row = csv_field(number);
    for (const auto& [id, exam] : exams) {
      const auto found = exam.by_candidate.find(candidate);
      if (found == exam.by_candidate.end()) {
        row += std::string(exam.criteria.size() + 4, ',');
        continue;
      }
      const json& result = found->second->shown;
      const std::string mark = simulated_mark(*found->second);
      const double own = result.at("score").at("max").get<double>(), scale = exam.scale();
      const json grade = own == scale ? grade_of(result) : json(grade_of(result).get<double>() / own * scale);
      row += "," + number_in(grade) + "," + csv_field(mark + verdict_of(result)) + "," + number_in(result.at("score").at("points"));
      for (const auto& wanted : exam.criteria) {
        row += ",";
        for (const auto& c : result.at("criteria"))
          if (c.at("id") == wanted) row += number_in(c.at("points"));
      }
      row += "," + csv_field(mark + feedback_of(result));
    }
  }
  for (const auto& [id, row] : rows) out += row + "\n";
  return out;
}

json lti_scores(const Registry& registry, Identities& identities, bool with_simulated) {
  std::map<std::pair<std::string, std::string>, const FiledSession*> last;  // of several attempts the last counts
  for (const auto& s : registry.sessions)
    if (s.simulated.empty() || with_simulated) last[{s.scenario_id, sitter_of(s)}] = &s;
  json out = json::array();
  for (const auto& [key, s] : last) {
    std::string user = "simulated:" + s->candidate;
    if (s->simulated.empty()) {
      const auto identity = identities.of_pseudonym(s->candidate);
      if (!identity) continue;  // the platform knows nobody by a pseudonym
      user = identity->id;
    }
    const bool shown = s->shown.is_object();
    const bool review = s->result.is_object() && s->result.value("verdict", "") == "review";
    json score = {{"userId", user},
                  {"timestamp", utc_ms(s->received_utc_ns)},
                  {"activityProgress", "Completed"},
                  {"gradingProgress", shown    ? "FullyGraded"
                                      : review ? "PendingManual"
                                               : "Pending"}};
    if (const std::string mark = simulated_mark(*s); !mark.empty()) score["comment"] = mark;
    if (shown) {
      score["scoreGiven"] = grade_of(s->shown);
      score["scoreMaximum"] = s->shown.at("score").at("max");
      score["comment"] = simulated_mark(*s) + feedback_of(s->shown);
    }
    out.push_back({{"resourceId", s->scenario_id}, {"score", std::move(score)}});
  }
  return out;
}

std::size_t released_simulated(const Registry& registry) {
  return static_cast<std::size_t>(std::count_if(registry.sessions.begin(), registry.sessions.end(),
                                                [](const FiledSession& s) { return !s.simulated.empty() && !s.shown.is_null(); }));
}

std::string signed_results(const Registry& registry, const Ledger& ledger) {
  json results = json::array();
  for (const auto& s : registry.sessions)
    results.push_back({{"session", s.seq},
                       {"candidate", s.candidate},
                       {"file_sha256", s.file_sha256},
                       {"released", s.released},
                       {"result", s.result},
                       {"shown", s.shown},
                       {"simulated", s.simulated},
                       {"findings", s.findings}});
  const Checkpoint& p = ledger.content().checkpoints.back();
  json facts = {{"results", results},
                {"ledger", ledger.content().id},
                {"public_key", ledger.content().public_key},
                {"checkpoint", {{"size", p.size}, {"root", to_hex(p.root)}}}};
  const std::string signature = to_hex(ledger.key().sign(results_message(facts)));
  facts["signature"] = signature;
  return facts.dump();
}

bool results_hold(const std::string& text) {
  try {
    json facts = json::parse(text);
    const auto signature = fixed_from_hex<64>(facts.at("signature"), "signature");
    const auto key = fixed_from_hex<32>(facts.at("public_key"), "public_key");
    facts.erase("signature");
    return is_signed_by(key, results_message(facts), signature);
  } catch (const std::exception&) {
    return false;
  }
}

std::string tidy_csv(const Registry& registry) {
  std::string out = "session,candidate,scenario,station,simulated,regraded,findings,verdict,released,criterion,metric,value,unit,points,max\n";
  for (const auto& s : registry.sessions) {
    if (!s.result.is_object()) continue;
    for (const auto& c : s.result.at("criteria"))
      out += std::to_string(s.seq) + "," + csv_field(s.candidate) + "," + csv_field(s.scenario_id) + "," + s.station_key.substr(0, 16) + "," +
             csv_field(s.simulated) + "," + (s.result_seq != s.seq ? "1" : "0") + "," + std::to_string(s.findings.size()) + "," +
             s.result.value("verdict", "") + "," + (s.released ? "1" : "0") + "," + csv_field(c.value("id", "")) + "," +
             csv_field(c.value("metric", "")) + "," + number_in(c.at("value")) + "," + csv_field(c.value("unit", "")) + "," +
             number_in(c.at("points")) + "," + number_in(c.at("max")) + "\n";
  }
  return out;
}

}  // namespace cavum
