#include "ui/station/author_screen.h"

#define GLFW_INCLUDE_NONE
#include <GLFW/glfw3.h>
#include <fmt/core.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>

#include "engine/base/error.h"
#include "ui/language/say.h"
#include "ui/parts/scenario_words.h"
#include "ui/station/window.h"

namespace cavum::station {
namespace {

/// Runs an edit; what cannot be done is said.
template <class Edit>
void attempt(const AuthorContext& c, bool pull, const Edit& edit) {
  if (!pull) c.document.rest();
  try {
    edit();
    c.state.message = {};
  } catch (const Error& e) {
    c.state.message = e.message();
  }
  if (!pull) c.document.rest();
}

template <class Edit>
void change(const AuthorContext& c, const std::string& name, bool pull, const Edit& edit) {
  attempt(c, pull, [&] { c.document.make(edit(), name); });
}

void top_bar(const AuthorContext& c, ImVec2 size, AuthorWish& wish) {
  const Theme& t = c.screen.theme;
  ImGui::PushStyleVar(ImGuiStyleVar_WindowPadding, {t.px(20), t.px(10)});
  begin_area(t, "author top", {0, 0}, size, true);
  ImGui::PopStyleVar();
  const std::array<std::pair<Message, AuthorWish>, 3> choices{
      {{msg("Undo (Ctrl Z)"), AuthorWish::undo},
       {msg("Redo (Ctrl Y)"), AuthorWish::redo},
       {msg("Save (Ctrl S)"), AuthorWish::save}}};
  float buttons = 0;
  for (const auto& [label, chosen] : choices)
    buttons += ImGui::CalcTextSize(tr(label).c_str()).x + 2 * ImGui::GetStyle().FramePadding.x +
               ImGui::GetStyle().ItemSpacing.x;
  ImGui::BeginChild("file", {size.x - buttons - t.px(50), 0}, false, ImGuiWindowFlags_NoScrollbar);
  quiet_text(t, c.document.unsaved() ? msg("Authoring    {}    NOT SAVED", c.document.path())
                                     : msg("Authoring    {}    saved", c.document.path()));
  wrapped_text(Name{ui::text_of(c.screen.scenario, c.screen.scenario.title)});
  ImGui::EndChild();
  ImGui::SameLine();
  ImGui::BeginChild("buttons", {0, 0}, false, ImGuiWindowFlags_NoScrollbar);
  for (const auto& [label, chosen] : choices) {
    if (side_button(t, label)) wish = chosen;
    ImGui::SameLine();
  }
  ImGui::EndChild();
  end_area();
}

void zone_list(const AuthorContext& c) {
  const Theme& t = c.screen.theme;
  AuthorState& s = c.state;
  ImDrawList& draw = *ImGui::GetWindowDrawList();
  for (std::size_t i = 0; i < c.zones.size(); ++i) {
    const AuthorZone& zone = c.zones[i];
    const ImVec2 at = ImGui::GetCursorScreenPos();
    const auto colour = layer_colour(zone.layer);
    const float side = ImGui::GetTextLineHeight();
    draw.AddRectFilled(at, {at.x + side, at.y + side},
                       IM_COL32(colour[0], colour[1], colour[2], 255), t.px(3));
    ImGui::Dummy({side, side});
    ImGui::SameLine();
    ImGui::PushID(static_cast<int>(i));
    const Message label = zone.line > 0 ? msg("{}   line {}", zone.title, zone.line) : zone.title;
    if (ImGui::Selectable(shown_label(label).c_str(), s.zone == i)) {
      s.zone = i;
      s.point = s.number = 0;
    }
    ImGui::PopID();
  }
}

void numbers(const AuthorContext& c) {
  const Theme& t = c.screen.theme;
  AuthorState& s = c.state;
  const AuthorZone& zone = c.zones[s.zone];
  if (zone.numbers.empty())
    quiet_text(t, msg("Its shape comes from a file; nothing of it is changed here."));
  for (std::size_t i = 0; i < zone.numbers.size(); ++i) {
    const AuthorNumber& n = zone.numbers[i];
    const bool chosen = s.number == i;
    if (chosen) ImGui::PushStyleColor(ImGuiCol_Text, t.accent);
    text_line(chosen ? msg("> {}", n.label) : msg("   {}", n.label));
    if (chosen) ImGui::PopStyleColor();
    ImGui::PushID(n.place.c_str());
    ImGui::SetNextItemWidth(ImGui::GetContentRegionAvail().x);
    auto value = static_cast<float>(n.value);
    const std::string format = fmt::format("%.3f {}", unit_sign(n.unit));
    if (ImGui::DragFloat("##number", &value, 0.01F, static_cast<float>(n.low),
                         static_cast<float>(n.high), format.c_str()))
      author_set_number(c, n, static_cast<double>(value), true);
    if (ImGui::IsItemActivated()) s.number = i;
    if (ImGui::IsItemDeactivated()) c.document.rest();
    ImGui::PopID();
  }
  if (s.point < zone.points_mm.size()) {
    const Vec3 p = zone.points_mm[s.point];
    wrapped_text(msg("Point {} of {}:  x {}, y {}", s.point + 1, zone.points_mm.size(),
                     as_mm(p.x, k_as_needed), as_mm(p.y, k_as_needed)));
  }
}

void side_panel(const AuthorContext& c, ImVec2 at, ImVec2 size) {
  const Theme& t = c.screen.theme;
  AuthorState& s = c.state;
  begin_area(t, "author side", at, size, true);
  const float half = (ImGui::GetContentRegionAvail().x - ImGui::GetStyle().ItemSpacing.x) / 2;
  for (const bool landmarks : {false, true}) {
    if (s.by_landmarks == landmarks)
      ImGui::PushStyleColor(ImGuiCol_Button, ImGui::GetStyleColorVec4(ImGuiCol_Header));
    const bool chosen = s.by_landmarks == landmarks;
    if (side_button(t, landmarks ? msg("Landmarks (L)") : msg("Zones (L)"), half))
      s.by_landmarks = landmarks;
    if (chosen) ImGui::PopStyleColor();
    if (!landmarks) ImGui::SameLine();
  }
  if (s.by_landmarks) {
    s.landmarks_shown = true;
    landmark_list(c);
  } else {
    zone_list(c);
    ImGui::Separator();
    if (s.zone < c.zones.size()) numbers(c);
  }
  ImGui::Separator();
  push_font(Font::small);  // two beside each other in any language
  for (std::size_t i = 0; i < k_author_layers; ++i) {
    const Message label = msg("{} (F{})", word_of(static_cast<AuthorLayer>(i)), i + 1);
    ImGui::PushID(static_cast<int>(i));
    s.shown_differs = ImGui::Checkbox(shown_label(label).c_str(), &s.shown[i]) || s.shown_differs;
    ImGui::PopID();
    if (i % 2 == 0) ImGui::SameLine(size.x / 2);
  }
  if (ImGui::Checkbox(shown_label(msg("landmarks (F6)")).c_str(), &s.landmarks_shown) &&
      !s.landmarks_shown)
    s.by_landmarks = false;
  pop_font();
  quiet_text(
      t,
      s.by_landmarks
          ? msg("Tab: landmark.  Arrows or mouse: move it on the surface, 0.1 mm, with Shift 0.01.  X: back where it was found.")
          : msg("Tab: zone.  , and .: point.  Arrows: move it 0.1 mm, with Shift 0.01.  I: new point, X: take it out.  [ and ]: "
                "size, PgUp and PgDn: larger, smaller."));
  quiet_text(
      t,
      msg("C: clear or opaque tooth.  View: 1 to 5, W A S D, + and -, right mouse button.  F5: read the files again.  Esc: close."));
  end_area();
}

List verdict(const AuthorContext& c) {
  const auto warnings = std::count_if(c.problems.begin(), c.problems.end(),
                                      [](const scenarios::Problem& p) { return p.warning; });
  const auto mistakes = static_cast<std::ptrdiff_t>(c.problems.size()) - warnings;
  List facts{{}, true};
  if (mistakes > 0) facts.items.push_back(msgn("{} mistake", "{} mistakes", mistakes, mistakes));
  if (c.busy) {
    facts.items.push_back(msg("checking ..."));
    return facts;
  }
  if (mistakes == 0) facts.items.push_back(msg("sound"));
  if (warnings > 0) facts.items.push_back(msgn("{} warning", "{} warnings", warnings, warnings));
  if (c.findings != nullptr && c.findings->expert_s)
    facts.items.push_back(
        msg("the built-in expert needs about {}", as_s(*c.findings->expert_s, 0)));
  return facts;
}

void findings(const AuthorContext& c, ImVec2 at, ImVec2 size) {
  const Theme& t = c.screen.theme;
  begin_area(t, "author findings", at, size, true);
  if (!c.state.message.empty()) {
    ImGui::PushStyleColor(ImGuiCol_Text, t.warn);
    wrapped_text(c.state.message);
    ImGui::PopStyleColor();
  }
  wrapped_text(msg("Check: {}", verdict(c)));
  const std::string file = std::filesystem::path(c.document.path()).filename().string();
  for (const scenarios::Problem& p : c.problems) {
    const Message where =
        FileLocation{p.where.line > 0 ? file : p.where.file, p.where.line, p.where.column};
    ImGui::PushStyleColor(ImGuiCol_Text, p.warning ? t.warn : t.bad);
    wrapped_text(p.warning ? msg("{}  warning: {}; {}", where, p.what, p.what_to_do)
                           : msg("{}  MISTAKE: {}; {}", where, p.what, p.what_to_do));
    ImGui::PopStyleColor();
  }
  end_area();
}

Message picture_heading(const AuthorContext& c) {
  if (c.screen.scene == nullptr) return msg("The tooth is being read ...");
  if (c.busy) return msg("ZONES BEFORE THE LAST CHANGE");
  if (c.findings->body[0].indices.empty()) return msg("ZONES BEFORE THE MISTAKE");
  return c.state.by_landmarks ? msg("LANDMARKS") : msg("ZONES");
}

void points_by_key(const AuthorContext& c, const AuthorZone& zone) {
  AuthorState& s = c.state;
  const std::size_t n = zone.points_mm.size();
  if (n == 0) return;
  if (ImGui::IsKeyPressed(GLFW_KEY_PERIOD)) s.point = (s.point + 1) % n;
  if (ImGui::IsKeyPressed(GLFW_KEY_COMMA)) s.point = (s.point + n - 1) % n;
  if (key_pressed(GLFW_KEY_I)) {
    // half way to the next point; behind the end of a path as far as the last piece is long
    const Vec3 a = zone.points_mm[s.point];
    const bool end = !zone.closed && s.point + 1 == n;
    const Vec3 to = end ? a + (a - zone.points_mm[n >= 2 ? n - 2 : 0]) * 0.5
                        : (a + zone.points_mm[(s.point + 1) % n]) * 0.5;
    change(c, "", false, [&] {
      return scenarios::insert_point(c.document.text(), c.document.path(), zone.points_place,
                                     s.point + 1, to.x, to.y);
    });
    if (c.state.message.empty()) ++s.point;
  }
  if (key_pressed(GLFW_KEY_X)) {
    if (n > zone.least_points) {
      change(c, "", false, [&] {
        return scenarios::remove_point(c.document.text(), c.document.path(), zone.points_place,
                                       s.point);
      });
      s.point = s.point > 0 ? s.point - 1 : 0;
    } else {
      s.message = msg("An outline of this kind needs at least {} points.", zone.least_points);
    }
  }
}

void numbers_by_key(const AuthorContext& c, const AuthorZone& zone) {
  AuthorState& s = c.state;
  const std::size_t n = zone.numbers.size();
  if (n == 0) return;
  if (ImGui::IsKeyPressed(GLFW_KEY_RIGHT_BRACKET)) s.number = (s.number + 1) % n;
  if (ImGui::IsKeyPressed(GLFW_KEY_LEFT_BRACKET)) s.number = (s.number + n - 1) % n;
  const int larger =
      ImGui::IsKeyPressed(GLFW_KEY_PAGE_UP) - ImGui::IsKeyPressed(GLFW_KEY_PAGE_DOWN);
  const AuthorNumber& number = zone.numbers[std::min(s.number, n - 1)];
  if (larger != 0)
    author_set_number(c, number, number.value + larger * (ImGui::GetIO().KeyShift ? 0.01 : 0.1),
                      false);
}

void landmarks_by_key(const AuthorContext& c) {
  AuthorState& s = c.state;
  const std::size_t n = c.landmarks.size();
  if (n == 0) return;
  if (key_pressed(GLFW_KEY_TAB))
    s.landmark = (s.landmark + (ImGui::GetIO().KeyShift ? n - 1 : 1)) % n;
  if (!key_pressed(GLFW_KEY_X)) return;
  const AuthorLandmark& mark = c.landmarks[std::min(s.landmark, n - 1)];
  if (mark.by_person)
    author_move_landmark(c, mark, std::nullopt, false);
  else
    s.message = msg("The {} is where it was found.", mark.title());
}

void keys(const AuthorContext& c, AuthorWish& wish) {
  AuthorState& s = c.state;
  const ImGuiIO& io = ImGui::GetIO();
  if (io.WantTextInput || s.ask_close || s.ask_tooth) return;
  if (io.KeyCtrl) {
    if (ImGui::IsKeyPressed(GLFW_KEY_S, false)) wish = AuthorWish::save;
    if (ImGui::IsKeyPressed(GLFW_KEY_Z)) wish = io.KeyShift ? AuthorWish::redo : AuthorWish::undo;
    if (ImGui::IsKeyPressed(GLFW_KEY_Y)) wish = AuthorWish::redo;
    return;
  }
  for (std::size_t i = 0; i < k_author_layers; ++i)
    if (key_pressed(GLFW_KEY_F1 + static_cast<int>(i))) {
      s.shown[i] = !s.shown[i];
      s.shown_differs = true;
    }
  if (key_pressed(GLFW_KEY_F6)) s.landmarks_shown = !s.landmarks_shown;
  if (key_pressed(GLFW_KEY_L)) s.by_landmarks = s.landmarks_shown = !s.by_landmarks;
  if (!s.landmarks_shown) s.by_landmarks = false;
  if (key_pressed(GLFW_KEY_C)) c.screen.state.view.clear = !c.screen.state.view.clear;
  if (key_pressed(GLFW_KEY_F5)) wish = AuthorWish::read_again;
  if (key_pressed(GLFW_KEY_ESCAPE)) wish = AuthorWish::close;
  if (s.by_landmarks) {
    landmarks_by_key(c);
    return;
  }
  if (c.zones.empty()) return;
  if (key_pressed(GLFW_KEY_TAB)) {
    s.zone = (s.zone + (io.KeyShift ? c.zones.size() - 1 : 1)) % c.zones.size();
    s.point = s.number = 0;
  }
  points_by_key(c, c.zones[s.zone]);
  numbers_by_key(c, c.zones[s.zone]);
}

void ask_about_closing(const AuthorContext& c, AuthorWish& wish) {
  AuthorState& s = c.state;
  const Theme& t = c.screen.theme;
  bool fresh = false;
  if (!begin_question(t, "Save?", msg("Save your changes?"), s.ask_close, fresh)) return;
  text_line(msg("Something was changed and is not in the file yet."));
  ImGui::Dummy({0, t.px(6)});
  if (main_button(t, msg("Save and close  (Enter)"), true, !fresh))
    wish = AuthorWish::save_and_close;
  ImGui::SameLine();
  if (ImGui::Button(shown_label(msg("Close without saving  (N)")).c_str(), {0, t.px(44)}) ||
      (!fresh && key_pressed(GLFW_KEY_N)))
    wish = AuthorWish::discard;
  ImGui::SameLine();
  if (ImGui::Button(shown_label(msg("Back  (Esc)")).c_str(), {0, t.px(44)}) ||
      (!fresh && key_pressed(GLFW_KEY_ESCAPE)))
    s.ask_close = false;
  if (wish != AuthorWish::none) s.ask_close = false;
  end_question(s.ask_close);
}

void ask_about_tooth(const AuthorContext& c, AuthorWish& wish) {
  AuthorState& s = c.state;
  const Theme& t = c.screen.theme;
  bool fresh = false;
  if (!begin_question(t, "Tooth?", msg("The landmarks need a tooth of their own"), s.ask_tooth,
                      fresh))
    return;
  text_line(msg("The scenario's tooth ships, or lies in another folder, and stays as it is."));
  text_line(msg(
      "A copy with your landmarks is written beside the scenario, which then names it. Its name:"));
  if (fresh) ImGui::SetKeyboardFocusHere();
  ImGui::SetNextItemWidth(-1);
  const bool entered = ImGui::InputText("##tooth", s.tooth_name.data(), s.tooth_name.size(),
                                        ImGuiInputTextFlags_EnterReturnsTrue);
  bad_text(t, s.message);
  ImGui::Dummy({0, t.px(6)});
  if (main_button(t, msg("Save  (Enter)"), true, false) || (entered && !fresh)) {
    s.tooth_named = true;
    wish = s.close_then ? AuthorWish::save_and_close : AuthorWish::save;
  }
  ImGui::SameLine();
  if (ImGui::Button(shown_label(msg("Back  (Esc)")).c_str(), {0, t.px(44)}) ||
      (!fresh && key_pressed(GLFW_KEY_ESCAPE)))
    s.ask_tooth = false;
  if (wish != AuthorWish::none) s.ask_tooth = false;
  end_question(s.ask_tooth);
}

}  // namespace

void author_move_landmark(const AuthorContext& c, const AuthorLandmark& landmark,
                          const std::optional<Vec3>& to, bool pull) {
  attempt(c, pull, [&] {
    const std::vector<NamedPoint>& now = c.document.landmarks();
    c.document.put(to ? with_landmark(now, landmark.name, *to)
                      : without_landmark(now, landmark.name, c.findings->tooth->found),
                   "landmark " + landmark.name);
  });
}

void author_move_point(const AuthorContext& c, const AuthorZone& zone, std::size_t point, Vec3 to,
                       bool pull) {
  const std::string place = fmt::format("{}/{}", zone.points_place, point);
  change(c, place, pull, [&] {
    return scenarios::set_point(c.document.text(), c.document.path(), place, to.x, to.y);
  });
}

void author_set_number(const AuthorContext& c, const AuthorNumber& number, double value,
                       bool pull) {
  change(c, number.place, pull, [&] {
    return scenarios::set_number(c.document.text(), c.document.path(), number.place,
                                 std::clamp(value, number.low, number.high));
  });
}

AuthorWish author_screen(const AuthorContext& c) {
  const Theme& t = c.screen.theme;
  AuthorWish wish = AuthorWish::none;
  const ImVec2 screen = ImGui::GetIO().DisplaySize;
  const float top = t.px(76), bottom = t.px(150), side = std::min(t.px(330), screen.x * 0.45F),
              middle = screen.y - top - bottom;
  const bool left = c.screen.state.left_handed;
  top_bar(c, {screen.x, top}, wish);
  side_panel(c, {left ? 0 : screen.x - side, top}, {side, screen.y - top});
  findings(c, {left ? side : 0, screen.y - bottom}, {screen.x - side, bottom});
  ImGui::PushStyleVar(ImGuiStyleVar_WindowPadding, {0, 0});
  const ImVec2 at{left ? side : 0, top}, size{screen.x - side, middle};
  begin_area(t, "author tooth", at, size, false);
  ImGui::PopStyleVar();
  if (c.screen.scene != nullptr) author_picture(c, at, size);
  words_in_picture(t, at, size, picture_heading(c), {}, t.accent);
  end_area();
  keys(c, wish);
  ask_about_closing(c, wish);
  ask_about_tooth(c, wish);
  return wish;
}

}  // namespace cavum::station
