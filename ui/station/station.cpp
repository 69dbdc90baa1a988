#include "ui/station/station.h"

#define GLFW_INCLUDE_NONE
#include <GLFW/glfw3.h>
#include <imgui.h>
#include <malloc.h>

#include <algorithm>
#include <chrono>
#include <filesystem>
#include <thread>

#include "engine/base/error.h"
#include "engine/base/file.h"
#include "engine/base/said_by.h"
#include "engine/session/session_reader.h"
#include "scenarios/exam/other_place.h"
#include "ui/parts/interrupt.h"
#include "ui/parts/say.h"
#include "ui/parts/scenario_words.h"
#include "ui/report/report.h"
#include "ui/sound/sound_output.h"
#include "ui/station/office_line.h"
#include "ui/station/screens.h"
#include "ui/station/script.h"
#include "ui/station/station_lock.h"
#include "ui/station/supervisor_code.h"
#include "ui/station/window.h"

namespace cavum::station {
namespace {

using Clock = std::chrono::steady_clock;

// what the screens need at scale 1, pixels: a window that has less shows smaller text, whatever was asked for
constexpr double k_min_width = 720.0, k_min_height = 450.0, k_min_scale = 0.6;

double seconds_since(Clock::time_point t) { return std::chrono::duration<double>(Clock::now() - t).count(); }

std::vector<Bur> read_shelf(const std::string& scenario_path) {
  std::vector<Bur> shelf;
  for (const auto& name : scenarios::data_names("burs", scenario_path)) {
    const std::string path = scenarios::find_data_file("burs", name + ".toml", scenario_path);
    shelf.push_back(parse_bur(read_text_file(path), path));
  }
  return shelf;
}

scenarios::Scenario scenario_of(const SittingOptions& o) {
  return o.resume.empty() ? scenarios::parse_scenario(read_text_file(o.scenario), o.scenario)
                          : scenarios::prepare_exam(SessionReader(o.resume).setup())->scenario;
}

/// Takes the memory that a cavity's surface will need, here and in a renderer on the processor, as the exam begins: it does not grow any more then.
/// The allocator keeps it, instead of giving it back at once.
void reserve_memory() {
  constexpr std::size_t k_blocks = 384,
                        k_block_bytes = std::size_t{64} * 1024;  // 24 MB: ten minutes of hard work took 8, a picture takes 8 for a moment
  mallopt(M_TRIM_THRESHOLD, 4 * static_cast<int>(k_blocks * k_block_bytes));
  std::vector<std::vector<char>> blocks(k_blocks);
  for (auto& block : blocks) block.assign(k_block_bytes, 1);
}

class Station {
 public:
  explicit Station(const StationOptions& options)
      : options_(options),
        replay_(options.replay.empty() ? nullptr : std::make_unique<ReplayPlayer>(options.replay)),
        scenario_(replay_ ? replay_->setup().scenario : scenario_of(options.sitting)),
        shelf_(read_shelf(options.sitting.scenario)),
        lock_(options.supervisor_hash),
        check_(options.sitting.device.name, options.self_check_hours.value_or(0.0)),
        window_({"Cavum", options.width, options.height, options.monitor, lock_.locked()}) {
    ui::show_texts_of(scenario_);
    if (!options_.script.empty()) script_ = Script(read_text_file(options_.script), options_.script, options_.pictures);
    usual_look();
    if (replay_) {
      make_scene(replay_->setup(), true);
      state_.view.clear = false;
      state_.screen = Screen::replay;
    }
    if (options_.office) office_ = std::make_unique<OfficeLine>(*options_.office);
    options_.candidate.copy(state_.code.data(), state_.code.size() - 1);
    state_.tutorial_wanted = options_.tutorial;
    state_.goes_on = !options_.sitting.resume.empty();
  }

