#include "engine/tooth/surface_patches.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>

#include "engine/tooth/cube_cases.h"

namespace cavum {
namespace {

// A patch looks at a window of leaves: the points of its cells, and around them what their normals
// need.
constexpr int k_points = SurfacePatches::k_edge + 1, k_margin = 3,
              k_window = k_points + 2 * k_margin;
constexpr std::size_t k_window_leaves = static_cast<std::size_t>(k_window) * k_window * k_window;
constexpr std::size_t k_point_count = static_cast<std::size_t>(k_points) * k_points * k_points;
constexpr std::uint16_t k_no_corner = 0xffff;
constexpr std::array<int, 3> k_step{1, k_window, k_window* k_window};
/// Half of what `blur` counts when all is of the tissue: 27 leaves, 27 times.
constexpr double k_half = 0.5 * 729;

/// Lowest leaf of the points of a patch: the first has a layer of air below the tooth.
constexpr int first_point(int patch) { return patch * SurfacePatches::k_edge - 1; }
constexpr int patches_along(int leaves) { return leaves / SurfacePatches::k_edge + 1; }

}  // namespace

/// Makes one patch at a time.
struct SurfacePatches::Maker {
  std::array<std::uint8_t, k_window_leaves> tissue;
  std::array<std::int8_t, k_window_leaves> code;
  std::array<std::int16_t, k_window_leaves> share,
      between;  // of the tissue in the leaves around, in 729ths
  std::array<std::array<std::uint16_t, k_point_count>, 3> vertex_of;
  std::array<std::array<std::uint32_t, k_points>, k_points> inside;  // [z][y], a bit for each x
  SurfacePatch made;
  double leaf_mm = 0.0;
  Vec3 origin_mm;  // of the tooth
  IVec3 first;     // leaf of the first point
  bool hard = true;
  std::uint8_t wanted = k_air;

  static int window_place(int x, int y, int z) {
    return (x + k_margin) + k_window * ((y + k_margin) + k_window * (z + k_margin));
  }
  [[nodiscard]] bool is_inside(int place) const {
    const auto i = static_cast<std::size_t>(place);
    return hard ? code[i] < 0 : tissue[i] == wanted;
  }

  /// Sums over three leaves along one axis.
  void blur_along(int step, const std::array<std::int16_t, k_window_leaves>& from,
                  std::array<std::int16_t, k_window_leaves>& to) const {
    to = from;
    for (int i = step; i < static_cast<int>(k_window_leaves) - step; ++i)
      to[static_cast<std::size_t>(i)] = static_cast<std::int16_t>(
          from[static_cast<std::size_t>(i - step)] + from[static_cast<std::size_t>(i)] +
          from[static_cast<std::size_t>(i + step)]);
  }

  /// How much of the leaves around belongs to the tissue; wrong in the window's outermost two
  /// layers, which nobody asks for.
  void blur() {
    for (std::size_t i = 0; i < k_window_leaves; ++i) share[i] = tissue[i] == wanted;
    for (int twice = 0; twice < 2; ++twice) {
      blur_along(k_step[0], share, between);
      blur_along(k_step[1], between, share);
      blur_along(k_step[2], share, between);
      std::swap(share, between);
    }
  }

  [[nodiscard]] Vec3 code_slope(int place) const {
    const auto along = [&](int step) {
      return double(code[static_cast<std::size_t>(place + step)] -
                    code[static_cast<std::size_t>(place - step)]);
    };
    return {along(k_step[0]), along(k_step[1]), along(k_step[2])};
  }
  /// Outwards, as codes rise.
  [[nodiscard]] Vec3 share_slope(int place) const {
    const auto along = [&](int step) {
      return double(share[static_cast<std::size_t>(place - step)] -
                    share[static_cast<std::size_t>(place + step)]);
    };
    return {along(k_step[0]), along(k_step[1]), along(k_step[2])};
  }

