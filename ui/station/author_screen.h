// What the authoring view shows and takes in: zones, sizes and findings as panels around the tooth,
// with the points of the chosen outline and the tooth's landmarks on it.
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
  bool by_landmarks = false;  ///< keys and panel are those of landmarks, not of zones
  bool landmarks_shown = true;
  std::size_t landmark = 0;
  bool pulls_landmark = false;  ///< by the mouse
  ImVec2 held_off;              ///< from the mouse to the landmark as it was taken, pixels
  std::array<bool, k_author_layers> shown{true, true, true, true};
  bool shown_differs = false;
  bool ask_close = false;
  bool ask_tooth = false;    ///< what the tooth's new file is to be called
  bool tooth_named = false;  ///< it was answered
  bool close_then = false;   ///< when that is saved
  std::array<char, 200> tooth_name{};
  Message message;  ///< what went wrong, what was done
};

enum class AuthorWish { none, save, save_and_close, undo, redo, read_again, close, discard };

struct AuthorContext {
  const ScreenContext& screen;
  AuthorDocument& document;
  AuthorState& state;
  const std::vector<AuthorZone>& zones;
  const std::vector<AuthorLandmark>& landmarks;
  const std::vector<scenarios::Problem>& problems;
  const AuthorFindings* findings = nullptr;  ///< the newest; null before the first
  bool busy = true;                          ///< the text differs from what was checked
  double floor_z_mm = 0.0;                   ///< lowest level of the target, as last found
};

/// One frame; returns what the window has to do.
[[nodiscard]] AuthorWish author_screen(const AuthorContext& c);

/// The tooth with outlines, points and landmarks over it, and what mouse and arrows do there.
void author_picture(const AuthorContext& c, ImVec2 at, ImVec2 size);

/// A change by hand of the zone's point or number; what cannot be done becomes the message. `pull`:
/// one of many while the mouse is held.
void author_move_point(const AuthorContext& c, const AuthorZone& zone, std::size_t point, Vec3 to,
                       bool pull);
void author_set_number(const AuthorContext& c, const AuthorNumber& number, double value, bool pull);

/// Puts a landmark where a person wants it, or (no place) back where it was found.
void author_move_landmark(const AuthorContext& c, const AuthorLandmark& landmark,
                          const std::optional<Vec3>& to, bool pull);

// Of landmarks, in author_landmark_picture.cpp: drawn over the picture, taken with the mouse
// (false: none is near), pulled, moved by arrows; and their part of the panel.
struct AuthorSight;
void draw_landmarks(const AuthorContext& c, ImDrawList& draw, const AuthorSight& sight);
bool take_landmark(const AuthorContext& c, const AuthorSight& sight, ImVec2 mouse);
void pull_landmark(const AuthorContext& c, const AuthorSight& sight, ImVec2 mouse);
void landmark_arrows(const AuthorContext& c);
void landmark_list(const AuthorContext& c);

}  // namespace cavum::station
