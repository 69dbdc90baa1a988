#include "engine/session/event.h"

#include <fmt/core.h>

#include <algorithm>
#include <nlohmann/json.hpp>
#include <span>

#include "engine/base/file_error.h"
#include "engine/base/json_fields.h"
#include "engine/base/json_reader.h"
#include "engine/base/text.h"

namespace cavum {
namespace {

using nlohmann::json;

constexpr JsonLimits k_event_limits{.depth = 6};
constexpr std::array k_lock_names{"close_asked", "close_refused", "close_granted",  "focus_lost",    "focus_back",
                                  "screen_lost", "screen_back",   "second_station", "keyboard_added"};

/// Kinds as people read them: the catalogue takes them from here.
[[maybe_unused]] constexpr std::array k_kind_words{said("step started"),
                                                   said("step completed"),
                                                   said("step failed"),
                                                   said("step time limit"),
                                                   said("time limit"),
                                                   said("over speed"),
                                                   said("aim reached"),
                                                   said("perforation"),
                                                   said("pause started"),
                                                   said("pause ended"),
                                                   said("hold started"),
                                                   said("hold ended"),
                                                   said("stylus back"),
                                                   said("pedal lost"),
                                                   said("pedal back"),
                                                   said("servo disagrees"),
                                                   said("office hold"),
                                                   said("office hold released"),
                                                   said("announcement"),
                                                   said("announcement read"),
                                                   said("tutorial"),
                                                   said("point not allowed"),
                                                   said("finished"),
                                                   said("pause refused"),
                                                   said("gap"),
                                                   said("moved"),
                                                   said("servo gap"),
                                                   said("overruns"),
                                                   said("stylus silent"),
                                                   said("servo stopped"),
                                                   said("servo lateness"),
                                                   said("late work"),
                                                   said("lock"),
                                                   said("measured force")};

// Each kind's members by name: what is written and what is read.
void members(auto&, NoDetail&) {}
void members(auto& f, OfStep& e) { f("step", e.step); }
void members(auto& f, OfPause& e) { f("pause", e.pause); }
void members(auto& f, OfTissue& e) { f("site_mm", e.site_mm), f("tissue", e.tissue); }
void members(auto& f, OfEntry& e) { f("entry", e.entry), f("text", e.text); }
void members(auto& f, PointNotAllowed& e) { f("point", e.point); }
void members(auto& f, Finished& e) { f("how", e.how, k_finish_names); }
void members(auto& f, PauseRefused& e) { f("pauses", e.pauses); }
void members(auto& f, MotionSource& s) { f("kind", s.kind, k_source_kinds), f("name", s.name), f("serial", s.serial); }
void members(auto& f, ResumedBy& b) {
  f("device", b.device), f("notes", b.notes), f("source", b.source), f("ticket_remembered", b.ticket_remembered);
}
void members(auto& f, RecordingGap& e) {
  f("boot_id", e.boot_id), f("boot_s", e.boot_s), f("by", e.by), f("last_utc_ns", e.last_utc_ns), f("resumed_utc_ns", e.resumed_utc_ns);
  f("station_key", e.station_key);
}
void members(auto& f, RecordingMoved& e) { f("from", e.from), f("ticks", e.ticks), f("why", e.why); }
void members(auto& f, ServoGap& e) { f("first_tick", e.first_tick), f("periods", e.periods), f("times", e.times); }
void members(auto& f, Overruns& e) { f("count", e.count), f("worst_late_ms", e.worst_late_ms); }
void members(auto& f, StylusSilent& e) { f("fault", e.fault); }
void members(auto& f, ServoStopped& e) { f("error", e.error), f("why", e.why, k_servo_end_names); }
void members(auto& f, Lateness& l) { f("counts", l.counts), f("sum_ns", l.sum_ns), f("ticks", l.ticks), f("worst_ns", l.worst_ns); }
void members(auto& f, RealTimeReport& r) {
  f("ticks", r.ticks), f("overruns", r.overruns), f("made_up", r.made_up), f("skipped_late", r.skipped_late), f("skipped_full", r.skipped_full);
  f("guard_cuts", r.guard_cuts), f("lateness", r.lateness), f("work", r.work), f("sched_fifo", r.fifo), f("sched_fifo_refused", r.fifo_refused);
  f("memory_locked", r.memory_locked), f("memory_refused", r.memory_refused), f("ended", r.why, k_servo_end_names), f("error", r.error);
}
void members(auto& f, ServoLateness& e) { f("first_disagreement", e.first_disagreement), f("servo", e.servo); }
void members(auto& f, WorkAfterEnd& e) { f("pedal_ticks", e.pedal_ticks), f("ticks", e.ticks); }
void members(auto& f, LockAttempt& e) {
  f("by_supervisor", e.by_supervisor), f("keyboard", e.keyboard), f("screens_left", e.screens_left), f("what", e.what, k_lock_names);
}
void members(auto& f, MeasuredForce& e) { f("every_ticks", e.every_ticks), f("f_n", e.f_n); }

struct EventWriter {
  json out = json::object();