  int run() {
    try {
      while (!may_close() && !ui::Interrupt::asked()) frame();
    } catch (const std::exception& e) {
      rescue();
      if (!open_session().empty())
        throw Error(msg("station"), msg("failed during the exam ({})", said_by(e)),
                    msg("what was done is recorded; go on with: cavum station --resume {}", open_session()));
      throw;
    }
    if (!abandoned_) rescue();
    const std::string open = open_session();
    if (open.empty()) return 0;
    if (abandoned_) ui::say_error(msg("station: the last {} of the exam were given up", as_s(sitting_->unwritten_s(), 1)));
    sitting_.reset();
    ui::say_error(
        msg("station: was closed during the exam; what was done is recorded; go on with: cavum station --resume {} (or close it as it stands: cavum "
            "exam --resume --end --out {})",
            open, open));
    return 1;
  }

 private:
  /// Path of the session that would stay open if the window closed now.
  [[nodiscard]] std::string open_session() const {
    const bool open =
        sitting_ && (sitting_->stage() == Stage::running || sitting_->stage() == Stage::interrupted || sitting_->stage() == Stage::unsaved);
    return open ? sitting_->path() : std::string();
  }

  /// The window was asked to close, and nothing would be lost. Else it stays open, and asks or waits.
  bool may_close() {
    if (!window_.closing()) return false;
    if (!abandoned_ && !lock_.lets_close(window_, state_, sitting_.get())) return false;
    if (abandoned_ || !sitting_) return true;
    sitting_->stop();
    if (sitting_->stage() != Stage::grading && sitting_->stage() != Stage::unsaved) return true;
    window_.stay_open();
    seen_ = sitting_->stage();
    if (seen_ == Stage::grading) {
      if (state_.screen != Screen::grading) go_to(Screen::grading);
      close_when_sealed_ = true;
    } else {
      if (state_.screen != Screen::save) go_to(Screen::save);
      state_.confirm_close = true;
    }
    return false;
  }

  /// Nobody may be there to answer: what is in memory only goes wherever there is room, and standard error says where.
  void rescue() {
    if (!sitting_) return;
    const std::string first = sitting_->path();
    sitting_->rescue();
    tell_moved(first);
  }
  void tell_moved(const std::string& first) const {
    if (!first.empty() && sitting_->path() != first)
      ui::say_error(msg("station: {} could not be written; the whole exam is saved at {}", first, sitting_->path()));
  }

  void frame() {
    const auto began = Clock::now();
    const double frame_s = std::min(0.1, seconds_since(last_frame_));
    last_frame_ = began;
    dress();
    script_.step(window_, state_.screen, exam_s(), seconds_since(start_));
    window_.begin_frame();
    show(frame_s);
    window_.end_frame();
    script_.shown(state_.screen, exam_s(), state_.view.tool.tip_mm);
    const bool is_stylus = std::exchange(state_.capture_mouse, false) && state_.screen == Screen::exam;
    window_.capture_mouse(is_stylus);
    set_navigation(!pointer_at_work());
    sound();
    note_tutorial();
    lock_.watch(window_, state_, sitting_.get());
    if (office_) office_->exchange(state_, sitting_.get());
    grant(std::exchange(state_.wish, Wish::none));
    go_on();
    // no more pictures than eyes need, fewer when the processor draws: the servo shares it
    const double usual_hz = window_.software() ? 25.0 : 120.0;
    const double least_s = 1.0 / (script_.pace_hz() > 0 ? script_.pace_hz() : usual_hz);
    if (const double left_s = least_s - seconds_since(began); left_s > 0) std::this_thread::sleep_for(std::chrono::duration<double>(left_s));
  }

  /// Mouse and keyboard are the stylus: every key has a meaning of its own, and none walks from button to button.
  [[nodiscard]] bool pointer_at_work() const {
    return state_.screen == Screen::exam && sitting_ && sitting_->device().pointer() != nullptr && !state_.confirm_end && !state_.confirm_close &&
           !state_.confirm_leave;
  }
  static void set_navigation(bool by_keys) {
    int& flags = ImGui::GetIO().ConfigFlags;
    flags = by_keys ? flags | ImGuiConfigFlags_NavEnableKeyboard : flags & ~ImGuiConfigFlags_NavEnableKeyboard;
  }

