#include "engine/lab/scan/cut_by_scan.h"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>

#include "engine/base/error.h"
#include "engine/tooth/distance.h"
#include "engine/tooth/octree_edit.h"

namespace cavum {
namespace {

constexpr float k_far_off = 1e9f;
constexpr std::int32_t k_leaf_margin = 3;  // leaves around the octree's own

constexpr IVec3 k_beside[] = {{1, 0, 0}, {-1, 0, 0}, {0, 1, 0}, {0, -1, 0}, {0, 0, 1}, {0, 0, -1}};

/// The octree's leaves and a margin, as a lattice; leaves are numbered as in the octree.
struct LeafLattice {
  IVec3 low, size;
  double leaf_mm;
  Vec3 first_mm;  // centre of the lowest

  explicit LeafLattice(const Octree& octree)
      : low{-k_leaf_margin, -k_leaf_margin, -k_leaf_margin},
        size(octree.size() + IVec3{2 * k_leaf_margin, 2 * k_leaf_margin, 2 * k_leaf_margin}),
        leaf_mm(octree.leaf_mm()),
        first_mm(octree.centre_mm(low)) {}
  [[nodiscard]] std::size_t count() const { return cells_of(size); }
  [[nodiscard]] bool holds(IVec3 leaf) const { return lies_in(leaf - low, size); }
  [[nodiscard]] std::size_t index(IVec3 leaf) const { return cell_index(leaf - low, size); }
  [[nodiscard]] IVec3 leaf(std::size_t i) const {
    const auto nx = static_cast<std::size_t>(size.x), ny = static_cast<std::size_t>(size.y);
    return low + IVec3{static_cast<std::int32_t>(i % nx), static_cast<std::int32_t>(i / nx % ny),
                       static_cast<std::int32_t>(i / (nx * ny))};
  }
  [[nodiscard]] Vec3 centre_mm(std::size_t i) const {
    const IVec3 l = leaf(i) - low;
    return first_mm + to_vec3(l) * leaf_mm;
  }
  /// Calls `visit(index, centre)` for leaves about as near to a triangle as `reach_mm`, for some
  /// more than once: a large one in parts, whose boxes hold less beside it.
  template <class Visit>
  void around(Vec3 a, Vec3 b, Vec3 c, double reach_mm, const Visit& visit) const {
    constexpr double k_part_mm = 0.4;
    const double longest = std::max({length(b - a), length(c - b), length(a - c)});
    const int n = static_cast<int>(std::clamp(std::ceil(longest / k_part_mm), 1.0, 1000.0));
    const auto at = [&](int i, int j) {
      return a + (b - a) * (double(i) / n) + (c - a) * (double(j) / n);
    };
    for (int i = 0; i < n; ++i)
      for (int j = 0; i + j < n; ++j) {
        in_box(at(i, j), at(i + 1, j), at(i, j + 1), reach_mm, visit);
        if (i + j + 1 < n) in_box(at(i + 1, j), at(i + 1, j + 1), at(i, j + 1), reach_mm, visit);
      }
  }