  void operator()(const char* key, const auto& v) { out[key] = written(v); }
  template <class T>
  void operator()(const char* key, T v, std::span<const char* const> names) {
    out[key] = names[static_cast<std::size_t>(v)];
  }
  template <class T>
  static json written(T v) {
    if constexpr (requires(EventWriter w) { members(w, v); }) {
      EventWriter w;
      members(w, v);
      return w.out;
    } else if constexpr (std::is_same_v<T, std::string>) {
      return one_line(v);
    } else if constexpr (std::is_same_v<T, Vec3>) {
      return {v.x, v.y, v.z};
    } else if constexpr (std::is_same_v<T, Notes>) {
      json all = json::object();
      for (const auto& [key, value] : v) all[one_line(key)] = one_line(value);
      return all;
    } else if constexpr (requires { v.has_value(); }) {
      return v ? written(*v) : json();
    } else {
      return v;
    }
  }
};

/// What is not there, or of another type, stays as it is: decode() finds that it differs.
struct EventReader {
  const json& from;

  void operator()(const char* key, auto& v) const { read(member_of(from, key), v); }
  template <class T>
  void operator()(const char* key, T& v, std::span<const char* const> names) const {
    const auto found = std::find(names.begin(), names.end(), text_in(from, key));
    v = static_cast<T>(found == names.end() ? 0 : found - names.begin());
  }
  template <class T>
  static void read(const json& m, T& v) {
    if constexpr (requires(const EventReader r) { members(r, v); }) {
      const EventReader part{m};
      members(part, v);
    } else if constexpr (std::is_same_v<T, Notes>) {
      for (const auto& [key, value] : m.items()) read(value, v.emplace_back(key, "").second);
    } else if constexpr (requires { v.has_value(); }) {
      if (!m.is_null()) read(m, v.emplace());
    } else if constexpr (std::is_same_v<T, Vec3>) {
      std::vector<double> p;
      read(m, p);
      if (p.size() == 3) v = {p[0], p[1], p[2]};
    } else if constexpr (std::is_same_v<T, std::vector<double>>) {
      v.resize(m.is_array() ? m.size() : 0);
      for (std::size_t i = 0; i < v.size(); ++i) read(m[i], v[i]);
    } else if constexpr (requires { v.fill(0); }) {
      for (std::size_t i = 0; m.is_array() && i < std::min(m.size(), v.size()); ++i) read(m[i], v[i]);
    } else {
      const bool fits = std::is_same_v<T, std::string>    ? m.is_string()
                        : std::is_same_v<T, bool>         ? m.is_boolean()
                        : std::is_floating_point_v<T>     ? m.is_number()
                        : std::is_same_v<T, std::int64_t> ? m.is_number_integer()
                                                          : m.is_number_unsigned();
      if (fits) v = m.get<T>();
    }
  }
};

/// True when it is one of these kinds.
template <class... Kinds>
bool read_kind(const std::string& kind, const json& detail, std::variant<Kinds...>& out) {
  return ((kind == Kinds::k_kind && (EventReader::read(detail, out.template emplace<Kinds>()), true)) || ...);
}

json detail_of(const Event& event) {
  return std::visit([](const auto& e) { return EventWriter::written(e); }, event);
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

Event decode(const EventText& text, const std::string& where) {
  const std::string at = fmt::format("{}, '{}'", where, one_line(text.kind));
  const json was = parse_json(text.detail_json, at, k_event_limits);
  Event event;
  if (!read_kind(text.kind, was, event))
    throw Error(FileError::unknown, Name{at}, msg("is no kind of event"), msg("use an intact copy, or the program that recorded it"));
  const json is = detail_of(event);
  for (const auto& [key, value] : is.items())
    if (member_of(was, key.c_str()) != value)
      throw Error(FileError::missing, Name{at}, msg("its '{}' is missing, or is no such value", key), msg("use an intact copy"));
  if (is.dump() != text.detail_json)
    throw Error(FileError::malformed, Name{at}, msg("its detail is not written as docs/formats/session.md says"), msg("use an intact copy"));
  return event;
}

}  // namespace cavum
