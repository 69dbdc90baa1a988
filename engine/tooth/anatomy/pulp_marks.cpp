#include "engine/tooth/anatomy/pulp_marks.h"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>

#include "engine/base/det_math.h"
#include "engine/tooth/anatomy/height_map.h"
#include "engine/tooth/octree_edit.h"

namespace cavum {
namespace {

constexpr double k_cell = HeightMap::k_cell_mm;
constexpr double k_horn_mm = 0.3;  // least height of a horn above the saddle to the next
constexpr double k_horn_scale_mm = 0.1;
constexpr double k_branch_mm2 = 0.05;  // what counts as a canal of its own: 0.25 mm wide
constexpr double k_split_mm = 0.3;     // a split lasts this deep, or it is a ripple
constexpr double k_mouth_mm2 = 0.02;
constexpr double k_chamber =
    0.8;  // of the widest slice's area: such slices tell the chamber's middle
constexpr double k_wider =
    1.4;  // than the narrowest slice of canals: what is more is a rest of the floor
constexpr double k_mouths_mm = 0.8;  // below the floor, in which all canals have parted
constexpr double k_min_pulp_mm3 = 0.5;
constexpr double k_apex_mm = 1.0, k_flat_mm = 0.1, k_flat_mm2 = 1.0;

/// The pulp in slices of one cell across the long axis.
struct Slices {
  int nx = 0, ny = 0, nz = 0;
  Vec3 low;  // centre of cell (0,0,0)
  std::vector<std::uint8_t> in;
  [[nodiscard]] std::size_t index(int x, int y, int z) const {
    return (static_cast<std::size_t>(z) * static_cast<std::size_t>(ny) +
            static_cast<std::size_t>(y)) *
               static_cast<std::size_t>(nx) +
           static_cast<std::size_t>(x);
  }
  [[nodiscard]] Vec3 place(double x, double y, double z) const {
    return low + Vec3{x, y, z} * k_cell;
  }
};

Slices slices_of(const Tooth& tooth, const CrownFrame& frame, std::uint8_t pulp) {
  const Octree& tree = tooth.octree;
  Bounds box;
  tree.for_each_cube([&](IVec3 at, int edge, std::uint8_t t) {
    if (t != pulp) return;
    for (int i = 0; i < 8; ++i) {
      const Vec3 corner{at.x + (i & 1 ? edge : 0.0), at.y + (i & 2 ? edge : 0.0),
                        at.z + (i & 4 ? edge : 0.0)};
      const Vec3 p = frame.from_tooth(tree.origin_mm() + corner * tree.leaf_mm());
      box.add(p);
    }
  });
  Slices s;
  if (box.empty()) return s;
  const auto cells = [](double a, double b) {
    return std::clamp(static_cast<int>((b - a) / k_cell) + 2, 1, 600);
  };
  s.nx = cells(box.low.x, box.high.x);
  s.ny = cells(box.low.y, box.high.y);
  s.nz = cells(box.low.z, box.high.z);
  s.low = box.low;
  s.in.assign(s.index(0, 0, s.nz), 0);
  Octree::Cursor cursor;
  for (int z = 0; z < s.nz; ++z)
    for (int y = 0; y < s.ny; ++y)
      for (int x = 0; x < s.nx; ++x)
        s.in[s.index(x, y, z)] = tree.tissue_at(frame.to_tooth(s.place(x, y, z)), cursor) == pulp;
  return s;
}

struct PulpPiece {
  int cells = 0;
  double x = 0, y = 0;  // sums
  bool goes_on = false;
};

/// Pieces of a slice that hang together by sides; `below`: the slice that a piece must reach
/// straight down to go on.
std::vector<PulpPiece> pieces_of(const Slices& s, int z, int below) {
  std::vector<PulpPiece> pieces;
  std::vector<std::uint8_t> seen(s.index(0, 0, 1), 0);
  std::vector<int> stack;
  for (int start = 0; start < s.nx * s.ny; ++start) {
    if (s.in[s.index(start % s.nx, start / s.nx, z)] == 0 ||
        seen[static_cast<std::size_t>(start)] != 0)
      continue;
    PulpPiece piece;
    stack.assign(1, start);
    seen[static_cast<std::size_t>(start)] = 1;
    while (!stack.empty()) {
      const int c = stack.back(), x = c % s.nx, y = c / s.nx;
      stack.pop_back();
      ++piece.cells;
      piece.x += x;
      piece.y += y;
      piece.goes_on = piece.goes_on || s.in[s.index(x, y, below)] != 0;
      const auto enter = [&](int ex, int ey) {
        if (ex < 0 || ey < 0 || ex >= s.nx || ey >= s.ny || s.in[s.index(ex, ey, z)] == 0) return;
        auto& was = seen[static_cast<std::size_t>(ey * s.nx + ex)];
        if (was == 0) stack.push_back(ey * s.nx + ex);
        was = 1;
      };
      enter(x + 1, y), enter(x - 1, y), enter(x, y + 1), enter(x, y - 1);
    }
    pieces.push_back(piece);
  }
  return pieces;
}

int area_of(const Slices& s, int z) {
  const auto from = s.in.begin() + static_cast<std::ptrdiff_t>(s.index(0, 0, z));
  return static_cast<int>(
      std::count(from, from + static_cast<std::ptrdiff_t>(s.index(0, 0, 1)), std::uint8_t{1}));
}

/// Lowest slice of a chamber that parts into canals; -1 where it never does.
int floor_slice(const Slices& s, int widest) {
  const int least = static_cast<int>(k_branch_mm2 / (k_cell * k_cell) + 0.5);
  const int lasting = std::max(1, static_cast<int>(k_split_mm / k_cell + 0.5));
  int since = -1;
  for (int z = widest; z >= 0; --z) {
    const auto pieces = pieces_of(s, z, z);
    const auto branches = std::count_if(pieces.begin(), pieces.end(),
                                        [&](const PulpPiece& p) { return p.cells >= least; });
    if (branches < 2)
      since = -1;
    else if (since < 0)
      since = z;
    if (since >= 0 && since - z >= lasting) return since + 1;
  }
  return -1;
}

CanalOpening opening_of(const Slices& s, const PulpPiece& p, double z_mm) {
  const Vec3 at = s.place(p.x / p.cells, p.y / p.cells, 0);
  return {{at.x, at.y, z_mm}, std::sqrt(p.cells / k_pi) * k_cell};
}

/// The canals below a floor. Two of one root may part a little below the others, and a floor that
/// is not quite level goes on beside a canal: of the slices with the most canals the first counts
/// that has no more than a share above the least area.
std::vector<CanalOpening> mouths_below(const Slices& s, int floor, double floor_z) {
  const int lasting = static_cast<int>(k_split_mm / k_cell + 0.5),
            last = std::max(0, floor - 1 - static_cast<int>(k_mouths_mm / k_cell + 0.5));
  struct Level {
    std::vector<CanalOpening> mouths;
    int cells = 0;
  };
  std::vector<Level> levels;
  std::size_t most = 0;
  for (int z = floor - 1; z >= last; --z) {
    Level level;
    for (const auto& p : pieces_of(s, z, std::max(0, z - lasting))) {
      if (!p.goes_on || p.cells * k_cell * k_cell < k_mouth_mm2) continue;
      level.mouths.push_back(opening_of(s, p, floor_z));
      level.cells += p.cells;
    }
    most = std::max(most, level.mouths.size());
    levels.push_back(std::move(level));
  }
  std::erase_if(levels, [&](const Level& l) { return l.mouths.size() < most; });
  const auto least =
      std::min_element(levels.begin(), levels.end(),
                       [](const Level& a, const Level& b) { return a.cells < b.cells; });
  const auto level = std::find_if(levels.begin(), levels.end(), [&](const Level& l) {
    return l.cells <= k_wider * least->cells;
  });
  return level == levels.end() ? std::vector<CanalOpening>{} : level->mouths;
}

/// How high the pulp reaches over each place of its slices, or how low.
HeightMap top_of(const Slices& s) {
  HeightMap map;
  map.nx = s.nx + 2;
  map.ny = s.ny + 2;
  map.low_x = s.low.x - k_cell;
  map.low_y = s.low.y - k_cell;
  map.z.assign(static_cast<std::size_t>(map.count()), s.low.z - k_cell);
  map.on.assign(map.z.size(), 0);
  for (int y = 0; y < s.ny; ++y)
    for (int x = 0; x < s.nx; ++x)
      for (int z = s.nz - 1; z >= 0; --z)
        if (s.in[s.index(x, y, z)] != 0) {
          const auto i = static_cast<std::size_t>(map.index(x + 1, y + 1));
          map.z[i] = s.low.z + (z + 0.5) * k_cell;
          map.on[i] = 1;
          break;
        }
  return map;
}

/// Of the slices that are wide, as high as the widest.
Vec3 chamber_middle(const Slices& s, int widest) {
  double sum_x = 0, sum_y = 0, area = 0;
  for (int z = 0; z < s.nz; ++z) {
    if (area_of(s, z) < k_chamber * area_of(s, widest)) continue;
    for (int y = 0; y < s.ny; ++y)
      for (int x = 0; x < s.nx; ++x)
        if (s.in[s.index(x, y, z)] != 0) {
          sum_x += x;
          sum_y += y;
          area += 1;
        }
  }
  return s.place(sum_x / area, sum_y / area, widest);
}

/// The lowest place of the pulp's top near the chamber's middle.
std::optional<Vec3> chamber_roof(const HeightMap& top, Vec3 middle) {
  constexpr double k_near_mm = 0.6;
  std::optional<Vec3> roof;
  for (int c = 0; c < top.count(); ++c) {
    const Vec3 p = top.place(c);
    const double dx = p.x - middle.x, dy = p.y - middle.y;
    if (top.on[static_cast<std::size_t>(c)] == 0 || dx * dx + dy * dy > k_near_mm * k_near_mm ||
        p.z < middle.z)
      continue;
    if (!roof || p.z < roof->z) roof = Vec3{middle.x, middle.y, p.z};
  }
  return roof;
}

}  // namespace

PulpMarks find_pulp_marks(const Tooth& tooth, const CrownFrame& frame, std::uint8_t pulp,
                          std::optional<double> neck_z, bool front) {
  PulpMarks marks;
  const Slices s = slices_of(tooth, frame, pulp);
  const auto cells = std::count(s.in.begin(), s.in.end(), std::uint8_t{1});
  if (pulp == k_air || static_cast<double>(cells) * k_cell * k_cell * k_cell < k_min_pulp_mm3) {
    marks.notes.emplace_back(msg("no pulp"));
    return marks;
  }
  int widest = 0;
  for (int z = 1; z < s.nz; ++z)
    if (area_of(s, z) > area_of(s, widest)) widest = z;
  const int floor = floor_slice(s, widest);
  const double chamber_low =
      floor >= 0 ? s.low.z + (floor - 0.5) * k_cell : s.low.z + widest * k_cell - 0.5;
  const HeightMap top = top_of(s).smoothed(k_horn_scale_mm), raw = top_of(s);
  std::optional<Vec3> between_horns;
  for (const auto& p : find_peaks(top, k_horn_mm)) {
    Vec3 at = top.place(p.cell);
    at.z = raw.at(p.cell);
    if (at.z <= chamber_low) continue;
    marks.horns.push_back(at);
    if (p.saddle >= 0 && top.at(p.saddle) > chamber_low &&
        (!between_horns || top.at(p.saddle) < between_horns->z))
      between_horns = top.place(p.saddle);
  }
  const Vec3 middle = chamber_middle(s, widest);
  // a front tooth's chamber narrows into the horns: its roof is the saddle between them
  if (front && between_horns) {
    Vec3 sum;
    for (const Vec3 h : marks.horns) sum += h;
    marks.roof = Vec3{sum.x / static_cast<double>(marks.horns.size()),
                      sum.y / static_cast<double>(marks.horns.size()), between_horns->z};
  }
  if (!front) marks.roof = chamber_roof(top, middle);
  if (floor >= 1) {
    marks.floor = Vec3{middle.x, middle.y, chamber_low};
    marks.mouths = mouths_below(s, floor, chamber_low);
  } else if (neck_z) {
    const int z = static_cast<int>((*neck_z - s.low.z) / k_cell + 0.5);
    if (z > 0 && z < s.nz) {
      const auto pieces = pieces_of(s, z, z);
      const auto main = std::max_element(
          pieces.begin(), pieces.end(),
          [](const PulpPiece& a, const PulpPiece& b) { return a.cells < b.cells; });
      if (main != pieces.end()) marks.mouths.push_back(opening_of(s, *main, *neck_z));
    }
    marks.notes.emplace_back(
        msg("one canal: the chamber has no floor, its canal begins at the neck"));
  }
  const auto by_x = [](Vec3 a, Vec3 b) { return a.x != b.x ? a.x > b.x : a.y > b.y; };
  std::sort(marks.horns.begin(), marks.horns.end(), by_x);
  std::sort(marks.mouths.begin(), marks.mouths.end(),
            [&](const CanalOpening& a, const CanalOpening& b) { return by_x(a.at_mm, b.at_mm); });
  return marks;
}

std::vector<Vec3> find_apices(const Tooth& tooth, const CrownFrame& frame, double neck_z,
                              std::vector<Message>& notes) {
  const Octree& tree = tooth.octree;
  HeightMap map;
  const auto cells = [](double a, double b) {
    return std::clamp(static_cast<int>((b - a) / k_cell) + 4, 1, 600);
  };
  map.nx = cells(frame.solid_low.x, frame.solid_high.x);
  map.ny = cells(frame.solid_low.y, frame.solid_high.y);
  map.low_x = frame.solid_low.x - k_cell;
  map.low_y = frame.solid_low.y - k_cell;
  map.z.assign(static_cast<std::size_t>(map.count()), -1e3);
  map.on.assign(map.z.size(), 0);
  const double step = tree.leaf_mm();
  Octree::Cursor cursor;
  for (int y = 0; y < map.ny; ++y)
    for (int x = 0; x < map.nx; ++x)
      for (double z = frame.solid_low.z - step; z < neck_z; z += step) {
        const Vec3 here{map.low_x + x * k_cell, map.low_y + y * k_cell, z};
        if (!tree.is_solid(tree.tissue_at(frame.to_tooth(here), cursor))) continue;
        const auto i = static_cast<std::size_t>(map.index(x, y));
        map.z[i] = -z;  // upside down: a root's end is a peak
        map.on[i] = 1;
        break;
      }
  std::vector<Vec3> apices;
  int flat = 0;
  const HeightMap smooth = map.smoothed(k_horn_scale_mm);
  for (const auto& p : find_peaks(smooth, k_apex_mm)) {
    const Vec3 end = map.place(p.cell);
    if (-end.z > neck_z - 2 * k_apex_mm) continue;
    double level = 0;
    for (int c = 0; c < smooth.count(); ++c) {
      const Vec3 q = smooth.place(c);
      const double dx = q.x - end.x, dy = q.y - end.y;
      if (smooth.on[static_cast<std::size_t>(c)] != 0 && dx * dx + dy * dy < 4.0 &&
          q.z > smooth.at(p.cell) - k_flat_mm)
        level += k_cell * k_cell;
    }
    if (level >= k_flat_mm2)
      ++flat;
    else
      apices.push_back({end.x, end.y, -end.z});
  }
  if (flat > 0)
    notes.push_back(msgn("{} of the roots' ends is flat, as if broken or cut: no apex",
                         "{} of the roots' ends are flat, as if broken or cut: no apex", flat,
                         flat));
  std::sort(apices.begin(), apices.end(),
            [](Vec3 a, Vec3 b) { return a.x != b.x ? a.x > b.x : a.y > b.y; });
  return apices;
}

}  // namespace cavum