 private:
  template <class Visit>
  void in_box(Vec3 a, Vec3 b, Vec3 c, double reach_mm, const Visit& visit) const {
    const auto from = [&](double v, double first) {
      return static_cast<int>(std::ceil(std::clamp((v - reach_mm - first) / leaf_mm, -1e6, 1e6)));
    };
    const auto to = [&](double v, double first) {
      return static_cast<int>(std::floor(std::clamp((v + reach_mm - first) / leaf_mm, -1e6, 1e6)));
    };
    const IVec3 l{std::max(0, from(std::min({a.x, b.x, c.x}), first_mm.x)),
                  std::max(0, from(std::min({a.y, b.y, c.y}), first_mm.y)),
                  std::max(0, from(std::min({a.z, b.z, c.z}), first_mm.z))};
    const IVec3 h{std::min(size.x - 1, to(std::max({a.x, b.x, c.x}), first_mm.x)),
                  std::min(size.y - 1, to(std::max({a.y, b.y, c.y}), first_mm.y)),
                  std::min(size.z - 1, to(std::max({a.z, b.z, c.z}), first_mm.z))};
    for (int z = l.z; z <= h.z; ++z)
      for (int y = l.y; y <= h.y; ++y) {
        std::size_t i = index(low + IVec3{l.x, y, z});
        for (int x = l.x; x <= h.x; ++x, ++i)
          visit(i, first_mm + Vec3{double(x), double(y), double(z)} * leaf_mm);
      }
  }
};

/// Share of each corner in a point of a triangle.
Vec3 shares_at(Vec3 q, Vec3 a, Vec3 b, Vec3 c) {
  const Vec3 across = cross(b - a, c - a);
  const double all = dot(across, across);
  if (!(all > 0)) return {1, 0, 0};
  const double in_b = dot(cross(q - a, c - a), across) / all,
               in_c = dot(cross(b - a, q - a), across) / all;
  return {1 - in_b - in_c, in_b, in_c};
}

/// Signed distances of leaves from the scan, mm, positive outside; k_far_off beyond the band. Exact
/// to the triangles; the side is told by the normal that its corners' have in between (Bærentzen
/// and Aanæs, IEEE TVCG 11 (2005) 243, weighted by area).
std::vector<float> distances_of(const TriangleMesh& scan, const LeafLattice& lattice) {
  std::vector<float> mm(lattice.count(), k_far_off);
  const double band = k_distance_band_leaves * lattice.leaf_mm;
  const std::vector<Vec3> normals = corner_normals(scan);
  for (const auto& t : scan.triangles) {
    const Vec3 a = scan.vertices_mm[t[0]], b = scan.vertices_mm[t[1]], c = scan.vertices_mm[t[2]];
    const Vec3 across = cross(b - a, c - a);
    const double twice = length(across);
    if (!(twice > 1e-12)) continue;
    const Vec3 plane = across / twice;
    lattice.around(a, b, c, band, [&](std::size_t i, Vec3 p) {
      const double best = std::min(std::fabs(static_cast<double>(mm[i])), band);
      if (std::fabs(dot(p - a, plane)) >= best) return;
      const Vec3 q = closest_on_triangle(p, a, b, c);
      const double d = length(p - q);
      if (d >= best) return;
      const Vec3 in = shares_at(q, a, b, c);
      const double side =
          dot(p - q, normals[t[0]] * in.x + normals[t[1]] * in.y + normals[t[2]] * in.z);
      mm[i] = static_cast<float>(side < 0 ? -d : d);
    });
  }
  return mm;
}

/// Leaves that a way leads to from outside, not through the scan nor its caps.
class Outside {
 public:
  Outside(const LeafLattice& lattice, const std::vector<float>& mm)
      : lattice_(lattice), mm_(mm), state_(lattice.count(), k_inside) {}

  void put_caps(const TriangleMesh& caps) {
    const double thick = lattice_.leaf_mm;
    for (const auto& t : caps.triangles) {
      const Vec3 a = caps.vertices_mm[t[0]], b = caps.vertices_mm[t[1]], c = caps.vertices_mm[t[2]];
      lattice_.around(a, b, c, thick, [&](std::size_t i, Vec3 p) {
        if (length(p - closest_on_triangle(p, a, b, c)) <= thick) state_[i] = k_cap;
      });
    }
  }
  /// A leaf and what is nearer to the surface is a shell that no way leads through, whichever side
  /// noise says that a leaf of it lies on; the shell's outer side is then added from outside, and
  /// leads nowhere.
  std::vector<std::uint8_t> reached() {
    const IVec3 high = lattice_.low + lattice_.size - IVec3{1, 1, 1};
    for (int z = lattice_.low.z; z <= high.z; ++z)
      for (int y = lattice_.low.y; y <= high.y; ++y)
        for (int x = lattice_.low.x; x <= high.x; ++x)
          if (x == lattice_.low.x || y == lattice_.low.y || z == lattice_.low.z || x == high.x ||
              y == high.y || z == high.z)
            visit({x, y, z});
    while (!open_.empty()) {
      const IVec3 leaf = lattice_.leaf(open_.back());
      open_.pop_back();
      spread(leaf);
    }
    while (!shell_.empty()) {
      const IVec3 leaf = lattice_.leaf(shell_.back());
      shell_.pop_back();
      spread(leaf);
    }
    for (auto& s : state_) s = s == k_reached ? 1 : 0;
    return std::move(state_);
  }

