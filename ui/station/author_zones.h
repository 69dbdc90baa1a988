// What of a scenario's zones can be changed by hand: the points of outlines and the sizes of
// bodies, each with its place in the file, and where the points lie on the tooth.
#pragma once

#include <array>
#include <optional>
#include <string>
#include <vector>

#include "engine/base/message.h"
#include "scenarios/zones/shape.h"

namespace cavum::station {

enum class AuthorLayer { target, leeway, container, guarded };
inline constexpr std::size_t k_author_layers = 4;
[[nodiscard]] Message word_of(AuthorLayer layer);
/// Red, green, blue, 0..255, of Okabe and Ito's palette: told apart by lightness, too.
[[nodiscard]] std::array<std::uint8_t, 3> layer_colour(AuthorLayer layer) noexcept;

struct AuthorNumber {
  Message label;
  std::string place;  ///< of edit_text.h
  double value = 0.0, low = 0.0, high = 0.0;
  Unit unit = Unit::mm;
};

struct AuthorZone {
  AuthorLayer layer = AuthorLayer::target;
  Message title;
  int line = 0;
  std::vector<AuthorNumber> numbers;  ///< the first is its depth, where it has one
  std::string points_place;           ///< of the list; empty without points
  std::vector<Vec3> points_mm;        ///< as written, x and y
  bool closed = false;                ///< the points go round; else they are a path
  double half_width_mm = 0.0;         ///< of a path's stroke
  std::size_t least_points = 2;
  /// Where a point lies: at + x·point.x + y·point.y, on the level of the opening.
  scenarios::ShapeFrame frame;
  std::optional<double> depth_mm;  ///< of a column below the opening
  std::string depth_place;

  [[nodiscard]] Vec3 in_tooth(Vec3 point) const noexcept {
    return frame.at + frame.x * point.x + frame.y * point.y;
  }
};

/// `opening_z_mm`: level on which points are shown; `chamber_mm`: the chamber's middle, where
/// outlines count from it.
[[nodiscard]] std::vector<AuthorZone> author_zones(const scenarios::Scenario& scenario,
                                                   double opening_z_mm, Vec3 chamber_mm);

}  // namespace cavum::station
