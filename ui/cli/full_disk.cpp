#include "ui/cli/full_disk.h"

#include <iostream>

#include "scenarios/exam/other_path.h"
#include "ui/language/say.h"
#include "ui/parts/say.h"

namespace cavum::ui {
namespace {

double waiting_s(scenarios::Exam& exam) {
  const Recorder& r = exam.recorder();
  return static_cast<double>(r.ticks() - r.ticks_on_disk()) * exam.model().config.tick_s;
}

/// True when the exam is at `place` by now, whole or not.
bool moved(scenarios::Exam& exam, const std::string& place, const DiskRefusal& why) {
  try {
    exam.recorder().move_to(place, why);
  } catch (const Error& e) {
    say_error(e.message());
  }
  return exam.recorder().path() == place;
}

}  // namespace

void RecordingWatch::begun(const std::string& path) {
  if (path == path_) return;
  say_error(
      msg("{}: cannot be written, its disk is full or refuses; the whole exam is recorded at {}",
          path_, path));
  path_ = path;
}

void RecordingWatch::look(const Message& problem, const std::string& path) {
  if (path != path_) {
    std::cerr << "\n";
    say_error(
        msg("{}: cannot be written; recording goes on at {}, with all that was recorded before",
            path_, path));
    path_ = path;
    told_ = false;
  }
  if (!problem.empty() && !told_) {
    std::cerr << "\n";
    say_error(problem);
    say_error(msg(
        "the exam goes on: what is not on disk is kept in memory, and written as soon as there is room"));
  }
  if (problem.empty() && told_) {
    std::cerr << "\n";
    say_error(msg("{}: all is on disk again", path_));
  }
  told_ = !problem.empty();
}

void write_somewhere(scenarios::Exam& exam, const std::string& second_path,
                     const std::function<void()>& write) {
  bool second_tried = second_path.empty(), nobody = false;
  for (;;) {
    DiskRefusal why;
    try {
      return write();
    } catch (const DatabaseError& refusal) {
      why = refusal.refusal();
      std::cerr << "\n";
      say_error(refusal.message());
    }
    if (!second_tried) {
      second_tried = true;
      if (exam.recorder().path() == second_path || moved(exam, second_path, why)) continue;
    }
    if (nobody)
      throw Error(Name{exam.recorder().path()}, msg("cannot be written, nor can any other place"),
                  msg("what was on disk before can be resumed from there"));
    std::cerr
        << "cavum: "
        << tr("{} of the exam and its end are in memory only. Make room and press Enter, or type another file (.cavum) to save the whole exam to:",
              as_s(waiting_s(exam), 1))
        << " ";
    std::string answer;
    if (!std::getline(std::cin, answer)) {
      std::cerr << "\n";
      nobody = true;
      answer = scenarios::rescue_path(exam.recorder().path());
    }
    if (!answer.empty() && moved(exam, answer, why))
      say_error(
          nobody
              ? msg("the whole exam is at {}, in the folder for temporary files: copy it from there before the computer is switched off",
                    answer)
              : msg("the whole exam is at {}", answer));
  }
}

}  // namespace cavum::ui
