// An exam made ready and run tick by tick: scenario, tooth, tray and force model come together
// here, and every tick goes through the same four steps, whether a hand, a motion file or a
// simulated candidate gives the input: servo, runner, events, recording.
#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "engine/session/recorder.h"
#include "engine/session/resume.h"
#include "scenarios/exam/runner.h"
#include "scenarios/file/accommodations.h"
#include "scenarios/file/parse.h"

namespace cavum::scenarios {

/// A file that ships with Cavum, by folder and name ("burs", "round-1.0.toml"): looked for in
/// $CAVUM_DATA, beside `near_file`'s folder (../burs of data/scenarios/x.toml), in ./data, and
/// where Cavum was built or installed. Throws Error naming the places.
[[nodiscard]] std::string find_data_file(const std::string& folder, const std::string& name,
                                         const std::string& near_file);

/// Names (without .toml) of the files in the first of those folders that exists, sorted.
[[nodiscard]] std::vector<std::string> data_names(const std::string& folder,
                                                  const std::string& near_file);

/// Text of a force model: the name of data/materials/NAME.toml, or a path ending in .toml. Throws
/// Error.
[[nodiscard]] std::string force_model_text(const std::string& wanted, const std::string& near_file);

/// What may be chosen beside the scenario itself.
struct ExamOptions {
  std::string candidate;             ///< pseudonym
  MotionSource source;               ///< what moves the stylus, as it is signed
  double position_quantum_mm = 0.0;  ///< step of its encoder; 0 = exact
  double peak_n = 0.0,
         continuous_n = 0.0;  ///< forces that it bears; 0 or more than usual = the usual limits
  std::string tooth_file;     ///< empty: the scenario's
  std::string force_model =
      "consistent";         ///< name of data/materials/NAME.toml, or a path ending in .toml
  std::string rubric_file;  ///< empty: the scenario's own rubric counts
  Grant grant;              ///< accommodations beside the scenario's own
  std::vector<std::pair<std::string, std::string>> notes;  ///< recorded as they are
};

/// What is asked for in one exam.
struct ExamTask {
  Scenario scenario;  ///< with its surfaces and what was granted
  std::vector<Bur> burs;
  std::vector<std::string> bur_names;  ///< in the order of the tray
  SessionSetup session;
};
/// The task again from what a session holds; `scenario_name` and `bur_names` name its texts in
/// errors. Throws Error.
[[nodiscard]] ExamTask exam_task(SessionSetup session, const std::string& scenario_name,
                                 const std::vector<std::string>& bur_names = {});

/// Everything constant during one exam.
struct ExamSetup : ExamTask {
  Tooth tooth;
  ZoneMap zones;
};
/// What of a session's servo settings is not what every exam of its scenario runs with, in words:
/// another length of a tick, another speed of the handpiece, another watchdog. The device's own are
/// its encoder and forces that are smaller than usual.
[[nodiscard]] std::vector<Message> check_servo(const std::string& servo_toml,
                                               const Scenario& scenario);
/// Reads all files. Throws Error on any that is missing or wrong.
[[nodiscard]] std::unique_ptr<ExamSetup> prepare_exam(const std::string& scenario_path,
                                                      const ExamOptions& options);
/// The same from what a session holds: for resuming and regrading.
[[nodiscard]] std::unique_ptr<ExamSetup> prepare_exam(const SessionSetup& session);

/// A running exam.
class Exam {
 public:
  /// Starts recording to `path`, with the tip at `first_tip_mm`. Throws Error when it cannot.
  [[nodiscard]] static std::unique_ptr<Exam> start(const ExamSetup& setup, const std::string& path,
                                                   Vec3 first_tip_mm,
                                                   const ReadClocks& clocks = read_clocks);
  /// Takes up a session that was killed, with the setup it holds; the ticks recorded so far are
  /// simulated again. `by` gives the input from now on.
  [[nodiscard]] static std::unique_ptr<Exam> resume(const ExamSetup& setup, const std::string& path,
                                                    const ResumedBy& by = {},
                                                    const ReadClocks& clocks = read_clocks);

  /// One tick, in a pause with the pedal released, whatever the foot does. When the disk refuses
  /// it, it is kept in memory, the exam goes on, and `recording_problem` says so; it is written
  /// with a later second, or at the second place.
  const TickOutput& tick(const TickInput& input);
  /// The same with what another servo consumed already, exactly as it is.
  const TickOutput& follow(const TickInput& consumed);
  [[nodiscard]] bool over() const noexcept { return runner_state_->finish != Finish::running; }
  /// Why the recording cannot be written at the moment; empty while all but the running second is
  /// on disk.
  [[nodiscard]] const Message& recording_problem() const noexcept { return problem_; }
  /// Where to go on at once when the disk refuses: a session file that does not exist yet. The
  /// recorder's path says where it stands.
  void set_second_path(const std::string& path) { second_path_ = path; }
  /// The candidate stops: the exam is over.
  void end();
  /// Records that the candidate went on for so many ticks after time was up, in `pedal_ticks` of
  /// them with the pedal pressed. That work is not simulated, and nothing of it counts.
  void note_late(std::int64_t ticks, std::int64_t pedal_ticks);
  /// Seals the session with the tooth as it is and the result.
  void close(const std::string& result_json);

  [[nodiscard]] const ExamSetup& setup() const noexcept { return setup_; }
  [[nodiscard]] const TickOutput& last() const noexcept { return last_; }
  [[nodiscard]] const TickInput& last_input() const noexcept { return last_input_; }
  [[nodiscard]] const RunnerState& runner_state() const noexcept { return *runner_state_; }
  [[nodiscard]] const std::string& instruction() const noexcept {
    return runner_.instruction(*runner_state_);
  }
  /// The exam's time limit with all extra time; 0 = none.
  [[nodiscard]] std::int64_t limit_ticks() const noexcept { return runner_.limit_ticks(); }
  [[nodiscard]] const ServoModel& model() const noexcept { return simulation_.model; }
  [[nodiscard]] const ServoState& state() const noexcept { return simulation_.state; }
  [[nodiscard]] Tooth tooth_now() const { return drilled_tooth(simulation_); }
  [[nodiscard]] Recorder& recorder() noexcept { return *recorder_; }
  [[nodiscard]] const Recorder& recorder() const noexcept { return *recorder_; }

 private:
  Exam(const ExamSetup& setup, Simulation simulation);
  void record_events();
  void keep(const DatabaseError& refusal);

  const ExamSetup& setup_;
  Runner runner_;
  std::unique_ptr<RunnerState> runner_state_ = std::make_unique<RunnerState>();
  std::uint32_t events_recorded_ = 0;
  std::optional<Recorder> recorder_;
  Simulation simulation_;
  TickOutput last_;
  TickInput last_input_;
  Message problem_;
  std::string second_path_;
};

}  // namespace cavum::scenarios
