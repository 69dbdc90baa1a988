#include "grading/perforation/exposure.h"

#include <algorithm>
#include <cmath>

#include "engine/tooth/distance_transform.h"
#include "engine/tooth/surface_mesh.h"
#include "grading/measures/lattice.h"
#include "grading/measures/leaf_faces.h"

namespace cavum::grading {
namespace {

constexpr double k_deep_mm = 0.3;   // a scrape along a root is less
constexpr int k_normal_leaves = 2;  // on each side, over which a wall's normal is taken

/// The hard leaves removed so far: which are joined, and whether those reach deep below the tooth's
/// surface.
class Cavity {
 public:
  Cavity(const Octree& before, const std::vector<RemovedAt>& hard,
         const std::array<bool, 256>& around)
      : number_(box_around(hard, 1), -1), deep_(hard.size(), true) {
    if (std::none_of(around.begin(), around.end(), [](bool a) { return a; })) return;
    const int margin = static_cast<int>(std::ceil(k_deep_mm / before.leaf_mm())) + 1;
    const LeafBox box = box_around(hard, margin);
    Lattice<std::uint8_t> outside(box, 0);
    Octree::Cursor cursor;
    for (int z = 0; z < box.size.z; ++z)
      for (int y = 0; y < box.size.y; ++y)
        for (int x = 0; x < box.size.x; ++x) {
          const IVec3 leaf = box.low + IVec3{x, y, z};
          const std::uint8_t t = before.tissue(leaf, cursor);
          outside[leaf] = t == k_air || around[t] ? 1 : 0;
        }
    const Lattice<std::int32_t> nearest(
        box, nearest_seed(box.size, outside.all(), k_deep_mm / before.leaf_mm()));
    for (std::size_t i = 0; i < hard.size(); ++i) deep_[i] = nearest[hard[i].leaf.leaf()] < 0;
  }
  /// Leaves in the order of the list that it was made with.
  void add(IVec3 leaf) {
    const auto at = static_cast<std::int32_t>(joined_.size());
    joined_.push_back(at);
    number_[leaf] = at;
    for (const IVec3 step : scenarios::k_six_neighbours)
      if (const std::int32_t other = number_[leaf + step]; other >= 0) join(at, other);
  }
  [[nodiscard]] bool reaches_deep(IVec3 leaf) {
    return deep_[static_cast<std::size_t>(root(number_[leaf]))];
  }

 private:
  std::int32_t root(std::int32_t i) {
    while (joined_[static_cast<std::size_t>(i)] != i) {
      joined_[static_cast<std::size_t>(i)] =
          joined_[static_cast<std::size_t>(joined_[static_cast<std::size_t>(i)])];
      i = joined_[static_cast<std::size_t>(i)];
    }
    return i;
  }
  void join(std::int32_t a, std::int32_t b) {
    a = root(a);
    b = root(b);
    if (a == b) return;
    joined_[static_cast<std::size_t>(a)] = b;
    deep_[static_cast<std::size_t>(b)] =
        deep_[static_cast<std::size_t>(b)] || deep_[static_cast<std::size_t>(a)];
  }

