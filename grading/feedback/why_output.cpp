// What `grade --why` found, as JSON and as text.
#include <nlohmann/json.hpp>

#include "grading/feedback/why.h"
#include "grading/measures/motion.h"
#include "grading/result/loss.h"
#include "grading/result/result_json.h"

namespace cavum::grading {

namespace {
using Json = nlohmann::ordered_json;
}

Message WhyItem::what() const {
  return facts.size() == 1 ? facts[0].what() : msg("{}", List{words_of(facts), true});
}

Json to_json(const Why& w) {
  const auto& c = w.criterion;
  Json items = Json::array(), facts = Json::array();
  for (const Finding& f : c.facts) facts.push_back(fact_of(f));
  for (const auto& i : w.items) {
    const auto time = [](std::int64_t tick) {
      return tick < 0 ? Json(nullptr) : Json(rounded(static_cast<double>(tick) * k_tick_s));
    };
    const auto number = [](const std::optional<double>& v) {
      return v ? Json(rounded(*v)) : Json(nullptr);
    };
    items.push_back(
        {{"t_s", time(i.tick)},
         {"to_t_s", time(i.end_tick)},
         {"tick", i.tick < 0 ? Json(nullptr) : Json(i.tick)},
         {"to_tick", i.end_tick < 0 ? Json(nullptr) : Json(i.end_tick)},
         {"site_mm", i.site_mm ? Json::array({rounded(i.site_mm->x), rounded(i.site_mm->y),
                                              rounded(i.site_mm->z)})
                               : Json(nullptr)},
         {"amount", number(i.amount)},
         {"bound", number(i.bound)},
         {"unit", i.unit},
         {"points_lost", number(i.points_lost)},
         {"facts", i.facts}});
    items.back().update(Json(i.facts.at(0)));
    items.back()["text"] = i.what();
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
            {"facts", facts},
            {"reason", c.reason()}}},
          {"points_lost", rounded(c.max - c.points)},
          {"moments", items},
          {"moments_left_out", w.left_out},
          {"left_out_amount", rounded(w.left_out_amount)},
          {"left_out_points", rounded(w.left_out_points)}};
}

Lines to_text(const Why& w) {
  const auto& c = w.criterion;
  const scenarios::Measure measure = scenarios::known_measure(c.metric);
  const Value full = value_text(measure, w.full, 0, 3), none = value_text(measure, w.zero, 0, 3);
  Lines out;
  out.add(msg("{} ({}): {} of {} points, {} lost", c.id, c.metric, as_points(c.points, 2),
              as_points(c.max, 2), as_points(c.max - c.points, 2)));
  out.add(c.value ? msg("{}", value_text(measure, *c.value, c.bound, 3)) : msg("not measured"), 2);
  out.add(measure.reads == scenarios::Reads::yes_no
              ? msg("full marks at {}, none at {}", full, none)
          : w.full < w.zero ? msg("full marks at {} or less, none from {} on", full, none)
                            : msg("full marks at {} or more, none from {} down", full, none),
          2);
  out.add(c.reason(), 2);
  if (!w.items.empty()) out.gap();
  const auto seconds = [](std::int64_t tick) {
    return as_s(static_cast<double>(tick) * k_tick_s, 3);
  };
  for (const auto& i : w.items)
    out.row({i.tick < 0            ? Message()
             : i.end_tick > i.tick ? msg("{} to {}", seconds(i.tick), seconds(i.end_tick))
                                   : msg("{}", seconds(i.tick)),
             i.amount ? msg("{}", Number{*i.amount, unit_of(i.unit).value_or(Unit::none), 3,
                                         i.bound.value_or(0)})
                      : Message(),
             i.what(), i.site_mm ? msg("{}", *i.site_mm) : Message(),
             i.tick >= 0 ? msg("tick {}", i.tick) : Message(),
             i.points_lost ? msg("{} points", as_points(*i.points_lost, 2)) : Message()},
            2);
  if (w.left_out == 0) return out;
  const Number amount{w.left_out_amount, unit_of(w.items.front().unit).value_or(Unit::none), 3};
  out.add(
      w.left_out_points > 0
          ? msgn("{} smaller moment, {} in all, {} points",
                 "{} smaller moments, {} in all, {} points", static_cast<std::int64_t>(w.left_out),
                 w.left_out, amount, as_points(w.left_out_points, 2))
          : msgn("{} smaller moment, {} in all", "{} smaller moments, {} in all",
                 static_cast<std::int64_t>(w.left_out), w.left_out, amount),
      2);
  return out;
}

}  // namespace cavum::grading
