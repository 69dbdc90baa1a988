#include "ui/report/report_source.h"

#include <fmt/core.h>

#include <algorithm>
#include <nlohmann/json.hpp>

#include "engine/base/json_reader.h"
#include "engine/base/text.h"
#include "engine/instrument/diamond_point.h"
#include "engine/language/say.h"
#include "scenarios/exam/runner.h"
#include "ui/parts/scenario_words.h"
#include "ui/report/report_document.h"

namespace cavum::report {
namespace {

using nlohmann::json;

std::string text_of(const json& detail, const char* key) {
  return detail.is_object() && detail.contains(key) && detail[key].is_string() ? detail[key].get<std::string>() : "";
}

std::optional<Vec3> site_of(const json& detail) {
  if (!detail.is_object() || !detail.contains("site_mm")) return {};
  const json& p = detail["site_mm"];
  if (!p.is_array() || p.size() != 3 || !p[0].is_number() || !p[1].is_number() || !p[2].is_number()) return {};
  return Vec3{p[0], p[1], p[2]};
}

std::string spaced(std::string kind) {
  std::replace(kind.begin(), kind.end(), '_', ' ');
  return kind;
}

/// A step as its candidate knows it: by its number and its instruction. One that the scenario does not have keeps its identifier.
struct Step {
  AsIs name;
  std::string text;  ///< English, of the scenario
};
Step step_of(const std::string& id, const scenarios::Scenario& scenario) {
  for (std::size_t i = 0; i < scenario.steps.size(); ++i)
    if (scenario.steps[i].id == id) return {as_is(std::to_string(i + 1)), scenario.steps[i].instruction};
  return {as_is(id), ""};
}

ReportEvent event_of(const SessionEvent& e, const grading::GradeInput& input, const std::vector<std::string>& points_toml) {
  const json detail = parse_json_or_null(e.detail_json);
  const Step step = step_of(text_of(detail, "step"), input.scenario);
  const auto is = [&](scenarios::ExamEventKind kind) { return e.kind == scenarios::event_name(kind); };
  ReportEvent r{static_cast<double>(std::max<std::int64_t>(0, e.tick)) * k_tick_s, said("device"), shown(spaced(e.kind)), site_of(detail)};
  const auto say = [&](const char* kind, const std::string& text) { r.kind = kind, r.text = text; };
  if (is(scenarios::ExamEventKind::step_started))
    say(said("step"), step.text.empty() ? tr("step {} begins", step.name) : tr("step {} begins: {}", step.name, step.text));
  if (is(scenarios::ExamEventKind::step_completed)) say(said("step"), tr("step {} completed", step.name));
  if (is(scenarios::ExamEventKind::step_failed)) say(said("step"), tr("step {} failed", step.name));
  if (is(scenarios::ExamEventKind::step_time_limit)) say(said("limit"), tr("time limit of step {}", step.name));
  if (is(scenarios::ExamEventKind::time_limit)) say(said("limit"), tr("time limit of the exam"));
  if (is(scenarios::ExamEventKind::over_speed)) say(said("violation"), tr("handpiece faster than {} rpm", plain_number(input.scenario.max_rpm)));
  if (is(scenarios::ExamEventKind::point_not_allowed)) {
    std::string name;
    if (detail.is_object() && detail.contains("point") && detail["point"].is_number_unsigned() &&
        detail["point"].get<std::size_t>() < points_toml.size())
      name = parse_diamond_point(points_toml[detail["point"].get<std::size_t>()], "diamond point of the session").title;
    say(said("violation"), name.empty() ? tr("diamond point not allowed here") : tr("diamond point not allowed here: {}", name));
  }
  if (is(scenarios::ExamEventKind::aim_reached)) say(said("aim"), tr("{} reached: the aim", text_of(detail, "tissue")));
  if (is(scenarios::ExamEventKind::perforation)) say(said("perforation"), tr("{} broken into (tissue)", text_of(detail, "tissue")));
  if (is(scenarios::ExamEventKind::finished)) say(said("finish"), tr("the exam ended: {}", finish_words(text_of(detail, "how"))));
  if (is(scenarios::ExamEventKind::pause_started)) say(said("pause"), tr("pause begins"));
  if (is(scenarios::ExamEventKind::pause_ended)) say(said("pause"), tr("pause ends"));
  if (is(scenarios::ExamEventKind::hold_started)) say(said("pause"), tr("the exam office pauses the exam"));
  if (is(scenarios::ExamEventKind::hold_ended)) say(said("pause"), tr("the exam office lets the exam go on"));
  if (is(scenarios::ExamEventKind::pause_refused)) say(said("pause"), tr("pause refused"));
  if (e.kind == "moved") say(said("gap"), tr("the disk refused: recorded at another place from here on"));
  if (e.kind == "gap") say(said("gap"), tr("the recording was interrupted here and taken up again"));
  return r;
}

}  // namespace

std::vector<ReportEvent> report_events(const grading::Result& result, const grading::GradeInput& input, const std::vector<std::string>& points_toml) {
  std::vector<ReportEvent> list;
  for (const auto& e : input.events)
    if (e.kind != "servo_lateness") list.push_back(event_of(e, input, points_toml));
  for (const auto& e : result.perforation.events)
    list.push_back({static_cast<double>(e.tick) * k_tick_s, e.fault ? "perforation" : "aim",
                    tr("breakthrough in the force: {} N to {} N, {}", fixed(e.force_before_n, 2), fixed(e.force_after_n, 2),
                       e.confirmed ? tr("confirmed by the tissue") : tr("not confirmed by the tissue")),
                    e.site_mm});
  std::stable_sort(list.begin(), list.end(), [](const ReportEvent& a, const ReportEvent& b) { return a.t_s < b.t_s; });
  return list;
}

ReportSource report_source(const grading::Result& result, const grading::GradeInput& input, const grading::ReportFacts& facts,
                           const scenarios::RubricSpec& rubric) {
  ui::show_texts_of(input.scenario);  // of which the events speak
  ReportSource s{.result = result, .input = input, .facts = facts, .rubric = rubric};
  constexpr double k_nothing = 1e-9;
  for (const auto& c : result.criteria)
    if (c.max - c.points > k_nothing) s.lost.push_back(grading::why(input, result, rubric, c.id));
  s.lessons = grading::lessons(input, result);
  s.events = report_events(result, input, facts.points_toml);
  return s;
}

std::string report_title(const ReportSource& s) { return s.result.scenario_title; }

}  // namespace cavum::report