  /// Colours and sizes as they were chosen.
  void dress() {
    const ImGuiIO& io = ImGui::GetIO();
    if (io.KeyCtrl && ImGui::IsKeyPressed(GLFW_KEY_EQUAL)) state_.text_scale = std::min(1.8, state_.text_scale + 0.1);
    if (io.KeyCtrl && ImGui::IsKeyPressed(GLFW_KEY_MINUS)) state_.text_scale = std::max(0.8, state_.text_scale - 0.1);
    const double scale = std::min(state_.text_scale * window_.screen_scale(),
                                  std::max(k_min_scale, std::min(io.DisplaySize.x / k_min_width, io.DisplaySize.y / k_min_height)));
    const bool scale_differs = scale != dressed_scale_;
    if (scale_differs && ImGui::IsMouseDown(ImGuiMouseButton_Left)) return;  // while the slider moves
    if (!scale_differs && state_.high_contrast == dressed_contrast_) return;
    theme_ = make_theme(state_.high_contrast, scale);
    apply_theme(theme_);
    if (scale_differs) window_.set_text_scale(scale);
    dressed_scale_ = scale;
    dressed_contrast_ = state_.high_contrast;
  }

  [[nodiscard]] double exam_s() {
    if (!sitting_ || sitting_->stage() != Stage::running) return 0.0;
    const scenarios::LiveView view = sitting_->live().view();
    return static_cast<double>(view.ticks - view.paused_ticks) * k_tick_s;
  }

  void show(double frame_s) {
    const ScreenContext context{theme_,
                                state_,
                                scenario_,
                                shelf_,
                                sitting_.get(),
                                scene_.get(),
                                replay_.get(),
                                frame_s,
                                options_.sitting.practice,
                                window_.input(),
                                window_.mouse_captured(),
                                &check_,
                                lock_.locked()};
    show_screen(context);
    office_notice(context);
    ask_whether_to_leave(context, lock_.locked());
    if (office_) ask_whether_to_go_on(context, lock_.locked());
  }
  static void show_screen(const ScreenContext& context) {
    switch (context.state.screen) {
      case Screen::sign_in:
        return sign_in_screen(context);
      case Screen::self_check:
        return self_check_screen(context);
      case Screen::preparing:
        return preparing_screen(context);
      case Screen::device_check:
        return device_check_screen(context);
      case Screen::briefing:
        return briefing_screen(context);
      case Screen::exam:
        return exam_screen(context);
      case Screen::grading:
        return grading_screen(context);
      case Screen::result:
        return result_screen(context);
      case Screen::trouble:
        return trouble_screen(context);
      case Screen::save:
        return save_screen(context);
      case Screen::replay:
        return replay_screen(context);
      case Screen::author:  // in a window of its own, author.h
      case Screen::author_busy:
        return;
    }
  }

  /// Each step of the tutorial that was done is recorded.
  void note_tutorial() {
    const int done = state_.tutorial ? state_.tutorial->step() : 0;
    if (done > tutorial_noted_) sitting_->note(TutorialStep{done});
    tutorial_noted_ = done;
  }

  /// What the handpiece does is heard.
  void sound() {
    ui::SoundParameters heard;
    if (state_.screen == Screen::exam && sitting_->stage() == Stage::running) {
      const scenarios::LiveView view = sitting_->live().view();
      heard.rpm = view.output.rpm;
      heard.load_n = length(view.output.rendered_force_n);
      heard.cutting = view.output.cutting;
      heard.enamel_share = view.enamel_share;
      heard.dentin_share = view.dentin_share;
      heard.spray = heard.rpm > 0.0 ? 1.0 : 0.0;
      heard.suction = 1.0;
    }
    sound_.set(heard);
    sound_.set_muted(state_.muted);
  }