 private:
  enum State : std::uint8_t { k_inside, k_reached, k_cap };

  void visit(IVec3 leaf) {
    const std::size_t i = lattice_.index(leaf);
    if (state_[i] != k_inside || mm_[i] <= 0) return;
    const bool in_shell = mm_[i] < lattice_.leaf_mm;
    if (!in_shell && open_done_) return;
    state_[i] = k_reached;
    (in_shell ? shell_ : open_).push_back(i);
  }
  void spread(IVec3 leaf) {
    open_done_ = open_.empty() && mm_[lattice_.index(leaf)] < lattice_.leaf_mm;
    for (const IVec3 step : k_beside)
      if (lattice_.holds(leaf + step)) visit(leaf + step);
  }

  const LeafLattice& lattice_;
  const std::vector<float>& mm_;
  std::vector<std::uint8_t> state_;
  std::vector<std::size_t> open_, shell_;
  bool open_done_ = false;
};

/// A connected piece of the tooth outside the scan.
struct Piece {
  std::vector<std::size_t> leaves;
  double thickest_mm = 0.0;
  int lowest = 0;  // leaf
  std::int64_t up = 0,
               bounding =
                   0;  // faces towards what was left: sum of their directions along z, and how many
};

class Pieces {
 public:
  Pieces(const LeafLattice& lattice, const std::vector<float>& mm,
         const std::vector<std::uint8_t>& outside, const OuterSurface& tooth, double noise_mm)
      : lattice_(lattice),
        mm_(mm),
        outside_(outside),
        tooth_(tooth),
        noise_mm_(noise_mm),
        seen_(lattice.count(), 0) {}

  /// How much deeper the scan lies there than the tooth's surface did, mm.
  [[nodiscard]] double thickness_mm(std::size_t i) const {
    return static_cast<double>(mm_[i]) - tooth_.at_leaf_mm(lattice_.leaf(i));
  }
  [[nodiscard]] bool is_tooth(std::size_t i) const {
    return !tooth_.outside()[tooth_.tooth().octree.tissue(lattice_.leaf(i))];
  }

  /// How much deeper at most, mm; to some hundredths of a millimetre where that is more than the
  /// octree's distances reach.
  [[nodiscard]] double depth_mm(const Piece& piece) const {
    double deepest = 0.0;
    Octree::Cursor cursor;
    for (const std::size_t i : piece.leaves)
      if (mm_[i] < k_far_off)
        deepest = std::max(deepest, static_cast<double>(mm_[i]) -
                                        tooth_.distance(lattice_.centre_mm(i), cursor).mm);
    return deepest;
  }

  std::vector<Piece> all() {
    std::vector<Piece> pieces;
    for (std::size_t i = 0; i < seen_.size(); ++i)
      if (seen_[i] == 0 && gone(i)) pieces.push_back(from(i));
    return pieces;
  }

 private:
  [[nodiscard]] bool gone(std::size_t i) const {
    return outside_[i] != 0 && is_tooth(i) && thickness_mm(i) > noise_mm_;
  }

  Piece from(std::size_t first) {
    Piece piece;
    piece.lowest = lattice_.leaf(first).z;
    seen_[first] = 1;
    piece.leaves.push_back(first);
    for (std::size_t next = 0; next < piece.leaves.size(); ++next) {
      const std::size_t i = piece.leaves[next];
      const IVec3 leaf = lattice_.leaf(i);
      piece.lowest = std::min(piece.lowest, leaf.z);
      piece.thickest_mm = std::max(piece.thickest_mm, thickness_mm(i));
      for (const IVec3 step : k_beside) {
        if (!lattice_.holds(leaf + step)) continue;
        const std::size_t j = lattice_.index(leaf + step);
        if (outside_[j] == 0 && is_tooth(j)) {
          piece.up -= step.z;
          ++piece.bounding;
        }
        if (seen_[j] != 0 || !gone(j)) continue;
        seen_[j] = 1;
        piece.leaves.push_back(j);
      }
    }
    return piece;
  }

