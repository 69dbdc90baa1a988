// What `grade --why` found, as JSON and as text.
#include <fmt/core.h>

#include <algorithm>
#include <nlohmann/json.hpp>

#include "engine/base/kept.h"
#include "engine/base/text.h"
#include "grading/measures/motion.h"
#include "grading/result/loss.h"
#include "grading/result/result_json.h"
#include "grading/words/why.h"

namespace cavum::grading {

namespace {
using Json = nlohmann::ordered_json;
}

Json to_json(const Why& w) {
  const auto& c = w.criterion;
  Json items = Json::array();
  for (const auto& i : w.items) {
    const auto time = [](std::int64_t tick) { return tick < 0 ? Json(nullptr) : Json(rounded(static_cast<double>(tick) * k_tick_s)); };
    const auto number = [](const std::optional<double>& v) { return v ? Json(rounded(*v)) : Json(nullptr); };
    items.push_back({{"t_s", time(i.tick)},
                     {"to_t_s", time(i.end_tick)},
                     {"tick", i.tick < 0 ? Json(nullptr) : Json(i.tick)},
                     {"to_tick", i.end_tick < 0 ? Json(nullptr) : Json(i.end_tick)},
                     {"site_mm", i.site_mm ? Json::array({rounded(i.site_mm->x), rounded(i.site_mm->y), rounded(i.site_mm->z)}) : Json(nullptr)},
                     {"amount", number(i.amount)},
                     {"bound", number(i.bound)},
                     {"unit", i.unit},
                     {"points_lost", number(i.points_lost)},
                     {"what", i.what}});
  }
  return {{"criterion",
           {{"id", c.id},
            {"title", c.title},
            {"metric", c.metric},
            {"value", c.value ? Json(rounded(*c.value)) : Json(nullptr)},
            {"unit", c.unit},
            {"bound", rounded(c.bound)},
            {"full", rounded(w.full)},
            {"zero", rounded(w.zero)},
            {"points", rounded(c.points)},
            {"max", rounded(c.max)},
            {"critical_failed", c.critical_failed},
            {"reason", c.reason}}},
          {"points_lost", rounded(c.max - c.points)},
          {"moments", items},
          {"moments_left_out", w.left_out},
          {"left_out_amount", rounded(w.left_out_amount)},
          {"left_out_points", rounded(w.left_out_points)}};
}

std::string to_text(const Why& w) {
  const auto& c = w.criterion;
  const scenarios::Measure measure = scenarios::known_measure(c.metric);
  const std::string full = value_text(measure, w.full, 0, 3), none = value_text(measure, w.zero, 0, 3);
  std::string s = fmt::format("{} ({}): {} of {} points, {} lost\n  {}; {}\n  {}\n", kept(c.id), kept(c.metric), fixed(c.points, 2), fixed(c.max, 2),
                              fixed(c.max - c.points, 2), c.value ? value_text(measure, *c.value, c.bound, 3) : std::string("not measured"),
                              measure.reads == scenarios::Reads::yes_no ? fmt::format("full marks at {}, none at {}", full, none)
                              : w.full < w.zero                         ? fmt::format("full marks at {} or less, none from {} on", full, none)
                                                                        : fmt::format("full marks at {} or more, none from {} down", full, none),
                              c.reason);
  if (!w.items.empty()) s += "\n";
  for (const auto& i : w.items) {
    std::string time;
    if (i.tick >= 0) {
      time = fixed(static_cast<double>(i.tick) * k_tick_s, 3);
      if (i.end_tick > i.tick) time += " to " + fixed(static_cast<double>(i.end_tick) * k_tick_s, 3);
      time += " s";
    }
    time.resize(std::max<std::size_t>(time.size(), 22), ' ');
    const std::string amount = i.amount ? amount_text(*i.amount, i.bound.value_or(0), 3, i.unit) : "";
    s += fmt::format("  {}  ", time);
    if (i.what.starts_with("of "))
      s += fmt::format("{} {}", amount, i.what);
    else
      s += i.what + (amount.empty() ? "" : (i.what.ends_with("after") || i.what.ends_with("for") ? " " : ": ") + amount);
    if (i.site_mm) s += ", at " + kept(place(*i.site_mm));
    if (i.tick >= 0) s += fmt::format(", tick {}", i.tick);
    if (i.points_lost) s += fmt::format(", {} points", fixed(*i.points_lost, 2));
    s += "\n";
  }
  if (w.left_out > 0)
    s += fmt::format("  and {} smaller moments, {} in all{}\n", w.left_out, fixed(w.left_out_amount, 3),
                     w.left_out_points > 0 ? fmt::format(", {} points", fixed(w.left_out_points, 2)) : "");
  return s;
}

}  // namespace cavum::grading
