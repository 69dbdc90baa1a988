#include "grading/marking/school_mark.h"

#include <fmt/core.h>

#include <algorithm>
#include <map>

#include "engine/base/json_fields.h"
#include "engine/base/json_reader.h"
#include "engine/base/message_from.h"
#include "engine/base/text.h"
#include "grading/marking/session_input.h"
#include "grading/result/result_json.h"
#include "scenarios/exam/exam.h"

namespace cavum::grading {
namespace {

using nlohmann::json;

constexpr std::size_t k_max_named = 12;  // differences: more of them say nothing new
constexpr char k_none[] = "–";

/// Tick at which the candidate, or who took the exam up, handed it in; -1 = nobody did. What the
/// clock ends with all steps done is `completed` as well, in the last tick and not after it.
std::int64_t ended_by_hand(const SessionReader& session) {
  for (const auto& e : session.event_rows())
    if (const auto* finished = e.as<Finished>())
      if (finished->how == Finish::ended ||
          (finished->how == Finish::completed && e.tick == session.ticks()))
        return e.tick;
  return -1;
}

std::string event_text(const std::vector<TimedEvent>& events, std::size_t i) {
  if (i >= events.size()) return k_none;
  const EventText text = encode(events[i].event);
  return fmt::format("'{} {}' ({})", text.kind, text.detail_json, events[i].tick);
}

/// Runs the scenario over the motion while that is simulated.
class ReplayedEvents {
 public:
  ReplayedEvents(const SessionReader& session, ExamContexts& grounds)
      : task_(scenarios::exam_task(session.setup(), session.path() + ": scenario")),
        ground_(grounds.of(task_, session.path())),
        runner_(task_.scenario, ground_->zones, ground_->tooth, task_.bur_names),
        ended_(ended_by_hand(session)) {
    for (auto& e : session.events())
      (is_runners(e.event) ? recorded_ : beside_).push_back(std::move(e));
  }

  void see(std::int64_t tick, const TickInput& input, const TickOutput& output,
           const ServoState& state) {
    if (tick == ended_) runner_.end(*state_);
    runner_.advance(*state_, input, output, state.removed);
    take();
  }
  /// What differs from the recorded events.
  [[nodiscard]] Damages differences(std::int64_t ticks) {
    Damages findings;
    if (ended_ >= 0 && ended_ < ticks)
      findings.push_back(damage<DamageKind::ended_before_end>(ended_, ticks));
    if (ended_ == ticks) runner_.end(*state_);
    take();
    for (std::size_t i = 0;
         i < std::max(recorded_.size(), again_.size()) && findings.size() < k_max_named; ++i) {
      if (i < recorded_.size() && i < again_.size() && recorded_[i] == again_[i]) continue;
      findings.push_back(
          damage<DamageKind::event_differs>(i, event_text(recorded_, i), event_text(again_, i)));
    }
    return findings;
  }

  [[nodiscard]] std::vector<Message> servo_findings() const {
    return scenarios::check_servo(task_.session.servo_toml, task_.scenario);
  }
  [[nodiscard]] VerifyTeeth teeth(Tooth& final_tooth) const noexcept {
    return {&ground_->tooth, ground_->fits.get(), &final_tooth};
  }
  /// Those of the motion, and what else the station recorded.
  [[nodiscard]] std::vector<TimedEvent> events() const {
    std::vector<TimedEvent> all = again_;
    all.insert(all.end(), beside_.begin(), beside_.end());
    std::stable_sort(all.begin(), all.end(),
                     [](const TimedEvent& a, const TimedEvent& b) { return a.tick < b.tick; });
    return all;
  }

 private:
  /// As an exam records them: each once, from the runner's list.
  void take() {
    for (auto& e : state_->events_from(static_cast<std::uint32_t>(again_.size())))
      again_.push_back(std::move(e));
  }