  std::uint16_t vertex(const CubeEdge& edge, int x, int y, int z) {
    const int px = x + (edge.low_corner & 1), py = y + (edge.low_corner >> 1 & 1),
              pz = z + (edge.low_corner >> 2);
    auto& known =
        vertex_of[edge.axis][static_cast<std::size_t>(px + k_points * (py + k_points * pz))];
    if (known != k_no_corner) return known;
    known = static_cast<std::uint16_t>(made.vertices.size());

    const int low = window_place(px, py, pz), high = low + k_step[edge.axis];
    const auto l = static_cast<std::size_t>(low), h = static_cast<std::size_t>(high);
    const bool low_inside = is_inside(low);
    double place = 0.5;  // of the vertex, 0 = low, 1 = high
    Vec3 outwards;
    if ((code[l] < 0) != (code[h] < 0)) {  // the hard tissue's surface runs between them
      // a code of 0 lies outside, by less than a code
      const double of_low = code[l] == 0 ? 1.0 : code[l], of_high = code[h] == 0 ? 1.0 : code[h];
      place = of_low / (of_low - of_high);
      outwards = code_slope(low) * (1.0 - place) + code_slope(high) * place;
      if ((code[l] < 0) != low_inside)
        outwards = -outwards;  // of a void tissue, which lies on the other side
    } else {
      const double of_low = share[l] - k_half, of_high = share[h] - k_half;
      if ((of_low > 0) == low_inside && (of_high > 0) != low_inside)
        place = std::clamp(of_low / (of_low - of_high), 0.05, 0.95);
      outwards = share_slope(low) * (1.0 - place) + share_slope(high) * place;
    }
    Vec3 at{first.x + px + 0.5, first.y + py + 0.5,
            first.z + pz + 0.5};  // in leaves of the tooth: the same in every patch
    Vec3 along{};
    (edge.axis == 0 ? along.x : edge.axis == 1 ? along.y : along.z) = 1.0;
    at += along * place;
    if (!(dot(outwards, outwards) > 0)) outwards = low_inside ? along : -along;  // a leaf alone
    const Vec3 mm = origin_mm + at * leaf_mm, normal = normalized(outwards) * 32767.0;
    const std::size_t in = low_inside ? l : h, out = low_inside ? h : l;
    made.vertices.push_back(
        {{static_cast<float>(mm.x), static_cast<float>(mm.y), static_cast<float>(mm.z)},
         {static_cast<std::int16_t>(std::lround(normal.x)),
          static_cast<std::int16_t>(std::lround(normal.y)),
          static_cast<std::int16_t>(std::lround(normal.z))},
         tissue[in],
         tissue[out]});
    return known;
  }

  void make(const LeafBlocks& leaves, IVec3 patch) {
    made.vertices.clear();
    made.triangles.clear();
    first = {first_point(patch.x), first_point(patch.y), first_point(patch.z)};
    leaves.copy_cube(first - IVec3{k_margin, k_margin, k_margin}, k_window, tissue.data(),
                     code.data());
    std::uint32_t any = 0, all = ~0u;
    for (int z = 0; z < k_points; ++z)
      for (int y = 0; y < k_points; ++y) {
        std::uint32_t row = 0;
        const int place = window_place(0, y, z);
        for (int x = 0; x < k_points; ++x)
          row |= static_cast<std::uint32_t>(is_inside(place + x)) << x;
        inside[static_cast<std::size_t>(z)][static_cast<std::size_t>(y)] = row;
        any |= row;
        all &= row;
      }
    constexpr std::uint32_t k_full = (1u << k_points) - 1;
    if (any == 0 || all == k_full) return;
    if (!hard) blur();
    leaf_mm = leaves.leaf_mm();
    origin_mm = leaves.origin_mm();
    for (auto& axis : vertex_of) axis.fill(k_no_corner);
    for (int z = 0; z < k_edge; ++z)
      for (int y = 0; y < k_edge; ++y) go_along(y, z);
  }

