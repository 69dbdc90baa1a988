#include "engine/session/event.h"

#include <algorithm>
#include <array>
#include <nlohmann/json.hpp>
#include <type_traits>

#include "engine/base/file_error.h"
#include "engine/base/json_reader.h"
#include "engine/base/json_struct.h"
#include "engine/base/text.h"
#include "engine/physics/servo/real_time_json.h"
#include "engine/session/source_json.h"

namespace cavum {

constexpr auto names_of(Finish) { return k_finish_names; }
constexpr auto names_of(LockTry) {
  return std::array{"close_asked", "close_refused", "close_granted",  "focus_lost",    "focus_back",
                    "screen_lost", "screen_back",   "second_station", "keyboard_added"};
}

// clang-format off
// What each kind has, in a file.
void json_fields(auto&, JsonOf<NoDetail> auto&) {}
CAVUM_JSON_OF(OfStep, (step))
CAVUM_JSON_OF(OfPause, (pause))
CAVUM_JSON_OF(OfTissue, (site_mm), (tissue))
CAVUM_JSON_OF(OfEntry, (entry), (text))
CAVUM_JSON_OF(BurNotAllowed, (bur))
CAVUM_JSON_OF(Finished, (how))
CAVUM_JSON_OF(PauseRefused, (pauses))
CAVUM_JSON_OF(ResumedBy, (notes), (source), (ticket_remembered))
CAVUM_JSON_OF(RecordingGap, (boot_id), (boot_s), (by), (last_utc_ns), (resumed_utc_ns), (station_key))
CAVUM_JSON_OF(DiskRefusal, (error), (fault))
CAVUM_JSON_OF(RecordingMoved, (from), (ticks), (why))
CAVUM_JSON_OF(ServoGap, (first_tick), (periods), (times))
CAVUM_JSON_OF(Overruns, (count), (worst_late_ms))
CAVUM_JSON_OF(StylusSilent, (fault))
CAVUM_JSON_OF(Lateness, (counts), (sum_ns), (ticks), (worst_ns))
CAVUM_JSON_OF(RealTimeReport, (ticks), (overruns), (made_up), (skipped_late), (skipped_full), (guard_cuts), (lateness), (work), (fifo), (memory), (ended))
CAVUM_JSON_OF(ServoLateness, (first_disagreement), (servo))
CAVUM_JSON_OF(WorkAfterEnd, (pedal_ticks), (ticks))
CAVUM_JSON_OF(LockAttempt, (by_supervisor), (keyboard), (screens_left), (what))
CAVUM_JSON_OF(MeasuredForce, (every_ticks), (f_n))
// clang-format on

namespace {

using nlohmann::json;

constexpr JsonLimits k_event_limits{.depth = 6};

template <class E, class... Kinds>
constexpr std::size_t place_in(std::type_identity<std::variant<Kinds...>>) {
  std::size_t place = 0;
  static_cast<void>(((std::is_same_v<E, Kinds> || (++place, false)) || ...));
  return place;
}
template <class E>
using Is = std::type_identity<E>;

struct KindRow {
  const char *name = nullptr, *words = nullptr;
};
/// What each kind is called, in files and by people; by its place in Event.
constexpr auto k_kinds = [] {
  std::array<KindRow, std::variant_size_v<Event>> rows;
  const auto row = [&rows]<class E>(Is<E>, const char* name, const char* words) {
    rows[place_in<E>(Is<Event>())] = {name, words};
  };
  row(Is<StepStarted>(), "step_started", noop("step started"));
  row(Is<StepCompleted>(), "step_completed", noop("step completed"));
  row(Is<StepFailed>(), "step_failed", noop("step failed"));
  row(Is<StepTimeUp>(), "step_time_limit", noop("step time limit"));
  row(Is<TimeUp>(), "time_limit", noop("time limit"));
  row(Is<BurNotAllowed>(), "bur_not_allowed", noop("bur not allowed"));
  row(Is<OverSpeed>(), "over_speed", noop("over speed"));
  row(Is<AimReached>(), "aim_reached", noop("aim reached"));
  row(Is<Perforated>(), "perforation", noop("perforation"));
  row(Is<Finished>(), "finished", noop("finished"));
  row(Is<PauseStarted>(), "pause_started", noop("pause started"));
  row(Is<PauseEnded>(), "pause_ended", noop("pause ended"));
  row(Is<PauseRefused>(), "pause_refused", noop("pause refused"));
  row(Is<HoldStarted>(), "hold_started", noop("hold started"));
  row(Is<HoldEnded>(), "hold_ended", noop("hold ended"));
  row(Is<RecordingGap>(), "gap", noop("gap"));
  row(Is<RecordingMoved>(), "moved", noop("moved"));
  row(Is<ServoGap>(), "servo_gap", noop("servo gap"));
  row(Is<Overruns>(), "overruns", noop("overruns"));
  row(Is<StylusSilent>(), "stylus_silent", noop("stylus silent"));
  row(Is<StylusBack>(), "stylus_back", noop("stylus back"));
  row(Is<PedalLost>(), "pedal_lost", noop("pedal lost"));
  row(Is<PedalBack>(), "pedal_back", noop("pedal back"));
  row(Is<ServoStopped>(), "servo_stopped", noop("servo stopped"));
  row(Is<ServoDisagrees>(), "servo_disagrees", noop("servo disagrees"));
  row(Is<ServoLateness>(), "servo_lateness", noop("servo lateness"));
  row(Is<WorkAfterEnd>(), "late_work", noop("late work"));
  row(Is<LockAttempt>(), "lock", noop("lock"));
  row(Is<OfficeHold>(), "office_hold", noop("office hold"));
  row(Is<OfficeHoldReleased>(), "office_hold_released", noop("office hold released"));
  row(Is<Announced>(), "announcement", noop("announcement"));
  row(Is<AnnouncementRead>(), "announcement_read", noop("announcement read"));
  row(Is<TutorialStep>(), "tutorial", noop("tutorial"));
  row(Is<MeasuredForce>(), "measured_force", noop("measured force"));
  return rows;
}();
static_assert(std::ranges::none_of(k_kinds,
                                   [](const KindRow& row) { return row.name == nullptr; }));

/// Texts and names on one line.
json on_lines(const json& j) {
  if (j.is_string()) return one_line(j.get<std::string>());
  if (!j.is_structured()) return j;
  json out = j.is_array() ? json::array() : json::object();
  for (const auto& [key, value] : j.items())
    if (j.is_array())
      out.push_back(on_lines(value));
    else
      out[one_line(key)] = on_lines(value);
  return out;
}

json detail_of(const Event& event) {
  return std::visit([](const auto& e) { return on_lines(to_json_value(e)); }, event);
}

/// True when it is one of these kinds.
template <class... Kinds>
bool read_kind(const std::string& kind, const json& detail, const JsonLocation& at,
               std::variant<Kinds...>& out) {
  return ((kind == k_kinds[place_in<Kinds>(Is<Event>())].name &&
           (read_json_value(detail, at, out.template emplace<Kinds>()), true)) ||
          ...);
}

}  // namespace

double RecordingGap::utc_s()
    const noexcept {  // whatever a file says, the difference wraps around instead of overflowing
  return static_cast<double>(static_cast<std::int64_t>(static_cast<std::uint64_t>(resumed_utc_ns) -
                                                       static_cast<std::uint64_t>(last_utc_ns))) *
         1e-9;
}

const char* kind_of(const Event& event) { return k_kinds[event.index()].name; }
Term word_of(const Event& event) { return {k_kinds[event.index()].words}; }

bool operator==(const TimedEvent& a, const TimedEvent& b) {
  return a.tick == b.tick && a.event.index() == b.event.index() &&
         detail_of(a.event) == detail_of(b.event);
}

EventText encode(const Event& event) { return {kind_of(event), detail_of(event).dump()}; }

Event decode(const EventText& text, const Where& where) {
  const Message at = msg("{}, '{}'", where, one_line(text.kind));
  const json was = parse_json(text.detail_json, at, k_event_limits);
  const JsonSource source{at, msg("use an intact copy")};
  Event event;
  if (!read_kind(text.kind, was, {source}, event))
    throw Error(FileError::unknown, at, msg("is no kind of event"),
                msg("use an intact copy, or the program that recorded it"));
  if (detail_of(event).dump() != text.detail_json)
    throw Error(FileError::malformed, at,
                msg("its detail is not written as docs/formats/session.md says"),
                msg("use an intact copy"));
  return event;
}

}  // namespace cavum
