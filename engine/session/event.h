// What happened in an exam beside the motion. Each kind is a struct, and an event is one of them:
// the runner's follow from the motion, so that a replay comes to the same ones; the station's are
// its word. Steps, burs and tissues are named by their numbers. How a file holds them:
// docs/formats/session.md.
#pragma once

#include <algorithm>
#include <array>
#include <concepts>
#include <cstdint>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "engine/base/message.h"
#include "engine/base/text.h"
#include "engine/base/vec.h"
#include "engine/base/where.h"
#include "engine/physics/servo/real_time.h"
#include "engine/session/disk_refusal.h"
#include "engine/session/motion_source.h"

namespace cavum {

enum class Finish : std::uint8_t { running, completed, failed, time, ended };
inline constexpr std::array k_finish_names{noop("running"), noop("completed"), noop("failed"),
                                           noop("time"), noop("ended")};
[[nodiscard]] constexpr const char* finish_name(Finish finish) noexcept {
  return k_finish_names[static_cast<std::size_t>(finish)];
}

// What several kinds have; 32-bit numbers are counts and are never negative.
struct NoDetail {};
struct OfStep {
  std::int32_t step = 0;
};
struct OfPause {
  std::int32_t pause = 0;  ///< which, from 0; of the candidate's or of the office's
};
struct OfTissue {
  std::uint8_t tissue = 0;
  Vec3 site_mm;  ///< centre of its first leaf that was removed
};
struct OfEntry {
  std::uint64_t entry = 0;  ///< of the ledger
  std::string text = {};    ///< the office's
};

// The runner's. What each is called, in files and by people, says event.cpp.
struct StepStarted : OfStep {};
struct StepCompleted : OfStep {};
struct StepFailed : OfStep {};  ///< its fail_when came true
struct StepTimeUp : OfStep {};
struct TimeUp : NoDetail {};  ///< the exam's
struct BurNotAllowed {
  std::int32_t bur = 0;  ///< of the tray
};
struct OverSpeed : NoDetail {};   ///< faster than max_rpm
struct AimReached : OfTissue {};  ///< a tissue under perforation.aims
struct Perforated : OfTissue {};  ///< a tissue under perforation.faults
struct Finished {
  Finish how = Finish::ended;
};
struct PauseStarted : OfPause {};  ///< its tick is the first that does not count
struct PauseEnded : OfPause {};    ///< its tick counts again
struct PauseRefused {       ///< the button was pressed when none was left or the handpiece turned
  std::int32_t pauses = 0;  ///< taken so far
};
struct HoldStarted : OfPause {};  ///< by the exam office; its tick is the first that does not count
struct HoldEnded : OfPause {};    ///< its tick counts again

// The station's.
struct RecordingGap {  ///< the recording was cut off and taken up again; its tick is the number of
                       ///< ticks before it
  std::int64_t last_utc_ns = 0, resumed_utc_ns = 0;
  std::optional<double> boot_s;  ///< that passed in between; none where the computer was started
                                 ///< anew, or does not tell
  std::string boot_id;           ///< of the boot in which it goes on; may be empty
  std::string station_key;       ///< of the station that goes on, hexadecimal
  ResumedBy by;
  [[nodiscard]] double utc_s()
      const noexcept;  ///< that passed in between by the clock that people may set
};
struct RecordingMoved {    ///< the disk refused: from here on at another place
  std::string from;        ///< file name without folder
  std::int64_t ticks = 0;  ///< written there
  DiskRefusal why;
};
struct ServoGap {  ///< periods of the last second that passed without a tick
  std::int64_t periods = 0, times = 0, first_tick = 0;
};
struct Overruns {  ///< ticks of the last second that started more than a period late
  std::int64_t count = 0;
  double worst_late_ms = 0;
};
struct StylusSilent {  ///< no fresh pose for longer than the watchdog allows
  bool fault = false;  ///< it gave nonsense
};
struct StylusBack : NoDetail {};
struct PedalLost : NoDetail {};
struct PedalBack : NoDetail {};
struct ServoStopped : ServoStop {};
struct ServoDisagrees : NoDetail {
};  ///< servo and recording had different states, first at this tick
struct ServoLateness {
  RealTimeReport servo;
  std::int64_t first_disagreement = -1;
};
struct WorkAfterEnd {  ///< a motion file or operator went on after the end; not simulated, and
                       ///< nothing of it counts
  std::int64_t ticks = 0, pedal_ticks = 0;
};
enum class LockTry {
  close_asked,
  close_refused,
  close_granted,
  focus_lost,
  focus_back,
  screen_lost,
  screen_back,
  second_station,
  keyboard_added
};
struct LockAttempt {  ///< what was tried to leave an exam
  LockTry what{};
  bool by_supervisor = false;     ///< close_granted: a locked station's, by his code
  std::int32_t screens_left = 0;  ///< screen_lost and screen_back
  std::string keyboard = {};      ///< keyboard_added
};
struct OfficeHold : OfEntry {};  ///< the office paused the exam; `text`: why
struct OfficeHoldReleased : OfEntry {
};  ///< an invigilator let it go on while the office did not answer
struct Announced : OfEntry {};
struct AnnouncementRead : OfEntry {};
struct TutorialStep : OfStep {};  ///< in practice: it was done; from 1
struct MeasuredForce {            ///< by a load cell; no program of ours writes it
  std::int32_t every_ticks = 1;
  std::vector<double>
      f_n;  ///< along the contact normal, resisting positive; the first at the event's tick
};

using RunnerEvent = std::variant<StepStarted, StepCompleted, StepFailed, StepTimeUp, TimeUp,
                                 BurNotAllowed, OverSpeed, AimReached, Perforated, Finished,
                                 PauseStarted, PauseEnded, PauseRefused, HoldStarted, HoldEnded>;
using StationEvent =
    std::variant<RecordingGap, RecordingMoved, ServoGap, Overruns, StylusSilent, StylusBack,
                 PedalLost, PedalBack, ServoStopped, ServoDisagrees, ServoLateness, WorkAfterEnd,
                 LockAttempt, OfficeHold, OfficeHoldReleased, Announced, AnnouncementRead,
                 TutorialStep, MeasuredForce>;
template <class... R, class... S>
std::variant<R..., S...> either(std::variant<R...>, std::variant<S...>);
using Event = decltype(either(RunnerEvent(), StationEvent()));

/// Whether the motion gives it.
[[nodiscard]] inline bool is_runners(const Event& e) noexcept {
  return e.index() < std::variant_size_v<RunnerEvent>;
}
/// As files name it.
[[nodiscard]] const char* kind_of(const Event& event);
/// As people do: "pedal lost".
[[nodiscard]] Term word_of(const Event& event);

struct TimedEvent {
  std::int64_t tick = 0;  ///< of the exam, from 0
  Event event;
  /// Nothing when it is of another kind.
  template <class E>
  [[nodiscard]] const E* as() const noexcept {
    return std::get_if<E>(&event);
  }
};
/// The same kind at the same tick with the same values, as a file holds them.
[[nodiscard]] bool operator==(const TimedEvent& a, const TimedEvent& b);

/// An event as a file holds it.
struct EventText {
  std::string kind, detail_json;
};
/// Texts are put on one line.
[[nodiscard]] EventText encode(const Event& event);
/// The same event; throws Error at `where` for a kind that there is not, naming what is missing or
/// of another type, and for a text that `encode` does not write.
[[nodiscard]] Event decode(const EventText& text, const Where& where);

/// A function for each kind, for std::visit. Kinds with one answer are named in `AnyOf`: one that
/// is left out does not compile.
template <class... Answers>
struct EachKind : Answers... {
  using Answers::operator()...;
};
template <class... Answers>
EachKind(Answers...) -> EachKind<Answers...>;
template <class E, class... Kinds>
concept AnyOf = (std::same_as<E, Kinds> || ...);

}  // namespace cavum