  const LeafLattice& lattice_;
  const std::vector<float>& mm_;
  const std::vector<std::uint8_t>& outside_;
  const OuterSurface& tooth_;
  double noise_mm_;
  std::vector<std::uint8_t> seen_;
};

/// Of a leaf: nothing changes; its distance does, and it goes, or stays, or was air.
enum Mark : std::uint8_t { k_as_it_was, k_goes, k_stays, k_was_air };

/// What the octree is carved by: the scan's distances around the leaves that go.
struct CarveByScan {
  const LeafLattice& lattice;
  const std::vector<float>& mm;
  const std::vector<std::uint8_t>& mark;  // Mark
  /// At a leaf's centre the distance from what was removed; elsewhere 0, so that nothing is passed
  /// over.
  double operator()(Vec3 p) const noexcept {
    const Vec3 q = (p - lattice.first_mm) / lattice.leaf_mm;
    const IVec3 at{static_cast<std::int32_t>(q.x + 0.5), static_cast<std::int32_t>(q.y + 0.5),
                   static_cast<std::int32_t>(q.z + 0.5)};
    constexpr double k_off = 0.01;
    if (std::fabs(q.x - at.x) > k_off || std::fabs(q.y - at.y) > k_off ||
        std::fabs(q.z - at.z) > k_off)
      return 0.0;
    const IVec3 leaf = lattice.low + at;
    if (!lattice.holds(leaf)) return 0.0;
    const std::size_t i = lattice.index(leaf);
    constexpr double k_min_mm = 1e-6;
    const double d = -static_cast<double>(mm[i]);
    if (mark[i] == k_as_it_was) return static_cast<double>(k_far_off);
    return mark[i] == k_goes    ? std::min(d, -k_min_mm)
           : mark[i] == k_stays ? std::max(d, k_min_mm)
                                : d;
  }
};

/// Marks for CarveByScan: what goes, and around it what lies deeper than it did.
std::vector<std::uint8_t> marks_of(const std::vector<Piece>& removed, const LeafLattice& lattice,
                                   const Pieces& pieces, const Octree& octree, double noise_mm) {
  constexpr int k_around = 3;
  std::vector<std::uint8_t> mark(lattice.count(), 0);
  for (const Piece& piece : removed)
    for (const std::size_t i : piece.leaves) mark[i] = k_goes;
  for (const Piece& piece : removed)
    for (const std::size_t i : piece.leaves) {
      const IVec3 leaf = lattice.leaf(i);
      if (std::all_of(std::begin(k_beside), std::end(k_beside), [&](IVec3 step) {
            return lattice.holds(leaf + step) && mark[lattice.index(leaf + step)] == k_goes;
          }))
        continue;
      for (int z = -k_around; z <= k_around; ++z)
        for (int y = -k_around; y <= k_around; ++y)
          for (int x = -k_around; x <= k_around; ++x) {
            const IVec3 near = leaf + IVec3{x, y, z};
            if (!lattice.holds(near)) continue;
            const std::size_t j = lattice.index(near);
            if (mark[j] == k_as_it_was && pieces.thickness_mm(j) > noise_mm)
              mark[j] = octree.tissue(near) == k_air ? k_was_air : k_stays;
          }
    }
  return mark;
}

}  // namespace

ScanCut cut_by_scan(const TriangleMesh& scan, const TriangleMesh& caps, const OuterSurface& tooth,
                    double noise_mm, const std::string& where, ThinApart thin) {
  constexpr double k_thick_mm = 0.1, k_small_mm3 = 0.02, k_from_above = -0.5, k_below_mm = 0.3,
                   k_thin_mm = 0.3;
  constexpr double k_broad_mm3 = 0.05,
                   k_broad_noises = 2.0;  // noise is thin, or small, but not this
  const Octree& before = tooth.tooth().octree;
  const LeafLattice lattice(before);
  std::vector<float> mm = distances_of(scan, lattice);
  Outside ways(lattice, mm);
  ways.put_caps(caps);
  const std::vector<std::uint8_t> outside = ways.reached();
  for (std::size_t i = 0; i < mm.size(); ++i)
    if (outside[i] == 0 && mm[i] == k_far_off) mm[i] = -k_far_off;
  Pieces pieces(lattice, mm, outside, tooth, noise_mm);
  double lowest_mm = 1e9;
  for (const Vec3 v : scan.vertices_mm) lowest_mm = std::min(lowest_mm, v.z);

  ScanCut cut{before, {}, 0, 0.0, 0.0, 0, {}};
  std::vector<Piece> removed;
  for (Piece& piece : pieces.all()) {
    const double mm3 = static_cast<double>(piece.leaves.size()) * before.leaf_volume_mm3();
    const bool broad = mm3 >= k_broad_mm3 && piece.thickest_mm >= k_broad_noises * noise_mm;
    if ((piece.thickest_mm < k_thick_mm && !broad) || mm3 < k_small_mm3) {
      cut.left_as_noise_mm3 += mm3;
      ++cut.left_as_noise;
    } else if (piece.bounding == 0 ||
               static_cast<double>(piece.up) < k_from_above * static_cast<double>(piece.bounding)) {
      cut.unseen_mm3 += mm3;
    } else {
      if (before.centre_mm({0, 0, piece.lowest}).z < lowest_mm - k_below_mm)
        throw Error(
            where,
            msg("what was removed runs below the end of the scan, or the scan has no inside: what lies there is not seen"),
            msg("scan the tooth down to below the cavity, and close holes in the mesh"));
      removed.push_back(std::move(piece));
    }
  }
  // A groove that one mesh has and the other has not: its bottom lies deeper, apart from everything
  // that was drilled.
  const auto largest = std::max_element(
      removed.begin(), removed.end(),
      [](const Piece& a, const Piece& b) { return a.leaves.size() < b.leaves.size(); });
  for (auto& piece : removed) {
    if (&piece == &*largest || thin == ThinApart::goes) continue;
    const double deep_mm = pieces.depth_mm(piece);
    if (deep_mm >= k_thin_mm) continue;
    cut.apart.push_back({lattice.centre_mm(piece.leaves[0]), deep_mm,
                         static_cast<double>(piece.leaves.size()) * before.leaf_volume_mm3()});
    piece.leaves.clear();
  }
  std::erase_if(removed, [](const Piece& piece) { return piece.leaves.empty(); });
  cut.cavities = static_cast<int>(removed.size());
  if (removed.empty()) return cut;

  const std::vector<std::uint8_t> mark = marks_of(removed, lattice, pieces, before, noise_mm);
  LeafBounds box;
  std::size_t leaves = 0;
  for (const Piece& piece : removed) {
    leaves += piece.leaves.size();
    for (const std::size_t i : piece.leaves) box.add(lattice.leaf(i));
  }
  const IVec3 wide{4, 4, 4},
      span = box.high - box.low + wide + wide +
             IVec3{2 * Octree::k_brick_edge, 2 * Octree::k_brick_edge, 2 * Octree::k_brick_edge};
  const auto bricks = static_cast<std::size_t>(span.x / Octree::k_brick_edge + 1) *
                      static_cast<std::size_t>(span.y / Octree::k_brick_edge + 1) *
                      static_cast<std::size_t>(span.z / Octree::k_brick_edge + 1);
  cut.after.reserve_edits(bricks + 4096);
  cut.removed.reserve(leaves + Octree::k_brick_leaves);
  if (!cut.after.carve(before.centre_mm(box.low - wide), before.centre_mm(box.high + wide),
                       CarveByScan{lattice, mm, mark}, cut.removed))
    throw Error(where, msg("what was removed needs more room than was reserved"),
                msg("report it with the scan"));
  return cut;
}

}  // namespace cavum
