#include "engine/tooth/tooth_notes.h"

#include <algorithm>
#include <string_view>

namespace cavum {
namespace {

constexpr std::string_view k_between = "; ",
                           k_guess_note = "guess: ", k_warning_note = "warning: ", k_mirror_note = "mirror image, so that +x is mesial and +y buccal";

void add_note(Tooth& tooth, std::string_view kind, std::string text) {
  std::replace(text.begin(), text.end(), ';', ',');
  tooth.source.append(k_between).append(kind).append(text);
}

}  // namespace

void add_guess(Tooth& tooth, const std::string& text) { add_note(tooth, k_guess_note, text); }
void add_warning(Tooth& tooth, const std::string& text) { add_note(tooth, k_warning_note, text); }
void note_mirror_image(Tooth& tooth) { add_note(tooth, k_mirror_note, ""); }

ToothNotes notes_of(const Tooth& tooth) {
  ToothNotes notes;
  std::string_view left = tooth.source;
  while (!left.empty()) {
    const auto end = left.find(k_between);
    const std::string_view part = left.substr(0, end);
    left = end == std::string_view::npos ? std::string_view() : left.substr(end + k_between.size());
    if (part.starts_with(k_guess_note)) notes.guesses.emplace_back(part.substr(k_guess_note.size()));
    if (part.starts_with(k_warning_note)) notes.warnings.emplace_back(part.substr(k_warning_note.size()));
    if (part == k_mirror_note) notes.mirror_image = true;
  }
  return notes;
}

}  // namespace cavum
