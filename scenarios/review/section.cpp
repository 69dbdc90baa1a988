#include "scenarios/review/section.h"

#include <algorithm>

#include "engine/tooth/octree_edit.h"

namespace cavum::scenarios {
namespace {

int top_of(const Octree& tree, int x, int y) {
  for (int z = tree.size().z - 1; z >= 0; --z) {
    const auto t = tree.tissue({x, y, z});
    if (t != k_air && t != k_periodontium) return z;
  }
  return -1;
}

}  // namespace

Section::Section(const Octree& tooth, const Octree* cut, const ZoneMap& map, View view,
                 double at_mm)
    : before(tooth), after(cut), zones(map), view_(view), high_(tooth.size()) {
  const IVec3 probe = before.leaf_at({at_mm, at_mm, at_mm});
  depth_ = view_ == View::mesio_distal ? probe.y : view_ == View::bucco_lingual ? probe.x : probe.z;
  frame_target();
  if (upright() && after != nullptr) follow_deeper_cut();
  if (from_above()) find_tops();
}

/// The crown and what lies around the target; the tips of the roots are not needed.
void Section::frame_target() {
  constexpr double k_below_target_mm = 4.0, k_over_target_mm = 0.8,
                   k_above_mm = 0.4;  // the last over the crown's highest place
  low_.z = std::max(0, before.leaf_at(zones.target_low_mm() - Vec3{0, 0, k_below_target_mm}).z);
  int crown = 0;
  before.for_each_cube(
      [&](IVec3 at, int edge, std::uint8_t) { crown = std::max(crown, at.z + edge); });
  const int over_target =
      before.leaf_at(zones.target_high_mm() + Vec3{0, 0, k_over_target_mm}).z + 1;
  high_.z = std::min(
      high_.z, std::max(over_target, crown + static_cast<int>(k_above_mm / before.leaf_mm())));
}

/// Nor is a channel cut off that was drilled deeper.
void Section::follow_deeper_cut() {
  constexpr double k_room_mm = 0.6;  // below it
  const int room = static_cast<int>(k_room_mm / before.leaf_mm()), below_target = low_.z;
  for (int z = 0; z < below_target + room; ++z) {
    if (!cut_in_row(z - below_target)) continue;
    low_.z = std::clamp(z - room, 0, below_target);
    return;
  }
}

bool Section::cut_in_row(int row) const noexcept {
  for (int column = 0; column < width(); ++column) {
    const IVec3 at = leaf(column, row);
    if (before.tissue(at) != k_air && after->tissue(at) == k_air) return true;
  }
  return false;
}

void Section::find_tops() {
  for (int row = 0; row < height(); ++row)
    for (int column = 0; column < width(); ++column) {
      top_.push_back(top_of(before, column, row));
      top_after_.push_back(after != nullptr ? top_of(*after, column, row) : top_.back());
    }
}

IVec3 Section::leaf(int column, int row) const noexcept {
  switch (view_) {
    case View::mesio_distal:
      return {low_.x + column, depth_, low_.z + row};
    case View::bucco_lingual:
      return {depth_, low_.y + column, low_.z + row};
    case View::occlusal:
      return {low_.x + column, low_.y + row, std::max(top(column, row), 0)};
    case View::horizontal:
      break;
  }
  return {low_.x + column, low_.y + row, depth_};
}

bool Section::adjacent_tooth(int column, int row) const noexcept {
  if (from_above()) return top(column, row) < 0;
  const auto t = before.tissue(leaf(column, row));
  return t == k_air || t == k_periodontium;
}

bool Section::air(int column, int row) const noexcept {
  return from_above() ? top(column, row) < 0 : before.tissue(leaf(column, row)) == k_air;
}

}  // namespace cavum::scenarios
