// One candidate's sitting, from the code that was typed to the sealed session: what is prepared,
// checked, run, graded, and in which order. Knows no window: the screens show it and press its
// buttons, and whatever becomes of them, the session is closed or can be resumed.
#pragma once

#include <chrono>
#include <functional>
#include <future>
#include <memory>
#include <optional>
#include <string>

#include "engine/device/with_desk.h"
#include "grading/feedback/lessons.h"
#include "grading/marking/close_exam.h"
#include "grading/records/station_ticket.h"
#include "scenarios/exam/live_exam.h"
#include "ui/sound/handpiece_sound.h"
#include "ui/station/device_check.h"
#include "ui/station/station_device.h"

namespace cavum::station {

struct SittingOptions {
  std::string scenario, tooth, model = "consistent", rubric;  ///< files as for an exam
  std::string out;          ///< a session file (.cavum), or the folder for one
  std::string out_if_full;  ///< the same, on another disk, for when that one refuses; may be empty
  std::string tickets;      ///< folder with CODE.ticket for each candidate; empty: nobody needs one
  std::string resume;  ///< a session to go on with, by the candidate who began it; scenario and all
                       ///< else are its own
  scenarios::Grant grant;
  bool practice = false;
  bool locked = false;  ///< the station fills the screen, and only the supervisor closes it; the
                        ///< session says so
  DeviceChoice device;
  /// The exam office's word to begin the exam of this ticket's number; empty when the office does
  /// not answer. Waits, of the thread that prepares.
  std::function<std::string(const std::string& ticket_nonce)> word = {};
};

/// Throws Error when its file is damaged or gone.
[[nodiscard]] scenarios::Scenario scenario_of(const SittingOptions& options);
/// All burs there are, by name. Throws Error when the file of one is damaged.
[[nodiscard]] std::vector<Bur> read_shelf(const std::string& scenario_path);

enum class Stage {
  preparing,  ///< files are read, zones laid into the tooth
  checking,   ///< the device is watched
  running,    ///< the exam
  grading,    ///< it is over, and being marked
  unsaved,  ///< it is over or was interrupted, and the disk refuses: all is in memory until `save`
  done,     ///< sealed, with its result
  interrupted,  ///< the device failed: the session is open and can be resumed
};

/// How far an exam had come that is gone on with.
struct Begun {
  Octree tooth;
  double left_s = 0.0;  ///< of its time; 0 where it has no limit
  int bur = 0;          ///< of the tray, that was mounted
};

class Sitting {
 public:
  /// Begins to prepare, in a thread of its own. Throws Error for a device that is none, a code
  /// without a ticket where tickets are asked for, or a session to go on with that is another
  /// candidate's, closed, or of a stylus with another encoder.
  Sitting(SittingOptions options, std::string candidate);
  /// Stops what runs. A session that is not closed by then can be resumed.
  ~Sitting();
  Sitting(const Sitting&) = delete;
  Sitting& operator=(const Sitting&) = delete;

  /// Goes on to the next stage when it is time. Often; never waits for long. Throws Error when
  /// preparing or grading failed.
  void advance();
  [[nodiscard]] Stage stage() const noexcept { return stage_; }
  /// Whether its session stays open when the station ends now.
  [[nodiscard]] bool open() const noexcept {
    return stage_ == Stage::running || stage_ == Stage::interrupted || stage_ == Stage::unsaved;
  }
  [[nodiscard]] const std::string& candidate() const noexcept { return candidate_; }
  [[nodiscard]] bool practice() const noexcept { return options_.practice; }
  /// Since the candidate signed in.
  [[nodiscard]] double here_s() const {
    return std::chrono::duration<double>(std::chrono::steady_clock::now() - signed_in_at_).count();
  }

