#include "ui/verbs/full_disk.h"

#include <cstdio>
#include <iostream>

#include "engine/base/text.h"
#include "scenarios/exam/other_place.h"

namespace cavum::ui {
namespace {

double waiting_s(scenarios::Exam& exam) {
  const Recorder& r = exam.recorder();
  return static_cast<double>(r.ticks() - r.ticks_on_disk()) * exam.model().config.tick_s;
}

/// True when the exam is at `place` by now, whole or not.
bool moved(scenarios::Exam& exam, const std::string& place, const std::string& why) {
  try {
    exam.recorder().move_to(place, why);
  } catch (const Error& e) {
    std::fprintf(stderr, "cavum: %s\n", one_line(e.what()).c_str());
  }
  return exam.recorder().path() == place;
}

}  // namespace

void RecordingWatch::begun(const std::string& path) {
  if (path == path_) return;
  std::fprintf(stderr, "cavum: %s: cannot be written, its disk is full or refuses; the whole exam is recorded at %s\n", one_line(path_).c_str(),
               one_line(path).c_str());
  path_ = path;
}

void RecordingWatch::look(const std::string& problem, const std::string& path) {
  if (path != path_) {
    std::fprintf(stderr, "\ncavum: %s: cannot be written; recording goes on at %s, with all that was recorded before\n", one_line(path_).c_str(),
                 one_line(path).c_str());
    path_ = path;
    told_ = false;
  }
  if (!problem.empty() && !told_)
    std::fprintf(stderr, "\ncavum: %s\ncavum: the exam goes on: what is not on disk is kept in memory, and written as soon as there is room\n",
                 one_line(problem).c_str());
  if (problem.empty() && told_) std::fprintf(stderr, "\ncavum: %s: all is on disk again\n", one_line(path_).c_str());
  told_ = !problem.empty();
}

void write_somewhere(scenarios::Exam& exam, const std::string& second_place, const std::function<void()>& write) {
  bool second_tried = second_place.empty(), nobody = false;
  for (;;) {
    std::string why;
    try {
      return write();
    } catch (const DatabaseError& refusal) {
      why = refusal.what();
    }
    std::fprintf(stderr, "\ncavum: %s\n", one_line(why).c_str());
    if (!second_tried) {
      second_tried = true;
      if (exam.recorder().path() == second_place || moved(exam, second_place, why)) continue;
    }
    if (nobody)
      throw Error(exam.recorder().path(), msg("cannot be written, nor can any other place"),
                  msg("what was on disk before can be resumed from there"));
    std::fprintf(
        stderr,
        "cavum: %.1f s of the exam and its end are in memory only. Make room and press Enter, or type another file (.cavum) to save the whole "
        "exam to: ",
        waiting_s(exam));
    std::string answer;
    if (!std::getline(std::cin, answer)) {
      std::fprintf(stderr, "\n");
      nobody = true;
      answer = scenarios::rescue_place(exam.recorder().path());
    }
    if (!answer.empty() && moved(exam, answer, why))
      std::fprintf(stderr, "cavum: the whole exam is at %s%s\n", one_line(answer).c_str(),
                   nobody ? ", in the folder for temporary files: copy it from there before the computer is switched off" : "");
  }
}

}  // namespace cavum::ui
