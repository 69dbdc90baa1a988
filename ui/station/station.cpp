#include "ui/station/station.h"

#include <imgui.h>

#include <algorithm>
#include <array>
#include <filesystem>

#include "engine/base/error.h"
#include "engine/base/file.h"
#include "engine/base/message_from.h"
#include "scenarios/exam/other_path.h"
#include "ui/parts/interrupt.h"
#include "ui/parts/say.h"
#include "ui/parts/scenario_words.h"
#include "ui/report/report.h"
#include "ui/sound/sound_output.h"
#include "ui/station/look.h"
#include "ui/station/office_line.h"
#include "ui/station/screens.h"
#include "ui/station/script.h"
#include "ui/station/station_lock.h"
#include "ui/station/window.h"

namespace cavum::station {
namespace {

using Clock = std::chrono::steady_clock;

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
    if (!options_.script.empty())
      script_ = Script(read_text_file(options_.script), options_.script, options_.pictures);
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
        throw Error(msg("station"), msg("failed during the exam ({})", message_from(e)),
                    msg("what was done is recorded; go on with: cavum station --resume {}",
                        open_session()));
      throw;
    }
    if (!abandoned_) rescue();
    const std::string open = open_session();
    if (open.empty()) return 0;
    if (abandoned_)
      ui::say_error(
          msg("station: the last {} of the exam were given up", as_s(sitting_->unwritten_s(), 1)));
    sitting_.reset();
    ui::say_error(msg(
        "station: was closed during the exam; what was done is recorded; go on with: cavum station --resume {} (or close it as it stands: cavum "
        "exam --resume --end --out {})",
        open, open));
    return 1;
  }

 private:
  /// Path of the session that would stay open if the window closed now.
  [[nodiscard]] std::string open_session() const {
    return sitting_ && sitting_->open() ? sitting_->path() : std::string();
  }

  /// The window was asked to close, and nothing would be lost. Else it stays open, and asks or
  /// waits.
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

  /// Nobody may be there to answer: what is in memory only goes wherever there is room, and
  /// standard error says where.
  void rescue() {
    if (!sitting_) return;
    const std::string first = sitting_->path();
    sitting_->rescue();
    tell_moved(first);
  }
  void tell_moved(const std::string& first) const {
    if (!first.empty() && sitting_->path() != first)
      ui::say_error(msg("station: {} could not be written; the whole exam is saved at {}", first,
                        sitting_->path()));
  }

  void frame() {
    const auto began = Clock::now();
    const double frame_s = std::min(0.1, seconds_since(last_frame_));
    last_frame_ = began;
    look_.follow(window_, state_, most_scale());
    script_.step(window_, state_.screen, exam_s(), seconds_since(start_));
    window_.begin_frame();
    show(frame_s);
    window_.end_frame();
    script_.shown(state_.screen, exam_s(), state_.view.tool.tip_mm);
    const bool is_stylus =
        std::exchange(state_.capture_mouse, false) && state_.screen == Screen::exam;
    window_.capture_mouse(is_stylus);
    window_.walk_by_keys(!pointer_at_work());
    sound_.set(state_.screen == Screen::exam ? sitting_->sound() : ui::SoundParameters());
    sound_.set_muted(state_.muted);
    note_tutorial();
    lock_.watch(window_, state_, sitting_.get());
    if (office_) office_->exchange(state_, sitting_.get());
    grant(std::exchange(state_.wish, Wish::none));
    go_on();
    window_.rest(began, script_.pace_hz());
  }

  /// Mouse and keyboard are the stylus: every key has a meaning of its own, and none walks from
  /// button to button.
  [[nodiscard]] bool pointer_at_work() const {
    return state_.screen == Screen::exam && sitting_ && sitting_->device().pointer() != nullptr &&
           !state_.confirm_end && !state_.confirm_close && !state_.confirm_leave;
  }
  /// A window that has less than the screens need shows smaller text, whatever was asked for.
  [[nodiscard]] static double most_scale() {
    constexpr double k_min_width = 720.0, k_min_height = 450.0,
                     k_min_scale = 0.6;  // pixels at scale 1
    const ImVec2 size = ImGui::GetIO().DisplaySize;
    return std::max(k_min_scale, std::min(size.x / k_min_width, size.y / k_min_height));
  }

  [[nodiscard]] double exam_s() { return sitting_ ? sitting_->exam_s() : 0.0; }

  void show(double frame_s) {
    const ScreenContext context{look_.theme(),
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
    constexpr std::array k_screens = {sign_in_screen,      self_check_screen, preparing_screen,
                                      device_check_screen, briefing_screen,   exam_screen,
                                      grading_screen,      result_screen,     replay_screen,
                                      trouble_screen,      save_screen};
    // the author's come after these, in a window of their own (author.h)
    if (const auto screen = static_cast<std::size_t>(context.state.screen);
        screen < k_screens.size())
      k_screens[screen](context);
  }

  /// Each step of the tutorial that was done is recorded.
  void note_tutorial() {
    const int done = state_.tutorial ? state_.tutorial->step() : 0;
    if (done > tutorial_noted_) sitting_->note(TutorialStep{done});
    tutorial_noted_ = done;
  }

  void grant(Wish wish) {
    try {
      switch (wish) {
        case Wish::sign_in:
          return sign_in();
        case Wish::check:
          state_.message = {};
          state_.focus_supervisor = true;  // once there is its field
          return check_.begin();
        case Wish::check_go_on:
          return go_on_with_check();
        case Wish::to_briefing:
          return go_to(Screen::briefing);
        case Wish::begin:
          OfficeLine::require_free(state_);
          sitting_->begin();
          state_.attempts = 0;
          state_.tutorial.reset();
          if (state_.tutorial_wanted)
            state_.tutorial.emplace(sitting_->device().pointer() != nullptr);
          state_.attempt_shown_s = 0.0;
          reserve_picture_memory();
          return go_to(Screen::exam);
        case Wish::end:
          return sitting_->ask_to_end();
        case Wish::save:
          return sitting_->save(state_.place.data());
        case Wish::rescue: {
          state_.rescue_failed = true;  // unless it is saved
          const std::string first = sitting_->path();
          sitting_->save(scenarios::rescue_path(first));
          tell_moved(first);
          state_.rescue_failed = false;
          close_when_sealed_ = true;
          break;
        }
        case Wish::abandon:
          abandoned_ = true;
          return window_.ask_to_close();
        case Wish::leave:
          return lock_.leave(window_, state_, sitting_.get());
        case Wish::read:
          return office_->read(state_, sitting_.get());
        case Wish::go_on:
          return go_on_without_office();
        case Wish::report:
          return write_report();
        case Wish::next_candidate:
          return next_candidate();
        case Wish::quit:
          return window_.ask_to_close();
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
    if (!check_.good()) state_.message = lock_.refusal(state_);
    if (!check_.good() && !state_.message.empty()) return;
    check_.go_on(lock_.locked());
    sign_in();
  }

  void go_on_without_office() {
    state_.leave_message = lock_.refusal(state_);
    if (!state_.leave_message.empty()) return;
    state_.confirm_go_on = false;
    office_->release(state_, sitting_.get());
  }

  void sign_in() {
    OfficeLine::require_free(state_);
    if (options_.self_check_hours && !(state_.screen == Screen::self_check && check_.found()) &&
        check_.due(options_.sitting)) {
      check_.forget();
      return go_to(Screen::self_check);
    }
    SittingOptions o = options_.sitting;
    o.locked = lock_.locked();
    if (office_) o.word = [this](const std::string& nonce) { return office_->begin(nonce); };
    lock_.begin_sitting();
    seen_ = Stage::preparing;
    const bool fixed =
        !o.tickets.empty() ||
        !o.resume
             .empty();  // what is granted stands there already; the layout is the candidate's own
    if (!fixed && state_.left_handed != scenario_.accommodations.left_handed)
      o.grant.left_handed = state_.left_handed;
    if (!fixed && state_.high_contrast != scenario_.accommodations.high_contrast)
      o.grant.high_contrast = state_.high_contrast;
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
    const std::string path =
        std::filesystem::path(sitting_->path()).replace_extension(".html").string();
    report::require_report_path(path);
    report::write_closing_report(path, sitting_->path(), closed.result, *closed.graded,
                                 report::ReportReader::student);
    state_.message = msg("Report: {}", path);
  }

  void next_candidate() {
    if (options_.sitting.out.ends_with(".cavum") || !options_.sitting.resume.empty())
      return window_.ask_to_close();  // one session was asked for
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
    if (close_when_sealed_ && (now == Stage::done || now == Stage::interrupted))
      window_.ask_to_close();
    if (now == Stage::interrupted) {
      go_to(Screen::trouble);
      state_.message = sitting_->trouble();
    }
  }

  void make_scene(const scenarios::ExamSetup& setup, bool practice) {
    scene_ = std::make_unique<Scene>(setup.tooth.octree, setup.tooth.tissues, setup.burs,
                                     practice ? &setup.zones : nullptr);
    scene_->fix_effects(options_.effects);
    const Vec3 low = setup.zones.target_low_mm(), high = setup.zones.target_high_mm();
    state_.view = {};
    state_.sides = crown_sides(setup.tooth, setup.zones);
    state_.view.camera.distance_mm = 36.0F;
    state_.view.clear = practice;
    constexpr double k_below_mm = 1.5;  // of the opening: the whole crown is in the picture
    state_.view.camera.target_mm = {static_cast<float>((low.x + high.x) / 2),
                                    static_cast<float>((low.y + high.y) / 2),
                                    static_cast<float>(setup.zones.opening_z_mm() - k_below_mm)};
  }

  void go_to(Screen screen) {
    state_.screen = screen;
    state_.message = {};
    state_.confirm_end = state_.confirm_close = state_.rescue_failed =
        false;  // a question whether to leave goes on
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
  Look look_;
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
