// Landmarks of the tooth in the authoring view: where each stands, whether it was found or put
// there by a person, and the surface on which it is moved.
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "engine/tooth/anatomy/landmarks.h"

namespace cavum::station {

/// The scenario's tooth as its file has it, with what landmarks are moved on.
struct AuthorTooth {
  std::string file;
  Tooth tooth;
  Octree alone;     ///< without what stands beside it
  Landmarks found;  ///< as if nobody had put any
};
/// Throws Error when the file cannot be read.
[[nodiscard]] AuthorTooth read_author_tooth(const std::string& file);

struct AuthorLandmark {
  std::string name;              ///< of named_points: "mesial_pit"
  Vec3 at_mm;                    ///< tooth frame
  std::optional<Vec3> found_mm;  ///< where it was found; none: a person alone says that it is there
  bool by_person = false;        ///< a person put it where it is
  [[nodiscard]] Term title() const;  ///< "mesial pit"
};
/// All there are, in the order of named_points. `placed`: those that a person put.
[[nodiscard]] std::vector<AuthorLandmark> author_landmarks(const Landmarks& found,
                                                           const std::vector<NamedPoint>& placed);

/// `placed` with a point of that name at `at_mm`, to a thousandth of a mm. Throws Error when a
/// tooth holds no more of them.
[[nodiscard]] std::vector<NamedPoint> with_landmark(std::vector<NamedPoint> placed,
                                                    const std::string& name, Vec3 at_mm);
/// `placed` without it. Throws Error when a later point of its list would then have no place (cusp
/// 6 without a cusp 5).
[[nodiscard]] std::vector<NamedPoint> without_landmark(std::vector<NamedPoint> placed,
                                                       const std::string& name,
                                                       const Landmarks& found);

/// Where a line of sight from `eye_mm` along the unit vector `way` meets what the landmark lies on:
/// the outside of enamel and dentin for cusps, ridges, pits and apices, the pulp's outside for its
/// horns and the chamber's roof. The chamber's floor and the canals' mouths lie within the pulp:
/// they stay as far away as `is_mm`. None when the line misses.
[[nodiscard]] std::optional<Vec3> landmark_in_sight(const AuthorTooth& tooth,
                                                    const std::string& name, Vec3 eye_mm, Vec3 way,
                                                    Vec3 is_mm);
/// Whether the tooth's outside hides `at_mm` from the eye by more than 0.3 mm.
[[nodiscard]] bool hidden_in_tooth(const AuthorTooth& tooth, Vec3 eye_mm, Vec3 at_mm);

}  // namespace cavum::station
