#define GLFW_INCLUDE_NONE
#include <GLFW/glfw3.h>
#include <fmt/core.h>
#include <imgui.h>

#include <algorithm>
#include <cmath>

#include "ui/language/say.h"
#include "ui/station/coach.h"
#include "ui/station/colour_key.h"
#include "ui/station/gauges.h"
#include "ui/station/office_line.h"
#include "ui/station/pointer_hand.h"
#include "ui/station/screens.h"
#include "ui/station/window.h"

namespace cavum::station {
namespace {

/// Where everything is, pixels.
struct Layout {
  ImVec2 top_at, top, side_at, side, tray_at, tray, tooth_at, tooth;
};

Layout lay_out(const Theme& t, bool left_handed) {
  const ImVec2 screen = ImGui::GetIO().DisplaySize;
  const float top = t.px(98), tray = t.px(140), side = std::min(t.px(250), screen.x * 0.4F);
  Layout l;
  l.top_at = {0, 0};
  l.top = {screen.x, top};
  l.tray_at = {0, screen.y - tray};
  l.tray = {screen.x, tray};
  l.side = {side, screen.y - top - tray};
  l.side_at = {left_handed ? 0 : screen.x - side, top};
  l.tooth = {screen.x - side, l.side.y};
  l.tooth_at = {left_handed ? side : 0, top};
  return l;
}

void top_bar(const ScreenContext& c, const scenarios::LiveView& view, const Layout& l) {
  const Theme& t = c.theme;
  const scenarios::Scenario& scenario = c.sitting->setup().scenario;
  ImGui::PushStyleVar(ImGuiStyleVar_WindowPadding, {t.px(20), t.px(10)});
  begin_area(t, "step and clock", l.top_at, l.top, true);
  ImGui::PopStyleVar();
  const float clock = t.px(200);
  ImGui::BeginChild("step", {l.top.x - clock - t.px(50), 0}, false, ImGuiWindowFlags_NoScrollbar);
  const std::size_t steps = scenario.steps.size(), step = static_cast<std::size_t>(view.step);
  const Message where = step < steps ? msg("Step {} of {}", step + 1, steps)
                                     : msgn("{} step done", "All {} steps done", view.step, steps);
  const Message kind = c.sitting->device().simulated() ? msg("demonstration")
                       : c.practice                    ? msg("practice")
                                                       : msg("examination");
  quiet_text(t, msg("{}    {}    {}", where, c.sitting->candidate(), kind));
  wrapped_text(msg("{}", Authored{view.instruction}));
  ImGui::EndChild();
  ImGui::SameLine();
  ImGui::BeginChild("clock", {0, 0}, false, ImGuiWindowFlags_NoScrollbar);
  exam_clock(t, static_cast<double>(view.ticks - view.paused_ticks) * k_tick_s,
             static_cast<double>(view.limit_ticks) * k_tick_s, view.paused || view.held);
  ImGui::EndChild();
  end_area();
}

void side_panel(const ScreenContext& c, const scenarios::LiveView& view, const Layout& l) {
  const Theme& t = c.theme;
  StationState& s = c.state;
  const scenarios::Scenario& scenario = c.sitting->setup().scenario;
  begin_area(t, "side", l.side_at, l.side, true);
  // the buttons always have their place; gauges and hints can be scrolled when the text is large
  const float row = t.px(36) + ImGui::GetStyle().ItemSpacing.y,
              rows = 2.0F + (scenario.pauses.count > 0 ? 1.0F : 0.0F) + (c.practice ? 1.0F : 0.0F);
  ImGui::BeginChild("gauges",
                    {0, std::max(t.px(60), ImGui::GetContentRegionAvail().y - rows * row)}, false);
  const scenarios::GaugeSpec all{true, true, true};
  show_gauges(t, c.sitting->setup(), view.output, view.depth_mm,
              c.practice ? all : scenario.gauges);
  contact_lamp(t, view.output.contact);
  text_line(msg("Speed dial  ( [ and ] )"));
  auto dial = static_cast<float>(100.0 * s.handpiece_speed);
  ImGui::SetNextItemWidth(ImGui::GetContentRegionAvail().x);
  ImGui::SliderFloat("##dial", &dial, 10.0F, 100.0F, "%.0f %%");
  if (key_pressed(GLFW_KEY_LEFT_BRACKET)) dial -= 10.0F;
  if (key_pressed(GLFW_KEY_RIGHT_BRACKET)) dial += 10.0F;
  s.handpiece_speed = std::clamp(static_cast<double>(dial) / 100.0, 0.1, 1.0);
  ImGui::Dummy({0, t.px(4)});
  quiet_text(
      t,
      msg("View: 1 to 5, W A S D, + and -, M mirror, R turn, T both eyes, H handpiece, G ring below the head, N spray"));
  ImGui::EndChild();
  const float width = ImGui::GetContentRegionAvail().x;
  if (scenario.pauses.count > 0) {
    const int left = scenario.pauses.count - view.pauses;
    const Message label = view.paused ? msg("Go on  (P)") : msg("Pause  (P), {} left", left);
    const bool may = view.paused || left > 0;
    ImGui::BeginDisabled(!may);
    if (side_button(t, label, width) || (may && key_pressed(GLFW_KEY_P))) s.pause_key_s = 0.1;
    ImGui::EndDisabled();
  }
  if (c.practice &&
      (side_button(t, s.tutorial ? msg("Tutorial off  (U)") : msg("Tutorial  (U)"), width) ||
       key_pressed(GLFW_KEY_U)))
    s.tutorial ? s.tutorial.reset()
               : void(s.tutorial.emplace(c.sitting->device().pointer() != nullptr));
  if (side_button(t, s.muted ? msg("Sound on  (V)") : msg("Sound off  (V)"), width) ||
      key_pressed(GLFW_KEY_V))
    s.muted = !s.muted;
  if (side_button(t, msg("I have finished  (Esc)"), width) || key_pressed(GLFW_KEY_ESCAPE))
    s.confirm_end = true;
  end_area();
}

void tray(const ScreenContext& c, const scenarios::LiveView& view, const Layout& l) {
  const Theme& t = c.theme;
  const auto& allowed = c.sitting->setup().bur_names;
  ImGui::PushStyleVar(ImGuiStyleVar_WindowPadding, {t.px(14), t.px(8)});
  begin_area(t, "tray", l.tray_at, l.tray, true);
  ImGui::PopStyleVar();
  const float each = (ImGui::GetContentRegionAvail().x + t.px(6)) /
                     static_cast<float>(std::max<std::size_t>(c.shelf.size(), 1));
  ImDrawList& draw = *ImGui::GetWindowDrawList();
  const ImVec2 first = ImGui::GetCursorScreenPos();
  const float height = ImGui::GetContentRegionAvail().y;
  for (std::size_t i = 0; i < c.shelf.size(); ++i) {
    const auto place = std::find(allowed.begin(), allowed.end(), c.shelf[i].name);
    const bool may = place != allowed.end();
    const auto number = static_cast<int>(place - allowed.begin());
    const ImVec2 at{first.x + static_cast<float>(i) * each, first.y}, size{each - t.px(6), height};
    const bool mounted = may && view.input.bur == number;
    ImGui::SetCursorScreenPos(at);
    ImGui::PushID(static_cast<int>(i));
    ImGui::BeginDisabled(!may);
    const bool chosen = ImGui::InvisibleButton("bur", size) ||
                        (may && key_pressed(GLFW_KEY_F1 + static_cast<int>(i)));
    const bool marked = ImGui::IsItemHovered() || ImGui::IsItemFocused();
    ImGui::EndDisabled();
    ImGui::PopID();
    if (chosen) c.sitting->desk().bur.store(number, std::memory_order_relaxed);
    if (may) draw.AddRectFilled(at, {at.x + size.x, at.y + size.y}, ink(t.raised), t.px(5));
    if (mounted || marked)
      draw.AddRect(at, {at.x + size.x, at.y + size.y}, ink(mounted ? t.accent : t.quiet), t.px(5),
                   0, t.px(mounted ? 3.0F : 1.0F));
    const ImU32 steel = ink(may ? t.text : t.faint), coated = ink(may ? t.warn : t.faint);
    draw_silhouette(c.shelf[i], {at.x, at.y + t.px(6)}, {size.x, size.y - t.px(62)}, steel, coated);
    push_font(Font::small);
    // a long word a little smaller, so that all can be read
    const float room = size.x - t.px(6);
    const std::string title = in_lines(tr("{}", Authored{c.shelf[i].title}), room);
    float below = t.px(54);
    for (std::size_t from = 0; from < title.size();) {
      const std::size_t to = std::min(title.find('\n', from), title.size());
      const std::string line = title.substr(from, to - from);
      const float wide = ImGui::CalcTextSize(line.c_str()).x,
                  font = ImGui::GetFontSize() * std::min(1.0F, room / std::max(1.0F, wide));
      draw.AddText(ImGui::GetFont(), font,
                   {at.x + (size.x - std::min(wide, room)) / 2, at.y + size.y - below},
                   ink(may ? t.text : t.quiet), line.c_str());
      ImGui::LogText("%s\n", line.c_str());
      below -= t.px(17);
      from = to + 1;
    }
    if (may)
      draw.AddText({at.x + t.px(6), at.y + t.px(4)}, ink(t.quiet),
                   fmt::format("F{}", i + 1).c_str());
    pop_font();
  }
  end_area();
}

/// How mouse and keyboard are the stylus: into the picture, on the left, below what stands in its
/// corner.
void pointer_keys(const Theme& t, bool mouse_free, ImVec2 at, ImVec2 size) {
  const std::string text =
      mouse_free
          ? tr("Mouse: points at buttons. Tab or middle button: it is the stylus again")
          : tr("Stylus: mouse or arrows; wheel or PgUp PgDn for depth; space bar or left button = pedal. Ctrl: tilts, 0: "
               "upright. Shift: finer. B: back above the tooth. Tab or middle button: mouse for buttons");
  push_font(Font::small);
  const std::string lines = in_lines(text, std::min(t.px(210), 0.25F * size.x));
  ImGui::GetWindowDrawList()->AddText({at.x + t.px(16), at.y + t.px(44)}, ink(t.quiet),
                                      lines.c_str());
  ImGui::LogText("%s\n", text.c_str());
  pop_font();
}

bool asked_something(const StationState& s) {
  return s.confirm_end || s.confirm_close || s.confirm_leave || s.confirm_go_on;
}

Vec3 to_vec3(const glm::vec3& v) { return {v.x, v.y, v.z}; }

/// B brings a lost bur back above the tooth, by a way that the hand goes.
void come_back(const ScreenContext& c, const scenarios::LiveView& now, Vec3 out) {
  StationState& s = c.state;
  if (key_pressed(GLFW_KEY_B) && !asked_something(s)) {
    s.coming_back = true;
    s.wanted_mm = now.output.proxy_mm;  // not from inside the tooth, where it may press
  }
  if (!s.coming_back) return;
  const auto in_tissue = [&c](Vec3 p) { return c.scene->tooth().distance_mm(p) < 0.0; };
  const ReturnPath way{c.sitting->device().start().tip_mm, out, in_tissue};
  s.wanted_mm = next_on_return_path(way, s.wanted_mm, k_pointer_back_mm_s * c.frame_s);
  s.coming_back = !(s.wanted_mm == way.goal);
}

/// Mouse and keyboard say where the hand wants the tip: across the picture along the surface; seen
/// from the side, up and down is depth.
void move_pointer(const ScreenContext& c, const scenarios::LiveView& now, PointerStylus& pointer,
                  float picture_height) {
  StationState& s = c.state;
  const Camera& camera = s.view.camera;
  PointerView view;
  view.out = c.sitting->setup().zones.approach();
  const auto across = [&view](Vec3 v) {
    const Vec3 flat = v - view.out * dot(v, view.out);
    constexpr double k_steep = 0.35;
    return length(flat) > k_steep ? normalized(flat) : normalized(v);
  };
  view.right = across(camera.right());
  view.up = across(camera.up());
  view.mm_per_px = 2.0 * camera.distance_mm * std::tan(13.0 * 3.14159265 / 180.0) / picture_height;
  view.mouse = c.mouse_captured;
  const Vec3 before = s.wanted_mm;
  if (!asked_something(s)) move_by_pointer(c.input, view, s.wanted_mm, s.wanted_rotation);
  if (!(s.wanted_mm == before)) s.coming_back = false;  // the hand wants something else
  come_back(c, now, view.out);
  if (now.output.contact) keep_in_reach(view, now.input.pose().tip_mm, s.wanted_mm);
  const auto& box = c.scene->tooth().box_mm();
  s.wanted_mm =
      near_tooth(to_vec3(box[0]), to_vec3(box[1]), c.sitting->device().start().tip_mm, s.wanted_mm);
  PointerIntent intent;
  intent.tip_mm = s.wanted_mm;
  intent.rotation = s.wanted_rotation;
  intent.pedal = pointer_pedal(c.input, c.mouse_captured) && !asked_something(s) ? 1.0 : 0.0;
  pointer.want(intent);
}

TutorialSight tutorial_sight(const ScreenContext& c, const scenarios::LiveView& view) {
  TutorialSight sight;
  sight.tip_mm = view.output.proxy_mm;
  sight.handle = rotation(view.input.pose().rotation) * Vec3{0, 0, 1};
  sight.out = c.sitting->setup().zones.approach();
  sight.turn_deg = c.state.view.camera.turn_deg;
  sight.rise_deg = c.state.view.camera.rise_deg;
  sight.contact = view.output.contact;
  sight.cutting = view.output.cutting;
  sight.rpm = view.output.rpm;
  return sight;
}

/// What stands in the picture's corner.
struct Notice {
  Message upper, lower;
  ImVec4 colour;
};

/// The most urgent thing that there is to say. `lost`: the bur is out of the picture.
std::optional<Notice> notice(const ScreenContext& c, const scenarios::LiveView& view, bool lost) {
  const Theme& t = c.theme;
  StationState& s = c.state;
  if (!view.recording_error.empty())
    return Notice{
        msg("RECORDING"),
        msg("{} are kept in memory, nothing is lost. Go on working, and call the supervisor: {}",
            as_s(static_cast<double>(view.unwritten_ticks / 1000), 0), view.recording_error),
        t.bad};
  if (!c.sitting->moved().empty())
    return Notice{msg("RECORDING"),
                  msg("Go on working, nothing is lost. For the supervisor: {}", c.sitting->moved()),
                  t.warn};
  if (const std::optional<Error> problem = c.sitting->device().problem())
    return Notice{msg("DEVICE"), msg("Call the supervisor: {}", problem->message()), t.bad};
  if (view.held) {
    const Name reason{s.office ? s.office->hold_reason : ""};
    return Notice{
        msg("PAUSED BY THE EXAM OFFICE"),
        may_go_on_without(s)
            ? msg("{}. The clock stands still and the handpiece stays off. The office does not answer. Supervisor: press "
                  "Home to go on.",
                  reason)
            : msg("{}. The clock stands still and the handpiece stays off.", reason),
        t.warn};
  }
  if (s.office && !s.office->told.empty())
    return Notice{msg("FROM THE EXAM OFFICE"),
                  msg("{}  (Home)", announcement_text(s.office->told.front())), t.accent};
  if (s.attempt_shown_s > 0) {
    s.attempt_shown_s -= c.frame_s;
    return Notice{
        msg("RECORDED"),
        msg("For the supervisor: {}. Tries to leave this exam so far: {}.", s.attempt, s.attempts),
        t.warn};
  }
  if (view.paused)
    return Notice{msg("PAUSE"),
                  msg("The clock stands still and the handpiece stays off. Press P to go on."),
                  t.warn};
  if (lost)
    return Notice{
        msg("BUR"),
        c.sitting->device().pointer() != nullptr
            ? msg("The bur is out of the picture, where the arrow shows. B brings it back above the tooth.")
            : msg("The bur is out of the picture, where the arrow shows."),
        t.warn};
  if (s.tutorial) {
    const bool done = s.tutorial->done();
    return Notice{done ? msg("TUTORIAL")
                       : msg("TUTORIAL   {} of {}", s.tutorial->step() + 1, Tutorial::k_steps),
                  s.tutorial->text(), done ? t.good : t.accent};
  }
  if (c.practice) return Notice{msg("PRACTICE"), coaching_hint(c.sitting->setup(), view), t.accent};
  return {};
}

void ask_whether_finished(const ScreenContext& c) {
  StationState& s = c.state;
  bool fresh = false;
  if (!begin_question(c.theme, "Finished?", msg("Have you finished?"), s.confirm_end, fresh))
    return;
  text_line(msg("Your work will be graded as it is now. The clock runs on until then."));
  ImGui::Dummy({0, c.theme.px(6)});
  if (main_button(c.theme, msg("Yes, hand it in  (Enter)"), true, !fresh)) {
    s.wish = Wish::end;
    s.confirm_end = false;
  }
  ImGui::SameLine();
  if (ImGui::Button(shown_label(msg("Back to work  (Esc)")).c_str(), {0, c.theme.px(44)}) ||
      (!fresh && key_pressed(GLFW_KEY_ESCAPE)))
    s.confirm_end = false;
  end_question(s.confirm_end);
}

}  // namespace

void exam_screen(const ScreenContext& c) {
  const Theme& t = c.theme;
  StationState& s = c.state;
  scenarios::LiveExam& live = c.sitting->live();
  const scenarios::LiveView view = live.view();
  const Layout l = lay_out(t, s.left_handed);

  live.look_at_tooth([&](const Octree& tooth) { c.scene->tooth().take(tooth); });
  c.scene->tooth().update();
  s.view.tool = {view.output.proxy_mm, view.input.pose().rotation};
  s.view.bur = view.ticks > 0 ? view.input.bur : -1;
  s.view.pressed = view.output.contact;
  turn_bur(s.view, view.output.rpm, c.frame_s);
  spray_on(s.view.spray, view.output.rpm, view.output.cutting, view.enamel_share, view.dentin_share,
           c.frame_s);
  if (s.tutorial && view.ticks > 0) s.tutorial->see(tutorial_sight(c, view));

  top_bar(c, view, l);
  side_panel(c, view, l);
  tray(c, view, l);
  ImGui::PushStyleVar(ImGuiStyleVar_WindowPadding, {0, 0});
  begin_area(t, "tooth", l.tooth_at, l.tooth, false);
  ImGui::PopStyleVar();
  const bool over = tooth_area(c, l.tooth);
  const bool lost =
      s.view.bur >= 0 && arrow_to_what_is_out(c, view.output.proxy_mm, l.tooth_at, l.tooth);
  if (const auto shown = notice(c, view, lost))
    words_in_picture(t, l.tooth_at, l.tooth, shown->upper, shown->lower, shown->colour);
  PointerStylus* pointer = c.sitting->device().pointer();
  if (pointer != nullptr) pointer_keys(t, s.mouse_free, l.tooth_at, l.tooth);
  if (c.practice)
    draw_colour_key(t, colour_key(c.sitting->setup().tooth.tissues, s.high_contrast), l.tooth_at,
                    l.tooth);
  end_area();
  if (pointer != nullptr) {
    const auto& played = c.input.played();
    const bool middle = std::any_of(played.begin(), played.end(), [](const InputEvent& e) {
      return e.kind == InputEvent::Kind::button && e.code == GLFW_MOUSE_BUTTON_MIDDLE && e.down;
    });
    if (key_pressed(GLFW_KEY_TAB) || middle) s.mouse_free = !s.mouse_free;
    if (over && ImGui::IsMouseClicked(ImGuiMouseButton_Left)) s.mouse_free = false;
    move_pointer(c, view, *pointer, l.tooth.y);
    s.capture_mouse = !s.mouse_free && !asked_something(s);
  }
  ask_whether_finished(c);

  const bool pressed = s.pause_key_s > 0;  // for a frame at least, however long it takes
  s.pause_key_s = std::max(0.0, s.pause_key_s - c.frame_s);
  const int button = c.sitting->setup().scenario.pauses.button == 1 ? k_button_1 : k_button_2;
  c.sitting->desk().buttons.store(pressed ? static_cast<std::uint32_t>(button) : 0u,
                                  std::memory_order_relaxed);
  c.sitting->desk().speed_share.store(s.handpiece_speed, std::memory_order_relaxed);
}

}  // namespace cavum::station
