#include "grading/records/exported_grade.h"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>

#include "engine/base/json_fields.h"
#include "engine/base/text.h"
#include "engine/session/session.h"
#include "grading/records/entry_text.h"
#include "grading/result/finding.h"
#include "grading/result/result_json.h"

namespace cavum::records {
namespace {

using grading::Verdict;
using nlohmann::json;

constexpr double k_rounding = 1e-6;  // of the JSON

/// Criteria that fail the exam by themselves, whatever the sum.
List critical_in(const json& result) {
  List out;
  for (const auto& c : result.at("criteria"))
    if (c.contains("critical_failed") && c["critical_failed"] == json(true))
      out.items.emplace_back(Name{c.value("id", "")});
  return out;
}

/// What a person decided before this result was released, or has to decide.
void add_doubts(std::vector<Message>& out, const FiledSession& s) {
  if (s.makes_up)
    out.push_back(
        s.makes_up->became == FirstSitting::missed
            ? msg("A makeup sitting: the first (entry {}) was missed.", s.makes_up->ticket)
            : msg("A makeup sitting: the first (entry {}) was interrupted.", s.makes_up->ticket));
  if (!s.contested_by.empty()) {
    List others;
    for (const auto other : s.contested_by) others.items.push_back(msg("{}", other));
    out.push_back(
        s.chosen
            ? msg("Several endings of this exam were filed (also entry {}), and this one was chosen by a person.",
                  others)
            : msg("Contested since its release by another ending of this exam (entry {}).",
                  others));
  }
  if (const Regrade* r = s.regrade(s.shown_seq); r != nullptr && !r->person.empty())
    out.push_back(msg("Decided by a person: {}.", r->reason));
  if (const auto n = s.findings.size(); n > 0)
    out.push_back(msgn("Filed with {} finding, and released by a person.",
                       "Filed with {} findings, and released by a person.",
                       static_cast<std::int64_t>(n), n));
}

}  // namespace

std::string utc_ms_text(std::int64_t utc_ns) {
  std::string seconds = utc_text(utc_ns);
  seconds.pop_back();
  const auto ms = utc_ns / 1'000'000 % 1000;
  return fmt::format("{}.{:03}Z", seconds, ms);
}

namespace {

/// Why a criterion has its points, fact by fact.
Message reason_in(const json& criterion) {
  return msg("{}", grading::sentences(grading::findings_in(member_of(criterion, "facts"))));
}

}  // namespace

ExportedGrade exported_grade(const FiledSession& session,
                             const std::map<std::string, ExamScale>& own_scales) {
  const auto known = own_scales.find(session.scenario_id);
  const ExamScale own = known == own_scales.end() ? ExamScale{} : known->second;
  const json& result = *session.shown;
  const json &points = result.at("score").at("points"), &max = result.at("score").at("max");
  const ExamScale by = scale_in(result);
  const Verdict verdict = grading::verdict_in(result);
  const List critical = critical_in(result);
  std::string critical_ids;
  for (const Message& id : critical.items)
    critical_ids += (critical_ids.empty() ? "" : ", ") + english_text(id);
  ExportedGrade g{points,
                  points,
                  max,
                  false,
                  grading::verdict_name(verdict) +
                      (critical_ids.empty() ? "" : fmt::format(" (critical: {})", critical_ids)),
                  {}};
  if (own.max > 0 && by.max > 0 && std::fabs(own.max - by.max) > k_rounding) {
    g.by_another_rubric = true;
    g.points = std::round(points.get<double>() / by.max * own.max * 1e6) / 1e6;
    g.max = own.max;
  }
  g.grade = g.points;
  std::vector<Message>& told = g.feedback;
  const Number had = as_points(points), of = as_number(max);
  add_doubts(told, session);
  told.push_back(critical.items.empty()
                     ? msg("Verdict: {}.", word_of(verdict))
                     : msg("Verdict: {} (critical: {}).", word_of(verdict), critical));
  if (verdict == Verdict::review) {
    g.grade = nullptr;
    told.push_back(msg(
        "No grade before a person has decided: the {} of {} points do not count yet.", had, of));
  }
  if (g.by_another_rubric)
    told.push_back(msg("Marked by another rubric: {} of {} points.", had, of));

  const auto reaches = [&](double percent) {
    return g.points.get<double>() >= 0.01 * percent * g.max.get<double>() - k_rounding;
  };
  const double own_percent = own.max > 0 ? own.pass_percent : by.pass_percent;
  const bool by_person = result.contains("decision");
  if (verdict == Verdict::fail &&
      (!critical.items.empty() || reaches(by.pass_percent) || reaches(own_percent))) {
    g.grade = 0;
    told.push_back(
        !critical.items.empty()
            ? msg("Failed by what is critical: the {} of {} points do not count.", had, of)
        : by_person
            ? msg("Failed by a person's decision: the {} of {} points do not count.", had, of)
        : reaches(by.pass_percent)
            ? msg("Failed by a criterion below the pass mark: the {} of {} points do not count.",
                  had, of)
            : msg("Failed by another pass mark ({}, the exam's own is {}): the {} of {} points do not count.",
                  as_percent(by.pass_percent, k_as_needed), as_percent(own_percent, k_as_needed),
                  had, of));
  } else if (verdict == Verdict::pass && !reaches(own_percent)) {
    g.grade = std::round(0.01 * own_percent * g.max.get<double>() * 1e6) / 1e6;
    const Number grade = as_number(g.grade.get<double>());
    told.push_back(
        by_person
            ? msg("Passed by a person's decision: the {} of {} points count as the pass mark, {}.",
                  had, of, grade)
            : msg("Passed by another pass mark ({}, the exam's own is {}): the {} of {} points count as the pass mark, {}.",
                  as_percent(by.pass_percent, k_as_needed), as_percent(own_percent, k_as_needed),
                  had, of, grade));
  }
  for (const auto& c : result.at("criteria"))
    if (c.at("points").get<double>() < c.at("max").get<double>())
      told.push_back(msg("{}, {} of {} points: {}.", c.value("id", ""), as_points(c.at("points")),
                         as_number(c.at("max")), reason_in(c)));
  return g;
}

std::string feedback_text(const ExportedGrade& grade, Wording say) {
  std::string out;
  for (const Message& sentence : grade.feedback) out += (out.empty() ? "" : " ") + say(sentence);
  return one_line(out);
}

}  // namespace cavum::records
