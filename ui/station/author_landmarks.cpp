#include "ui/station/author_landmarks.h"

#include <algorithm>
#include <cmath>

#include "engine/base/error.h"
#include "engine/tooth/adjacent.h"
#include "engine/tooth/anatomy/placed.h"

namespace cavum::station {
namespace {

enum class LiesOn { outside, pulp, nothing };

LiesOn lies_on(const std::string& name) {
  if (name.starts_with("pulp_horn") || name == "chamber_roof") return LiesOn::pulp;
  return name == "chamber_floor" || name.starts_with("canal_mouth") ? LiesOn::nothing
                                                                    : LiesOn::outside;
}

/// The part of a line that lies over the tooth's box: from and to, mm along `way`; from > to when
/// there is none.
std::pair<double, double> over_box(const Octree& tree, Vec3 eye, Vec3 way) {
  const Vec3 low = tree.origin_mm(),
             high = low + Vec3{1.0 * tree.size().x, 1.0 * tree.size().y, 1.0 * tree.size().z} *
                              tree.leaf_mm();
  double from = 0, to = 1e6;
  const auto axis = [&](double e, double w, double a, double b) {
    if (std::fabs(w) < 1e-12) {
      if (e < a || e > b) to = -1;
      return;
    }
    const double s = (a - e) / w, t = (b - e) / w;
    from = std::max(from, std::min(s, t));
    to = std::min(to, std::max(s, t));
  };
  axis(eye.x, way.x, low.x, high.x);
  axis(eye.y, way.y, low.y, high.y);
  axis(eye.z, way.z, low.z, high.z);
  return {from, to};
}

/// The first place along a line where `outside_mm(place)`, at most the distance to go from there,
/// is negative; to a hundredth of a leaf.
template <class Outside>
std::optional<Vec3> first_inside(const Octree& tree, Vec3 eye, Vec3 way,
                                 const Outside& outside_mm) {
  const auto [from, to] = over_box(tree, eye, way);
  const double least = 0.25 * tree.leaf_mm();
  double out = from;
  for (double s = from; s <= to;) {
    const double far = outside_mm(eye + way * s);
    if (far < 0) {
      double in = s;
      constexpr int k_halvings = 6;
      for (int i = 0; i < k_halvings; ++i) {
        const double middle = 0.5 * (out + in);
        (outside_mm(eye + way * middle) < 0 ? in : out) = middle;
      }
      return eye + way * in;
    }
    out = s;
    s += std::max(least, 0.8 * far);
  }
  return std::nullopt;
}

std::optional<Vec3> outside_in_sight(const Octree& tree, Vec3 eye, Vec3 way) {
  Octree::Cursor cursor;
  return first_inside(tree, eye, way, [&](Vec3 p) { return tree.sample(p, cursor).distance_mm; });
}

}  // namespace

AuthorTooth read_author_tooth(const std::string& file) {
  AuthorTooth t{file, load_tooth_file(file), {}, {}};
  Tooth alone = own_tooth(t.tooth);
  alone.placed_landmarks.clear();
  t.found = find_landmarks(alone);
  t.alone = std::move(alone.octree);
  return t;
}

Term AuthorLandmark::title() const {
  std::string words = name;
  std::replace(words.begin(), words.end(), '_', ' ');
  return {words};
}

std::vector<AuthorLandmark> author_landmarks(const Landmarks& found,
                                             const std::vector<NamedPoint>& placed) {
  Landmarks all = found;
  place_landmarks(placed, all);
  const std::vector<NamedPoint> before = named_points(found);
  std::vector<AuthorLandmark> list;
  for (const NamedPoint& p : named_points(all)) {
    AuthorLandmark mark{p.name,
                        p.at_mm,
                        {},
                        std::find(all.moved.begin(), all.moved.end(), p.name) != all.moved.end()};
    const auto same = std::find_if(before.begin(), before.end(),
                                   [&](const NamedPoint& b) { return b.name == p.name; });
    if (same != before.end()) mark.found_mm = same->at_mm;
    list.push_back(mark);
  }
  return list;
}

std::vector<NamedPoint> with_landmark(std::vector<NamedPoint> placed, const std::string& name,
                                      Vec3 at_mm) {
  const auto rounded = [](double v) { return std::round(v * 1000) / 1000; };
  const NamedPoint point{name, {rounded(at_mm.x), rounded(at_mm.y), rounded(at_mm.z)}};
  const auto same = std::find_if(placed.begin(), placed.end(),
                                 [&](const NamedPoint& p) { return p.name == name; });
  if (same != placed.end()) {
    *same = point;
    return placed;
  }
  if (placed.size() >= k_max_placed)
    throw Error(Name{name},
                msg("would be the {}th landmark put by hand, and a tooth keeps {}",
                    placed.size() + 1, k_max_placed),
                msg("take one back that was found just as well"));
  placed.push_back(point);
  return placed;
}

std::vector<NamedPoint> without_landmark(std::vector<NamedPoint> placed, const std::string& name,
                                         const Landmarks& found) {
  std::erase_if(placed, [&](const NamedPoint& p) { return p.name == name; });
  Landmarks all = found;
  place_landmarks(placed, all);
  for (const NamedPoint& p : placed)
    if (std::find(all.moved.begin(), all.moved.end(), p.name) == all.moved.end())
      throw Error(Name{name}, msg("stands before {} in its list", p.name),
                  msg("take {} back first", p.name));
  return placed;
}

std::optional<Vec3> landmark_in_sight(const AuthorTooth& tooth, const std::string& name,
                                      Vec3 eye_mm, Vec3 way, Vec3 is_mm) {
  const Octree& tree = tooth.alone;
  switch (lies_on(name)) {
    case LiesOn::outside:
      return outside_in_sight(tree, eye_mm, way);
    case LiesOn::pulp: {
      const std::uint8_t pulp = tooth.tooth.tissue_id("pulp");
      Octree::Cursor cursor;
      return first_inside(tree, eye_mm, way,
                          [&](Vec3 p) { return tree.tissue_at(p, cursor) == pulp ? -1.0 : 0.0; });
    }
    default:
      return eye_mm + way * dot(is_mm - eye_mm, way);
  }
}

bool hidden_in_tooth(const AuthorTooth& tooth, Vec3 eye_mm, Vec3 at_mm) {
  const double far_mm = length(at_mm - eye_mm);
  const auto met = outside_in_sight(tooth.alone, eye_mm, (at_mm - eye_mm) / far_mm);
  constexpr double k_behind_mm = 0.3;
  return met && length(*met - eye_mm) < far_mm - k_behind_mm;
}

}  // namespace cavum::station
