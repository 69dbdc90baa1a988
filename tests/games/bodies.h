// Bodies that games cut, by analytic distances.
#pragma once

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

#include "tests/games/task.h"

namespace cavum::games {

inline Body either(Body a, Body b) {
  return [a = std::move(a), b = std::move(b)](Vec3 p) { return std::min(a(p), b(p)); };
}
inline Body both(Body a, Body b) {
  return [a = std::move(a), b = std::move(b)](Vec3 p) { return std::max(a(p), b(p)); };
}
inline Body without(Body a, Body b) {
  return [a = std::move(a), b = std::move(b)](Vec3 p) { return std::max(a(p), -b(p)); };
}
inline Body moved(Body a, Vec3 by) {
  return [a = std::move(a), by](Vec3 p) { return a(p - by); };
}
/// Where `along`·p is at least `from_mm`.
inline Body beyond(Vec3 along, double from_mm) {
  return [=](Vec3 p) { return from_mm - dot(p, along); };
}
/// A bur's head of this radius, drawn from one place to another.
inline Body stroke(Vec3 a, Vec3 b, double radius) {
  return [=](Vec3 p) {
    const Vec3 ab = b - a;
    const double t = std::clamp(dot(p - a, ab) / std::max(1e-12, dot(ab, ab)), 0.0, 1.0);
    return length(p - a - ab * t) - radius;
  };
}
/// Turned by `deg` about the line through `at` along the unit vector `axis`.
inline Body turned(Body a, Vec3 at, Vec3 axis, double deg) {
  const double c = std::cos(deg * std::numbers::pi / 180),
               s = -std::sin(deg * std::numbers::pi / 180);
  return [=, a = std::move(a)](Vec3 p) {
    const Vec3 q = p - at;
    return a(at + q * c + cross(axis, q) * s + axis * (dot(axis, q) * (1 - c)));
  };
}
/// Without these leaves, which stay whole. `kept(leaf)` says which; a step of half a coarse leaf
/// stands for the distance.
template <class Kept>
Body sparing(Body a, const Octree& tree, Kept kept) {
  return [a = std::move(a), &tree, kept = std::move(kept)](Vec3 p) {
    return std::max(a(p), kept(tree.leaf_at(p)) ? 0.05 : -0.05);
  };
}

/// Directions of a task: out along the approach, and across it towards mesial (u) and buccal (v),
/// where the approach is upright.
struct Frame {
  Vec3 out, u, v;
  explicit Frame(const Task& t) : out(t.zones.approach()) {
    u = normalized(Vec3{1, 0, 0} - out * out.x);
    v = cross(out, u);
  }
};

/// In which order the target is cut: the part of it whose key is small goes first.
struct Order {
  std::string name;
  Body key;
  std::vector<double> ends;  ///< ends[i]: up to which key (i + 1) twentieths of the target are gone
};
/// Layer by layer, wall by wall (from mesial), from the middle outwards.
[[nodiscard]] std::vector<Order> orders(const Task& task);
/// What of the target goes before its `part`-th twentieth (1 to 20).
[[nodiscard]] Body part_of_target(const Task& task, const Order& order, int part);

/// Nearest leaf of a tissue under perforation.faults to the target, and the target's leaf nearest
/// to it. Throws Error without one.
struct WayToFault {
  Vec3 from_mm, to_mm;
};
[[nodiscard]] WayToFault way_to_fault(const Task& task);

}  // namespace cavum::games
