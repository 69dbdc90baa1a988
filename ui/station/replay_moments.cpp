#include "ui/station/replay_moments.h"

#include <algorithm>
#include <nlohmann/json.hpp>

#include "engine/base/error.h"

namespace cavum::station {
namespace {

struct EventMark {
  Message word;  ///< none: not worth one
  bool bad = false;
};

EventMark mark(Message word) { return {std::move(word)}; }
EventMark bad_mark(Message word) { return {std::move(word), true}; }

EventMark event_mark(const Event& event) {
  return std::visit(
      EachKind{
          [](const Perforated&) { return bad_mark(msg("perforation")); },
          [](const AimReached&) { return mark(msg("aim reached")); },
          [](const StepCompleted&) { return mark(msg("step completed")); },
          [](const AnyOf<StepFailed, StepTimeUp> auto&) { return bad_mark(msg("step failed")); },
          [](const PauseStarted&) { return mark(msg("pause")); },
          [](const HoldStarted&) { return mark(msg("paused by the office")); },
          [](const RecordingGap&) { return bad_mark(msg("recording interrupted")); },
          [](const TimeUp&) { return mark(msg("time is up")); },
          [](const Finished&) { return mark(msg("finished")); },
          [](const AnyOf<StepStarted, BurNotAllowed, OverSpeed, PauseEnded, PauseRefused, HoldEnded,
                         RecordingMoved, ServoGap, Overruns, StylusSilent, StylusBack, PedalLost,
                         PedalBack, ServoStopped, ServoDisagrees, ServoLateness, WorkAfterEnd,
                         LockAttempt, OfficeHold, OfficeHoldReleased, Announced, AnnouncementRead,
                         TutorialStep, MeasuredForce> auto&) { return mark({}); },
      },
      event);
}

}  // namespace

std::vector<ReplayMoment> replay_moments(const std::vector<TimedEvent>& events,
                                         const std::string& result_json, std::int64_t ticks,
                                         bool with_points) {
  std::vector<ReplayMoment> moments;
  for (const TimedEvent& e : events)
    if (const auto [word, bad] = event_mark(e.event); !word.empty())
      moments.push_back({e.tick, word, bad});
  if (with_points && !result_json.empty()) {
    try {
      const auto result = nlohmann::json::parse(result_json);
      for (const auto& c :
           result.value("criteria", nlohmann::json::array())) {  // a recording of no exam has none
        if (!c.at("points").is_number() || !c.at("max").is_number()) continue;  // not judged
        const double lost = c.at("max").get<double>() - c.at("points").get<double>();
        constexpr double k_least = 0.005;
        if (lost <= k_least) continue;
        const auto& first = c.at("first_tick");
        moments.push_back({first.is_number()
                               ? std::clamp<std::int64_t>(first.get<std::int64_t>(), 0, ticks)
                               : ticks,
                           msg("{}", Authored{c.at("title").get<std::string>()}), true, lost});
      }
    } catch (const nlohmann::json::exception& e) {
      throw Error(msg("result of the session"), Name{e.what()}, msg("grade it anew: cavum grade"));
    }
  }
  std::stable_sort(moments.begin(), moments.end(),
                   [](const ReplayMoment& a, const ReplayMoment& b) { return a.tick < b.tick; });
  return moments;
}

int compared_moment(const std::vector<ReplayMoment>& moments, std::int64_t at, int chosen,
                    int step) {
  const auto n = static_cast<int>(moments.size());
  if (chosen >= 0 && chosen < n && moments[static_cast<std::size_t>(chosen)].tick == at) {
    const int next = chosen + step;
    return next >= 0 && next < n ? next : -1;
  }
  if (step > 0) {
    for (int i = 0; i < n; ++i)
      if (moments[static_cast<std::size_t>(i)].tick > at) return i;
    return -1;
  }
  for (int i = n - 1; i >= 0; --i)
    if (moments[static_cast<std::size_t>(i)].tick < at) return i;
  return -1;
}

}  // namespace cavum::station