  Lattice<std::int32_t> number_;
  std::vector<bool> deep_;  // of each leaf, then of what is joined under a root
  std::vector<std::int32_t> joined_;
};

struct Face {
  IVec3 from, to;  ///< the cavity's leaf, the tissue's
  std::int64_t tick = 0;
};

/// Part of a face's leaf² that is the wall's area: |n| along the face's axis, n the mean direction
/// of all faces of that wall around it.
double slant(const Octree& before, const Face& f, std::uint8_t tissue, Octree::Cursor& cursor) {
  IVec3 sum{0, 0, 0};
  for (int z = -k_normal_leaves; z <= k_normal_leaves; ++z)
    for (int y = -k_normal_leaves; y <= k_normal_leaves; ++y)
      for (int x = -k_normal_leaves; x <= k_normal_leaves; ++x) {
        const IVec3 leaf = f.to + IVec3{x, y, z};
        if (before.tissue(leaf, cursor) != tissue) continue;
        for (const IVec3 step : scenarios::k_six_neighbours)
          if (before.tissue(leaf + step, cursor) != tissue) sum = sum + step;
      }
  const IVec3 axis = f.from - f.to;
  const double along = std::abs(sum.x * axis.x + sum.y * axis.y + sum.z * axis.z);
  const double all =
      std::sqrt(static_cast<double>(sum.x) * sum.x + static_cast<double>(sum.y) * sum.y +
                static_cast<double>(sum.z) * sum.z);
  return all > 0.0 ? along / all : 1.0;
}

/// Leaves of a tissue around the tooth that were removed through its faces: joined to one of them
/// over other removed ones.
Lattice<std::uint8_t> through_faces(const std::vector<RemovedAt>& soft,
                                    const std::vector<Face>& faces) {
  Lattice<std::uint8_t> mark(box_around(soft, 1), 0);  // 1 removed, 2 through a face
  for (const auto& r : soft) mark[r.leaf.leaf()] = 1;
  std::vector<IVec3> next;
  const auto take = [&](IVec3 leaf) {
    if (!mark.holds(leaf) || mark[leaf] != 1) return;
    mark[leaf] = 2;
    next.push_back(leaf);
  };
  for (const Face& f : faces) take(f.to);
  while (!next.empty()) {
    const IVec3 leaf = next.back();
    next.pop_back();
    for (const IVec3 step : scenarios::k_six_neighbours) take(leaf + step);
  }
  return mark;
}

}  // namespace

std::array<bool, 256> tissues_around(const Tooth& tooth, const std::array<bool, 256>& of_interest) {
  std::array<bool, 256> around{};
  for (const auto& t : tooth.tissues)
    if (of_interest[t.id]) around[t.id] = lies_around(tooth.octree, t.id);
  return around;
}

std::array<ExposedTissue, 256> measure_exposure(const Tooth& tooth, std::span<const RemovedAt> list,
                                                const RemovedMap& removed, std::int64_t last_tick,
                                                const std::array<bool, 256>& of_interest,
                                                const std::array<bool, 256>* known_around) {
  std::array<ExposedTissue, 256> out;
  const Octree& before = tooth.octree;
  std::vector<RemovedAt> hard;
  std::array<std::vector<RemovedAt>, 256> soft;
  for_each_removed(list, removed, last_tick, [&](const RemovedAt& r) {
    if (before.is_solid(r.leaf.tissue)) hard.push_back(r);
    if (of_interest[r.leaf.tissue]) soft[r.leaf.tissue].push_back(r);
  });
  const std::array<bool, 256> around =
      known_around != nullptr ? *known_around : tissues_around(tooth, of_interest);
  std::array<std::vector<Face>, 256> faces;
  Octree::Cursor cursor;
  if (!hard.empty()) {
    Cavity cavity(before, hard, around);
    for (std::size_t begin = 0; begin < hard.size();) {
      std::size_t end = begin;
      for (; end < hard.size() && hard[end].tick == hard[begin].tick; ++end)
        cavity.add(hard[end].leaf.leaf());
      for (; begin < end; ++begin)
        for (const IVec3 step : scenarios::k_six_neighbours) {
          const Face f{hard[begin].leaf.leaf(), hard[begin].leaf.leaf() + step, hard[begin].tick};
          const std::uint8_t tissue = before.tissue(f.to, cursor);
          if (!of_interest[tissue]) continue;
          const std::int64_t gone = removed.tick(f.to);
          if (around[tissue] && ((gone >= 0 && gone < f.tick) || !cavity.reaches_deep(f.from)))
            continue;
          faces[tissue].push_back(f);
        }
    }
  }
  const double leaf = before.leaf_mm();
  for (const auto& t : tooth.tissues) {
    ExposedTissue& e = out[t.id];
    const auto opened = [&](std::int64_t tick, Vec3 place) {
      if (e.first.tick < 0 || tick < e.first.tick) e.first = {tick, place};
      e.ticks.push_back(tick);
    };
    for (const Face& f : faces[t.id]) {
      e.area_mm2 += leaf * leaf * slant(before, f, t.id, cursor);
      opened(f.tick, (before.centre_mm(f.from) + before.centre_mm(f.to)) * 0.5);
    }
    e.area_bound_mm2 = 0.5 * leaf * leaf * k_stairs * static_cast<double>(rim_edges(faces[t.id]));
    if (soft[t.id].empty()) continue;
    Lattice<std::uint8_t> through = through_faces(soft[t.id], faces[t.id]);
    for (const auto& r : soft[t.id]) {
      if (!around[t.id] || through[r.leaf.leaf()] == 2) {
        e.inside_mm3 += before.leaf_volume_mm3();
        opened(r.tick, before.centre_mm(r.leaf.leaf()));
      } else {
        e.outside_mm3 += before.leaf_volume_mm3();
        if (e.first_outside.tick < 0) e.first_outside = {r.tick, before.centre_mm(r.leaf.leaf())};
      }
    }
    std::sort(e.ticks.begin(), e.ticks.end());
  }
  return out;
}

}  // namespace cavum::grading
