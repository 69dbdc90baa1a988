#include "grading/ledger/exported_grade.h"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>

#include "engine/base/json_fields.h"
#include "engine/base/text.h"
#include "engine/session/session.h"
#include "grading/ledger/entry_text.h"

namespace cavum::ledger {
namespace {

using nlohmann::json;

constexpr double k_rounding = 1e-6;  // of the JSON

/// "80.8 of 100"
std::string points_of(const json& points, const json& max) {
  return fmt::format("{} of {}", fixed(points.get<double>(), 1), plain_number(max.get<double>()));
}

/// Criteria that fail the exam by themselves, whatever the sum.
std::string critical_in(const json& result) {
  std::string out;
  for (const auto& c : result.at("criteria"))
    if (c.contains("critical_failed") && c["critical_failed"] == json(true)) out += (out.empty() ? "" : ", ") + c.value("id", "");
  return out;
}

/// What a person decided before this result was released, or has to decide.
std::string doubts_of(const FiledSession& s) {
  std::string out;
  if (s.makes_up) out += fmt::format("Makeup sitting, for the first was {} (entry {}). ", word_of(s.makes_up->became), s.makes_up->ticket);
  if (!s.contested_by.empty()) {
    std::string others;
    for (const auto other : s.contested_by) others += (others.empty() ? "" : ", ") + std::to_string(other);
    out += s.chosen ? fmt::format("Several endings of this exam were filed (also entry {}), and this one was chosen by a person. ", others)
                    : fmt::format("Contested since its release by another ending of this exam (entry {}). ", others);
  }
  if (const Regrade* r = s.regrade(s.shown_seq); r != nullptr && !r->person.empty()) out += fmt::format("Decided by a person: {}. ", r->reason);
  if (!s.findings.empty())
    out += fmt::format("Filed with {}{}, and released by a person. ", s.findings.size(), s.findings.size() == 1 ? " finding" : " findings");
  return out;
}

}  // namespace

std::string utc_ms_text(std::int64_t utc_ns) {
  std::string seconds = utc_text(utc_ns);
  seconds.pop_back();
  const auto ms = utc_ns / 1'000'000 % 1000;
  return fmt::format("{}.{:03}Z", seconds, ms);
}

ExportedGrade exported_grade(const FiledSession& session, const std::map<std::string, ExamScale>& own_scales) {
  const auto known = own_scales.find(session.scenario_id);
  const ExamScale own = known == own_scales.end() ? ExamScale{} : known->second;
  const json& result = *session.shown;
  const json &points = result.at("score").at("points"), &max = result.at("score").at("max");
  const ExamScale by = scale_in(result);
  const std::string verdict = result.value("verdict", ""), critical = critical_in(result);
  ExportedGrade g{points, points, max, false, verdict + (critical.empty() ? "" : fmt::format(" (critical: {})", critical)), {}};
  if (own.max > 0 && by.max > 0 && std::fabs(own.max - by.max) > k_rounding) {
    g.by_another_rubric = true;
    g.points = std::round(points.get<double>() / by.max * own.max * 1e6) / 1e6;
    g.max = own.max;
  }
  g.grade = g.points;
  g.feedback = fmt::format("{}Verdict: {}.", doubts_of(session), g.verdict);
  if (verdict == "review") {
    g.grade = nullptr;
    g.feedback += fmt::format(" No grade before a person has decided: the {} points do not count yet.", points_of(points, max));
  }
  if (g.by_another_rubric) g.feedback += fmt::format(" Marked by another rubric: {}.", points_of(points, max));

  const auto reaches = [&](double percent) { return g.points.get<double>() >= 0.01 * percent * g.max.get<double>() - k_rounding; };
  const double own_percent = own.max > 0 ? own.pass_percent : by.pass_percent;
  const std::string marks = fmt::format("({} %, the exam's own is {} %)", plain_number(by.pass_percent), plain_number(own_percent));
  if (verdict == "fail" && (!critical.empty() || reaches(by.pass_percent) || reaches(own_percent))) {
    g.grade = 0;
    g.feedback += fmt::format(" Failed by {}: the {} points do not count.",
                              !critical.empty()             ? "what is critical"
                              : result.contains("decision") ? "a person's decision"
                              : reaches(by.pass_percent)    ? "a criterion below the pass mark"
                                                            : "another pass mark " + marks,
                              points_of(points, max));
  } else if (verdict == "pass" && !reaches(own_percent)) {
    g.grade = std::round(0.01 * own_percent * g.max.get<double>() * 1e6) / 1e6;
    g.feedback += fmt::format(" Passed by {}: the {} points count as the pass mark, {}.",
                              result.contains("decision") ? "a person's decision" : "another pass mark " + marks, points_of(points, max),
                              plain_number(g.grade.get<double>()));
  }
  for (const auto& c : result.at("criteria"))
    if (c.at("points").get<double>() < c.at("max").get<double>())
      g.feedback += fmt::format(" {} {}: {}.", c.value("id", ""), points_of(c.at("points"), c.at("max")), c.value("reason", ""));
  g.feedback = one_line(g.feedback);
  return g;
}

}  // namespace cavum::ledger