  void grant(Wish wish) {
    try {
      switch (wish) {
        case Wish::sign_in:
          sign_in();
          break;
        case Wish::check:
          state_.message = {};
          state_.focus_supervisor = true;  // once there is its field
          check_.begin();
          break;
        case Wish::check_go_on:
          go_on_with_check();
          break;
        case Wish::to_briefing:
          go_to(Screen::briefing);
          break;
        case Wish::begin:
          OfficeLine::require_free(state_);
          sitting_->begin();
          state_.attempts = 0;
          state_.tutorial.reset();
          if (state_.tutorial_wanted) state_.tutorial.emplace(sitting_->device().pointer() != nullptr);
          state_.attempt_shown_s = 0.0;
          reserve_memory();
          go_to(Screen::exam);
          break;
        case Wish::end:
          sitting_->ask_to_end();
          break;
        case Wish::save:
          sitting_->save(state_.place.data());
          break;
        case Wish::rescue: {
          state_.rescue_failed = true;  // unless it is saved
          const std::string first = sitting_->path();
          sitting_->save(scenarios::rescue_place(first));
          tell_moved(first);
          state_.rescue_failed = false;
          close_when_sealed_ = true;
          break;
        }
        case Wish::abandon:
          abandoned_ = true;
          window_.ask_to_close();
          break;
        case Wish::leave:
          lock_.leave(window_, state_, sitting_.get());
          break;
        case Wish::read:
          office_->read(state_, sitting_.get());
          break;
        case Wish::go_on:
          go_on_without_office();
          break;
        case Wish::report:
          write_report();
          break;
        case Wish::next_candidate:
          next_candidate();
          break;
        case Wish::quit:
          window_.ask_to_close();
          break;
        default:
          break;
      }
    } catch (const Error& e) {
      state_.message = e.message();
      state_.focus_code = state_.screen == Screen::sign_in;
    }
  }

  /// What a check found was read: on with it, when it is good or somebody who may decides so.
  void go_on_with_check() {
    if (check_.running() || !check_.found()) return;
    if (!check_.good() && lock_.locked()) {
      const bool right = is_supervisor_code(options_.supervisor_hash, state_.supervisor_code.data());
      state_.supervisor_code = {};
      state_.focus_supervisor = true;
      if (!right) {
        state_.message = msg("This is not the supervisor's code.");
        return;
      }
    }
    check_.go_on(lock_.locked());
    sign_in();
  }

  void go_on_without_office() {
    if (lock_.locked()) {
      const bool right = is_supervisor_code(options_.supervisor_hash, state_.supervisor_code.data());
      state_.supervisor_code = {};
      state_.leave_message = right ? Message() : msg("This is not the supervisor's code.");
      if (!right) return;
    }
    state_.confirm_go_on = false;
    office_->release(state_, sitting_.get());
  }

  void sign_in() {
    OfficeLine::require_free(state_);
    if (options_.self_check_hours && !(state_.screen == Screen::self_check && check_.found()) && check_.due(options_.sitting)) {
      check_.forget();
      return go_to(Screen::self_check);
    }
    SittingOptions o = options_.sitting;
    o.locked = lock_.locked();
    if (office_) o.word = [this](const std::string& nonce) { return office_->begin(nonce); };
    lock_.begin_sitting();
    seen_ = Stage::preparing;
    const bool fixed = !o.tickets.empty() || !o.resume.empty();  // what is granted stands there already; the layout is the candidate's own
    if (fixed) {
      sitting_ = std::make_unique<Sitting>(o, state_.code.data());
      return go_to(Screen::preparing);
    }
    if (state_.left_handed != scenario_.accommodations.left_handed) o.grant.left_handed = state_.left_handed;
    if (state_.high_contrast != scenario_.accommodations.high_contrast) o.grant.high_contrast = state_.high_contrast;
    sitting_ = std::make_unique<Sitting>(o, state_.code.data());
    go_to(Screen::preparing);
  }

  void usual_look() {
    state_.left_handed = options_.left_handed || scenario_.accommodations.left_handed;
    state_.high_contrast = options_.high_contrast || scenario_.accommodations.high_contrast;
    state_.text_scale = options_.text_scale;
  }

  void write_report() {
    const grading::ClosedExam& closed = sitting_->closed();
    const std::string path = std::filesystem::path(sitting_->path()).replace_extension(".html").string();
    report::require_report_place(path);
    report::write_closing_report(path, sitting_->path(), closed.result, *closed.graded, report::ReportReader::student);
    state_.message = msg("Report: {}", path);
  }

  void next_candidate() {
    if (options_.sitting.out.ends_with(".cavum") || !options_.sitting.resume.empty()) return window_.ask_to_close();  // one session was asked for
    scene_.reset();
    sitting_.reset();
    state_.code = {};
    state_.focus_code = true;
    usual_look();  // nobody inherits what another chose
    go_to(Screen::sign_in);
  }

