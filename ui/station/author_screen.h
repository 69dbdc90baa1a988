// What the authoring view shows and takes in: zones, sizes and findings as panels around the tooth, with the points of the chosen outline on it.
#pragma once

#include <string>
#include <vector>

#include "ui/station/author_document.h"
#include "ui/station/author_worker.h"
#include "ui/station/screens.h"

namespace cavum::station {

/// What the author chose; plain values.
struct AuthorState {
  std::size_t zone = 0, point = 0, number = 0;
  bool pulls_point = false, pulls_depth = false;  ///< by the mouse
  std::array<bool, k_author_layers> shown{true, true, true, true};
  bool shown_differs = false;
  bool ask_close = false;
  std::string message;  ///< what went wrong, what was done
};

enum class AuthorWish { none, save, save_and_close, undo, redo, read_again, close, discard };

struct AuthorContext {
  const ScreenContext& screen;
  AuthorDocument& document;
  AuthorState& state;
  const std::vector<AuthorZone>& zones;
  const std::vector<scenarios::Problem>& problems;
  const AuthorFindings* findings = nullptr;  ///< the newest; null before the first
  bool busy = true;                          ///< the text differs from what was checked
  double floor_z_mm = 0.0;                   ///< lowest level of the target, as last found
};

/// One frame; returns what the window has to do.
[[nodiscard]] AuthorWish author_screen(const AuthorContext& c);

/// The tooth with outlines and points over it, and what mouse and arrows do there.
void author_picture(const AuthorContext& c, ImVec2 at, ImVec2 size);

/// A change by hand of the zone's point or number; what cannot be done becomes the message. `pull`: one of many while the mouse is held.
void author_move_point(const AuthorContext& c, const AuthorZone& zone, std::size_t point, Vec3 to, bool pull);
void author_set_number(const AuthorContext& c, const AuthorNumber& number, double value, bool pull);

}  // namespace cavum::station
