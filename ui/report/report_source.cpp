#include "ui/report/report_source.h"

#include <fmt/core.h>

#include <algorithm>

#include "engine/physics/bur/bur.h"
#include "scenarios/exam/runner.h"
#include "ui/parts/scenario_words.h"
#include "ui/report/report_document.h"

namespace cavum::report {
namespace {

ReportEvent event_of(const TimedEvent& e, const grading::GradeInput& input,
                     const std::vector<std::string>& burs_toml) {
  const auto say = [&](EventGroup kind, const Message& text, std::optional<Vec3> site_mm = {}) {
    return ReportEvent{static_cast<double>(std::max<std::int64_t>(0, e.tick)) * k_tick_s, kind,
                       text, site_mm};
  };
  const auto number = [](const OfStep& of) { return of.step + 1LL; };
  const auto tissue = [&](const OfTissue& of) { return Term{input.before.tissue_name(of.tissue)}; };
  return std::visit(
      EachKind{
          [&](const StepStarted& of) {
            const auto& steps = input.scenario.steps;
            const std::string asked = static_cast<std::size_t>(of.step) < steps.size()
                                          ? steps[static_cast<std::size_t>(of.step)].instruction
                                          : "";
            return say(EventGroup::step,
                       asked.empty() ? msg("step {} begins", number(of))
                                     : msg("step {} begins: {}", number(of), Authored{asked}));
          },
          [&](const StepCompleted& of) {
            return say(EventGroup::step, msg("step {} completed", number(of)));
          },
          [&](const StepFailed& of) {
            return say(EventGroup::step, msg("step {} failed", number(of)));
          },
          [&](const StepTimeUp& of) {
            return say(EventGroup::limit, msg("time limit of step {}", number(of)));
          },
          [&](const TimeUp&) { return say(EventGroup::limit, msg("time limit of the exam")); },
          [&](const OverSpeed&) {
            return say(EventGroup::violation,
                       msg("handpiece faster than {} rpm", as_number(input.scenario.max_rpm)));
          },
          [&](const BurNotAllowed& of) {
            const auto at = static_cast<std::size_t>(of.bur);
            return say(
                EventGroup::violation,
                at < burs_toml.size()
                    ? msg("bur not allowed here: {}",
                          Term{parse_bur(burs_toml[at], fmt::format("bur_{:03}.toml", at)).title})
                    : msg("bur not allowed here"));
          },
          [&](const AimReached& of) {
            return say(EventGroup::aim, msg("{} reached: the aim", tissue(of)), of.site_mm);
          },
          [&](const Perforated& of) {
            return say(EventGroup::perforation, msg("{} broken into (tissue)", tissue(of)),
                       of.site_mm);
          },
          [&](const Finished& of) {
            return say(EventGroup::finish, msg("the exam ended: {}", finish_words(of.how)));
          },
          [&](const PauseStarted&) { return say(EventGroup::pause, msg("pause begins")); },
          [&](const PauseEnded&) { return say(EventGroup::pause, msg("pause ends")); },
          [&](const HoldStarted&) {
            return say(EventGroup::pause, msg("the exam office pauses the exam"));
          },
          [&](const HoldEnded&) {
            return say(EventGroup::pause, msg("the exam office lets the exam go on"));
          },
          [&](const PauseRefused&) { return say(EventGroup::pause, msg("pause refused")); },
          [&](const RecordingMoved& of) {
            return say(EventGroup::gap,
                       msg("recorded at another place from here on: {}", in_words(of.why)));
          },
          [&](const ServoStopped& of) {
            return say(EventGroup::device, msg("the servo stopped: {}", in_words(of)));
          },
          [&](const RecordingGap&) {
            return say(EventGroup::gap,
                       msg("the recording was interrupted here and taken up again"));
          },
          [&](const AnyOf<ServoGap, Overruns, StylusSilent, StylusBack, PedalLost, PedalBack,
                          ServoDisagrees, ServoLateness, WorkAfterEnd, LockAttempt, OfficeHold,
                          OfficeHoldReleased, Announced, AnnouncementRead, TutorialStep,
                          MeasuredForce> auto&) {
            return say(EventGroup::device, msg("{}", word_of(e.event)));
          },
      },
      e.event);
}

}  // namespace

const char* name_of(EventGroup group) noexcept {
  constexpr const char* k_names[] = {"perforation", "aim",    "violation", "step", "pause",
                                     "limit",       "finish", "device",    "gap"};
  return k_names[static_cast<std::size_t>(group)];
}

Message word_of(EventGroup group) {
  switch (group) {
    case EventGroup::perforation:
      return msg("perforation");
    case EventGroup::aim:
      return msg("aim");
    case EventGroup::violation:
      return msg("violation");
    case EventGroup::step:
      return msg("step");
    case EventGroup::pause:
      return msg("pause");
    case EventGroup::limit:
      return msg("limit");
    case EventGroup::finish:
      return msg("finish");
    case EventGroup::device:
      return msg("device");
    case EventGroup::gap:
      break;
  }
  return msg("gap");
}

std::vector<ReportEvent> report_events(const grading::Result& result,
                                       const grading::GradeInput& input,
                                       const std::vector<std::string>& burs_toml) {
  std::vector<ReportEvent> list;
  for (const auto& e : input.events)
    if (e.as<ServoLateness>() == nullptr) list.push_back(event_of(e, input, burs_toml));
  for (const auto& e : result.perforation.events)
    list.push_back({static_cast<double>(e.tick) * k_tick_s,
                    e.fault ? EventGroup::perforation : EventGroup::aim,
                    e.confirmed
                        ? msg("breakthrough in the force: {} to {}, confirmed by the tissue",
                              as_n(e.force_before_n), as_n(e.force_after_n))
                        : msg("breakthrough in the force: {} to {}, not confirmed by the tissue",
                              as_n(e.force_before_n), as_n(e.force_after_n)),
                    e.site_mm});
  std::stable_sort(list.begin(), list.end(),
                   [](const ReportEvent& a, const ReportEvent& b) { return a.t_s < b.t_s; });
  return list;
}

ReportSource report_source(const grading::Result& result, const grading::GradeInput& input,
                           const grading::ReportFacts& facts, const scenarios::RubricSpec& rubric) {
  ui::show_texts_of(input.scenario);  // of which the events speak
  ReportSource s{.result = result, .input = input, .facts = facts, .rubric = rubric};
  constexpr double k_nothing = 1e-9;
  for (const auto& c : result.criteria)
    if (c.max - c.points > k_nothing) s.lost.push_back(grading::why(input, result, rubric, c.id));
  s.lessons = grading::lessons(input, result);
  s.events = report_events(result, input, facts.burs_toml);
  return s;
}

std::string report_title(const ReportSource& s) { return s.result.scenario_title; }

}  // namespace cavum::report
