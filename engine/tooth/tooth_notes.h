// What a tooth's source says beside where it comes from: what was only guessed, what was taken although it contradicts, and whether the leaves are
// the mirror image of what was read. Kept in `Tooth::source`, so that every later verb and task can say it again.
#pragma once

#include <string>
#include <vector>

#include "engine/tooth/tooth.h"

namespace cavum {

struct ToothNotes {
  std::vector<std::string> guesses;   ///< told by the shape, said by nobody
  std::vector<std::string> warnings;  ///< not checked, or confirmed against what was measured
  bool mirror_image = false;          ///< of the tooth that was read: +x mesial and +y buccal do not go together on it otherwise
};

/// Adds one to the tooth's source. A semicolon in `text` becomes a comma: it ends a note.
void add_guess(Tooth& tooth, const std::string& text);
void add_warning(Tooth& tooth, const std::string& text);
void note_mirror_image(Tooth& tooth);
/// What was added, in that order.
[[nodiscard]] ToothNotes notes_of(const Tooth& tooth);

}  // namespace cavum