  /// What happens by itself.
  void go_on() {
    check_.advance();
    if (!sitting_) return;
    const Stage before = sitting_->stage();
    try {
      sitting_->advance();
    } catch (const Error& e) {
      const bool was_preparing = before == Stage::preparing;
      if (was_preparing) sitting_.reset();
      go_to(was_preparing ? Screen::sign_in : Screen::trouble);
      state_.focus_code = was_preparing;
      state_.message = e.message();
      return;
    }
    const Stage now = sitting_->stage();
    if (now == seen_) return;
    seen_ = now;
    if (now == Stage::checking) {
      const scenarios::Accommodations& granted = sitting_->setup().scenario.accommodations;
      state_.left_handed = state_.left_handed || granted.left_handed;
      state_.high_contrast = state_.high_contrast || granted.high_contrast;
      make_scene(sitting_->setup(), options_.sitting.practice);
      if (sitting_->begun()) {
        scene_->tooth().take(sitting_->begun()->tooth);
        scene_->tooth().update();
      }
      const Pose start = sitting_->device().start();
      state_.wanted_mm = start.tip_mm;
      state_.wanted_rotation = start.rotation;
      state_.coming_back = false;
      go_to(Screen::device_check);
    }
    if (now == Stage::grading || now == Stage::interrupted) {
      sitting_->live().look_at_tooth([this](const Octree& tooth) { scene_->tooth().take(tooth); });
      scene_->tooth().update();
    }
    if (now == Stage::grading) go_to(Screen::grading);
    if (now == Stage::unsaved) {
      go_to(Screen::save);
      state_.confirm_close = std::exchange(close_when_sealed_, false);
    }
    if (now == Stage::done) go_to(Screen::result);
    if (close_when_sealed_ && (now == Stage::done || now == Stage::interrupted)) window_.ask_to_close();
    if (now == Stage::interrupted) {
      go_to(Screen::trouble);
      state_.message = sitting_->trouble();
    }
  }

  void make_scene(const scenarios::ExamSetup& setup, bool practice) {
    scene_ = std::make_unique<Scene>(setup.tooth.octree, setup.tooth.tissues, setup.burs, practice ? &setup.zones : nullptr);
    scene_->fix_effects(options_.effects);
    const Vec3 low = setup.zones.target_low_mm(), high = setup.zones.target_high_mm();
    state_.view = {};
    state_.sides = crown_sides(setup.tooth, setup.zones);
    state_.view.camera.distance_mm = 36.0F;
    state_.view.clear = practice;
    constexpr double k_below_mm = 1.5;  // of the opening: the whole crown is in the picture
    state_.view.camera.target_mm = {static_cast<float>((low.x + high.x) / 2), static_cast<float>((low.y + high.y) / 2),
                                    static_cast<float>(setup.zones.opening_z_mm() - k_below_mm)};
  }

  void go_to(Screen screen) {
    state_.screen = screen;
    state_.message = {};
    state_.confirm_end = state_.confirm_close = state_.rescue_failed = false;  // a question whether to leave goes on
  }

  StationOptions options_;
  std::unique_ptr<ReplayPlayer> replay_;
  scenarios::Scenario scenario_;
  std::vector<Bur> shelf_;
  ui::Interrupt interrupt_;
  ui::SoundOutput sound_;
  StationLock lock_;
  StationCheck check_;
  Window window_;
  Script script_;
  StationState state_;
  Theme theme_;
  double dressed_scale_ = 0.0;
  bool dressed_contrast_ = false;
  std::unique_ptr<OfficeLine> office_;  // outlives the sitting, which may ask it for its word
  std::unique_ptr<Sitting> sitting_;
  std::unique_ptr<Scene> scene_;
  Stage seen_ = Stage::preparing;  // of the sitting, by the screens
  int tutorial_noted_ = 0;         // steps
  bool close_when_sealed_ = false, abandoned_ = false;
  Clock::time_point start_ = Clock::now(), last_frame_ = start_;
};

}  // namespace

int run_station(const StationOptions& options) {
  spare_the_processor();  // before the sound's thread reads the environment
  return Station(options).run();
}

}  // namespace cavum::station
