#include "engine/session/event.h"

#include <algorithm>
#include <array>
#include <nlohmann/json.hpp>
#include <string_view>
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

/// Kinds as people read them: the catalogue takes them from here.
// clang-format off
constexpr std::array<std::string_view, std::variant_size_v<Event>> k_kind_words{
    said("step started"), said("step completed"), said("step failed"), said("step time limit"), said("time limit"), said("over speed"),
    said("aim reached"), said("perforation"), said("pause started"), said("pause ended"), said("hold started"), said("hold ended"),
    said("stylus back"), said("pedal lost"), said("pedal back"), said("servo disagrees"), said("office hold"), said("office hold released"),
    said("announcement"), said("announcement read"), said("tutorial"), said("bur not allowed"), said("finished"), said("pause refused"),
    said("gap"), said("moved"), said("servo gap"), said("overruns"), said("stylus silent"), said("servo stopped"), said("servo lateness"),
    said("late work"), said("lock"), said("measured force")};
// clang-format on
template <class... Kinds>
constexpr bool all_have_words(std::type_identity<std::variant<Kinds...>>) {
  constexpr auto letter = [](char a, char b) { return a == b || (a == '_' && b == ' '); };
  constexpr auto has_words = [=](std::string_view kind) {
    return std::ranges::any_of(k_kind_words, [&](std::string_view words) { return std::ranges::equal(kind, words, letter); });
  };
  return (has_words(Kinds::k_kind) && ...);
}
static_assert(all_have_words(std::type_identity<Event>()));

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
bool read_kind(const std::string& kind, const json& detail, const JsonPlace& at, std::variant<Kinds...>& out) {
  return ((kind == Kinds::k_kind && (read_json_value(detail, at, out.template emplace<Kinds>()), true)) || ...);
}

}  // namespace

double RecordingGap::utc_s() const noexcept {  // whatever a file says, the difference wraps around instead of overflowing
  return static_cast<double>(static_cast<std::int64_t>(static_cast<std::uint64_t>(resumed_utc_ns) - static_cast<std::uint64_t>(last_utc_ns))) * 1e-9;
}

const char* kind_of(const Event& event) {
  return std::visit([](const auto& e) { return std::remove_cvref_t<decltype(e)>::k_kind; }, event);
}

bool operator==(const TimedEvent& a, const TimedEvent& b) {
  return a.tick == b.tick && a.event.index() == b.event.index() && detail_of(a.event) == detail_of(b.event);
}

EventText encode(const Event& event) { return {kind_of(event), detail_of(event).dump()}; }

Event decode(const EventText& text, const Where& where) {
  const Message at = msg("{}, '{}'", where, one_line(text.kind));
  const json was = parse_json(text.detail_json, at, k_event_limits);
  const JsonSource source{at, msg("use an intact copy")};
  Event event;
  if (!read_kind(text.kind, was, {source}, event))
    throw Error(FileError::unknown, at, msg("is no kind of event"), msg("use an intact copy, or the program that recorded it"));
  if (detail_of(event).dump() != text.detail_json)
    throw Error(FileError::malformed, at, msg("its detail is not written as docs/formats/session.md says"), msg("use an intact copy"));
  return event;
}

}  // namespace cavum