  scenarios::ExamTask task_;
  std::shared_ptr<const ExamContext> ground_;
  scenarios::Runner runner_;
  std::unique_ptr<scenarios::RunnerState> state_ = std::make_unique<scenarios::RunnerState>();
  std::vector<TimedEvent> recorded_, again_;  ///< the runner's
  std::vector<TimedEvent> beside_;            ///< the station's
  std::int64_t ended_;
};

std::string short_text(const json& value) {
  constexpr std::size_t k_longest = 60;
  const std::string text = value.is_null()     ? k_none
                           : value.is_string() ? value.get<std::string>()
                                               : value.dump();
  return text.substr(0, whole_characters(text.substr(0, k_longest)));
}

/// With the criteria by their ids, not by their places.
json by_id(json result) {
  if (!result.is_object() || !result.contains("criteria")) return result;
  json criteria = json::object();
  for (const json& c : result["criteria"]) criteria[text_in(c, "id")] = c;
  result["criteria"] = std::move(criteria);
  return result;
}

}  // namespace

std::string result_differences(const json& sealed, const json& marked) {
  const json was = by_id(sealed), is = by_id(marked);
  json steps = json::diff(was, is);
  std::stable_partition(steps.begin(), steps.end(), [](const json& s) {
    return !s["path"].get_ref<const std::string&>().starts_with("/criteria");
  });
  std::string out;
  for (std::size_t i = 0; i < std::min(steps.size(), k_max_named); ++i) {
    const std::string path = steps[i].at("path"), op = steps[i].at("op");
    const json none;
    out += fmt::format("{}{}: {} → {}", i == 0 ? "" : "; ", path,
                       short_text(op == "add" ? none : was.at(json::json_pointer(path))),
                       short_text(op == "remove" ? none : steps[i].at("value")));
  }
  return steps.size() > k_max_named ? out + "; …" : out;
}

Damages SchoolMark::findings() const {
  Damages all = replay.findings;
  all.insert(all.end(), exam.begin(), exam.end());
  return all;
}

SchoolMark mark_again(const SessionReader& session, ExamContexts& grounds) {
  SchoolMark out;
  std::optional<ReplayedEvents> events;
  try {
    events.emplace(session, grounds);
  } catch (const std::bad_alloc&) {
    throw;  // nothing is wrong with the recording
  } catch (const std::exception& e) {
    out.exam.push_back(damage<DamageKind::scenario_unreadable>(message_from(e)));
  }
  Tooth final_tooth;
  const auto see = [&](std::int64_t tick, const TickInput& input, const TickOutput& output,
                       const ServoState& state) { events->see(tick, input, output, state); };
  out.replay = verify_session(session, "", events ? TickVisitor(see) : TickVisitor{},
                              events ? events->teeth(final_tooth) : VerifyTeeth{});
  if (events)
    for (const Message& why : events->servo_findings())
      out.exam.push_back(damage<DamageKind::exam_differs>(why));
  // Whole and repeated to the last tick: only such a motion is marked, damaged or forged facts
  // beside it or not.
  const bool repeated = out.replay.closed && out.replay.ticks_replayed == out.replay.ticks &&
                        out.replay.ticks_different == 0 && !out.replay.first_divergence && events;
  if (!repeated) return out;
  for (auto& f : events->differences(session.ticks())) out.exam.push_back(std::move(f));
  try {
    const auto graded = load_for_grading(session, std::move(final_tooth), grounds);
    graded->events = events->events();
    out.result = parse_json(to_json(grade(graded->input(), graded->rubric)).dump(), msg("result"));
  } catch (const std::bad_alloc&) {
    throw;  // nothing is wrong with the recording
  } catch (const std::exception& e) {
    out.exam.push_back(damage<DamageKind::not_markable>(message_from(e)));
    return out;
  }
  const json sealed = parse_json_or_null(session.result_json(), k_json_part);
  const std::string differ = result_differences(sealed, out.result);
  if (differ.empty()) return out;
  out.sealed_otherwise = sealed;
  out.exam.push_back(damage<DamageKind::result_differs>(whole_in(sealed, "grading_version"),
                                                        k_grading_version, differ));
  return out;
}

}  // namespace cavum::grading