  /// From `checking` on.
  [[nodiscard]] const scenarios::ExamSetup& setup() const { return *setup_; }
  /// None: it begins anew.
  [[nodiscard]] const std::optional<Begun>& begun() const noexcept { return begun_; }
  [[nodiscard]] StationDevice& device() { return *device_; }
  [[nodiscard]] DeviceSight sight() const;
  /// From `checking` to `running`: begins to record, at the second place when the first refuses.
  /// Throws Error when that is impossible; the stage stays.
  void begin();

  /// While `running`.
  [[nodiscard]] scenarios::LiveExam& live() { return *live_; }
  [[nodiscard]] Desk& desk() noexcept { return desk_; }
  /// Of its clock; 0 while it does not run.
  [[nodiscard]] double exam_s();
  /// What is heard of the handpiece: nothing while it does not run.
  [[nodiscard]] ui::SoundParameters sound();
  void ask_to_end();
  /// Recorded as an event of the session, see LiveExam::note; nothing while it does not run.
  void note(Event event);
  /// The exam is left as it is: `interrupted`, or `unsaved` when the disk refuses its end; nothing
  /// while it does not run.
  void stop();
  /// For when nobody answers any more: stops what runs, waits until what was graded is sealed, and
  /// saves what is in memory only, where it is or else at rescue_path(). Throws Error when no place
  /// takes it.
  void rescue();

  /// When `done`.
  [[nodiscard]] const grading::ClosedExam& closed() const { return *closed_; }
  /// What the candidate should take away of it, the dearest mistake first.
  [[nodiscard]] const std::vector<grading::Lesson>& lessons() const { return lessons_; }
  [[nodiscard]] const scenarios::LiveReport& report() const { return report_; }
  /// Of the session, from `running` on.
  [[nodiscard]] const std::string& path() const noexcept { return path_; }
  /// When `unsaved`: tries again, in another place unless that is empty: a session file that does
  /// not exist yet, or a folder. Throws Error when that is refused, too; the stage stays. By itself
  /// it tries again once there is room.
  void save(const std::string& place);
  /// For a while after it began to be recorded at the second place, and why; else empty.
  [[nodiscard]] const Message& moved() const noexcept { return moved_; }
  /// How much of the exam is in memory only, s.
  [[nodiscard]] double unwritten_s() const;

  /// When `interrupted` or `unsaved`: why.
  [[nodiscard]] const Message& trouble() const noexcept { return trouble_; }

 private:
  [[nodiscard]] MotionSource source() const;
  void end_running();
  void refused(const Message& trouble, const DiskRefusal& refusal) {
    trouble_ = trouble, refusal_ = refusal;
  }
  [[nodiscard]] Message why_stopped() const;
  void close_exam();
  [[nodiscard]] std::string new_path(const std::string& out) const;
  void look_where_it_is_recorded();

  SittingOptions options_;
  std::string candidate_;
  Stage stage_ = Stage::preparing;
  std::unique_ptr<StationDevice> device_;
  std::future<std::unique_ptr<scenarios::ExamSetup>> preparing_;
  std::unique_ptr<scenarios::ExamSetup> setup_;
  std::optional<Begun> begun_;                 ///< of the thread that prepares, until it is ready
  std::optional<records::HeldTicket> ticket_;  ///< that this exam will use up
  std::unique_ptr<DeviceCheck> check_;
  DeviceSight last_sight_;
  Desk desk_;
  std::unique_ptr<WithDesk> with_desk_;
  std::unique_ptr<scenarios::LiveExam> live_;
  std::vector<grading::Lesson> lessons_;  // of `grading_` until it is ready
  std::future<grading::ClosedExam> grading_;
  std::optional<grading::ClosedExam> closed_;
  scenarios::LiveReport report_;
  std::string path_;
  Message trouble_, moved_;
  DiskRefusal refusal_;  ///< when `unsaved`
  const std::chrono::steady_clock::time_point signed_in_at_ = std::chrono::steady_clock::now();
  std::chrono::steady_clock::time_point moved_at_;
  std::chrono::steady_clock::time_point last_try_;  ///< to save by itself
};

}  // namespace cavum::station
