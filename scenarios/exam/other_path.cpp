#include "scenarios/exam/other_path.h"

#include <fmt/core.h>

#include <filesystem>

namespace cavum::scenarios {

std::unique_ptr<Exam> start_on_first_writable_disk(
    const std::string& path, const std::string& second_path,
    const std::function<std::unique_ptr<Exam>(const std::string& path)>& begin) {
  std::unique_ptr<Exam> exam;
  try {
    exam = begin(path);
  } catch (const DatabaseError& refusal) {
    if (second_path.empty())
      throw Error(
          path,
          msg("cannot be written, and the exam has not begun ({})", in_words(refusal.refusal())),
          msg("make room, or name a file on another disk too: --out-if-full"));
    exam = begin(second_path);
    exam->recorder().add_event(
        0, RecordingMoved{std::filesystem::path(path).filename().string(), 0, refusal.refusal()});
  }
  exam->set_second_path(second_path);
  return exam;
}

std::string rescue_path(const std::string& path) {
  const auto folder = std::filesystem::temp_directory_path();
  const std::string stem = std::filesystem::path(path).stem().string();
  std::string place = (folder / (stem + "-rescued.cavum")).string();
  for (int i = 2; std::filesystem::exists(place); ++i)
    place = (folder / (fmt::format("{}-rescued-{}.cavum", stem, i))).string();
  return place;
}

}  // namespace cavum::scenarios