  /// The cells of one row.
  void go_along(int y, int z) {
    const auto& lower = inside[static_cast<std::size_t>(z)];
    const auto& upper = inside[static_cast<std::size_t>(z + 1)];
    const std::array<std::uint32_t, 4> row{
        lower[static_cast<std::size_t>(y)], lower[static_cast<std::size_t>(y + 1)],
        upper[static_cast<std::size_t>(y)], upper[static_cast<std::size_t>(y + 1)]};
    const std::uint32_t any = row[0] | row[1] | row[2] | row[3],
                        all = row[0] & row[1] & row[2] & row[3];
    const auto& cases = cube_cases();
    for (std::uint32_t cells = (any | any >> 1) & ~(all & all >> 1) & ((1u << k_edge) - 1);
         cells != 0; cells &= cells - 1) {
      const int x = std::countr_zero(cells);
      const std::size_t corners = (row[0] >> x & 3) | (row[1] >> x & 3) << 2 |
                                  (row[2] >> x & 3) << 4 | (row[3] >> x & 3) << 6;
      const CubeCase& found = cases[corners];
      for (int t = 0; t < found.triangles; ++t) {
        std::array<std::uint16_t, 3> triangle;
        for (std::size_t i = 0; i < 3; ++i)
          triangle[i] =
              vertex(k_cube_edges[found.edge[static_cast<std::size_t>(3 * t) + i]], x, y, z);
        made.triangles.push_back(triangle);
      }
    }
  }
};

namespace {

/// A cut passes through a patch and leaves less behind than there was meanwhile: that room is given
/// back.
template <class Item>
void keep(const std::vector<Item>& made, std::vector<Item>& kept) {
  if (made.size() * 2 < kept.capacity()) std::vector<Item>().swap(kept);
  kept.assign(made.begin(), made.end());
}

}  // namespace

SurfacePatches::SurfacePatches(const LeafBlocks& leaves, std::uint8_t tissue)
    : size_{patches_along(leaves.size().x), patches_along(leaves.size().y),
            patches_along(leaves.size().z)},
      maker_(std::make_unique<Maker>()),
      patches_(cells_of(size_)),
      reached_(patches_.size(), 0) {
  maker_->hard = tissue == k_hard_tissue;
  maker_->wanted = tissue;
  const LeafBounds whole{{0, 0, 0}, leaves.size()};
  std::vector<std::uint32_t> touched;
  update(leaves, std::span(&whole, 1), touched);
}
SurfacePatches::~SurfacePatches() = default;
SurfacePatches::SurfacePatches(SurfacePatches&&) noexcept = default;
SurfacePatches& SurfacePatches::operator=(SurfacePatches&&) noexcept = default;

void SurfacePatches::update(const LeafBlocks& leaves, std::span<const LeafBounds> changed,
                            std::vector<std::uint32_t>& touched) {
  const int reach = maker_->hard ? 1 : k_margin;  // of a patch beyond its points
  const auto from = [&](int leaf) { return std::max(0, (leaf - reach) / k_edge); };
  const auto to = [&](int leaf, int count) {
    return std::min(count - 1, (leaf + 1 + reach) / k_edge);
  };
  for (const LeafBounds& box : changed)
    for (int z = from(box.low.z); z <= to(box.high.z, size_.z); ++z)
      for (int y = from(box.low.y); y <= to(box.high.y, size_.y); ++y)
        for (int x = from(box.low.x); x <= to(box.high.x, size_.x); ++x)
          reached_[static_cast<std::size_t>((z * size_.y + y) * size_.x + x)] = 1;
  std::size_t number = 0;
  for (int z = 0; z < size_.z; ++z)
    for (int y = 0; y < size_.y; ++y)
      for (int x = 0; x < size_.x; ++x, ++number) {
        if (reached_[number] == 0) continue;
        reached_[number] = 0;
        maker_->make(leaves, {x, y, z});
        if (maker_->made == patches_[number]) continue;
        keep(maker_->made.vertices, patches_[number].vertices);
        keep(maker_->made.triangles, patches_[number].triangles);
        touched.push_back(static_cast<std::uint32_t>(number));
      }
}

std::size_t SurfacePatches::triangle_count() const noexcept {
  std::size_t n = 0;
  for (const auto& p : patches_) n += p.triangles.size();
  return n;
}

}  // namespace cavum
