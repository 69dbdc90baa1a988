#include "scenarios/file/accommodations.h"

#include <array>
#include <charconv>

#include "engine/base/error.h"

namespace cavum::scenarios {
namespace {

constexpr const char* k_percent = "accommodation.extra_time_percent";
constexpr const char* k_seconds = "accommodation.extra_time_s";
constexpr const char* k_left = "accommodation.left_handed";
constexpr const char* k_contrast = "accommodation.high_contrast";
constexpr double k_max_percent = 400, k_max_s = 36000;

std::string in_full(double v) {  // the shortest text that reads back as the same number
  std::array<char, 32> text{};
  const auto end = std::to_chars(text.data(), text.data() + text.size(), v).ptr;
  return {text.data(), end};
}

double number_in(const std::string& text, double most, const Where& where) {
  double v = -1;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), v);
  if (error != std::errc() || end != text.data() + text.size() || !(v >= 0 && v <= most))
    throw Error(where, msg("'{}' is no extra time", text), msg("use 0 to {}", as_number(most)));
  return v;
}

bool truth_in(const std::string& text, const Where& where) {
  if (text != "true" && text != "false")
    throw Error(where, msg("'{}' is neither true nor false", text), msg("use one of them"));
  return text == "true";
}

}  // namespace

void require_sound(const Grant& g, const Where& where) {
  const auto within = [&](const std::optional<double>& v, double most, const Message& name) {
    if (v && !(*v >= 0 && *v <= most))
      throw Error(where, msg("{} cannot be {}", name, as_number(*v)),
                  msg("use 0 to {}", as_number(most)));
  };
  within(g.extra_time_percent, k_max_percent, msg("extra time in percent"));
  within(g.extra_time_s, k_max_s, msg("extra time in seconds"));
  if (g.extra_time_percent && *g.extra_time_percent > 0 && *g.extra_time_percent < 1)
    throw Error(
        where,
        msg("extra time of {} is less than one percent",
            as_percent(*g.extra_time_percent, k_as_needed)),
        msg("say {} for an exam that is longer by {} percent",
            as_number(100 * *g.extra_time_percent), as_number(100 * *g.extra_time_percent)));
}

std::vector<std::pair<std::string, std::string>> notes_of(const Grant& g) {
  std::vector<std::pair<std::string, std::string>> notes;
  if (g.extra_time_percent) notes.emplace_back(k_percent, in_full(*g.extra_time_percent));
  if (g.extra_time_s) notes.emplace_back(k_seconds, in_full(*g.extra_time_s));
  if (g.left_handed) notes.emplace_back(k_left, *g.left_handed ? "true" : "false");
  if (g.high_contrast) notes.emplace_back(k_contrast, *g.high_contrast ? "true" : "false");
  return notes;
}

Accommodations granted(const Accommodations& by_file,
                       const std::vector<std::pair<std::string, std::string>>& notes,
                       const Where& where) {
  Accommodations a = by_file;
  for (const auto& [key, value] : notes) {
    if (key == k_percent) a.extra_time_percent = number_in(value, k_max_percent, where);
    if (key == k_seconds) a.extra_time_s = number_in(value, k_max_s, where);
    if (key == k_left) a.left_handed = truth_in(value, where);
    if (key == k_contrast) a.high_contrast = truth_in(value, where);
  }
  return a;
}

Message accommodations_text(const Accommodations& a) {
  List list;
  const Number percent = as_percent(a.extra_time_percent, k_as_needed),
               seconds = as_s(a.extra_time_s, k_as_needed);
  if (a.extra_time_percent > 0 && a.extra_time_s > 0)
    list.items.push_back(msg("{} and {} extra time", percent, seconds));
  else if (a.extra_time_percent > 0 || a.extra_time_s > 0)
    list.items.push_back(msg("{} extra time", a.extra_time_percent > 0 ? percent : seconds));
  if (a.left_handed) list.items.push_back(msg("left-handed"));
  if (a.high_contrast) list.items.push_back(msg("high-contrast colours"));
  return list.items.empty() ? Message() : msg("{}", list);
}

}  // namespace cavum::scenarios
