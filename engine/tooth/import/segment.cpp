#include "engine/tooth/import/segment.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <set>
#include <sstream>

#include "engine/base/error.h"
#include "engine/tooth/distance_transform.h"
#include "engine/tooth/import/import_error.h"

namespace cavum {
namespace {

using Mask = std::vector<std::uint8_t>;

/// Walks the six neighbours of a voxel that lie inside the volume.
template <class Visit>
void for_neighbours(IVec3 size, std::size_t i, const Visit& visit) {
  const auto nx = static_cast<std::size_t>(size.x), ny = static_cast<std::size_t>(size.y),
             nz = static_cast<std::size_t>(size.z);
  const std::size_t x = i % nx, y = i / nx % ny, z = i / (nx * ny);
  if (x > 0) visit(i - 1);
  if (x + 1 < nx) visit(i + 1);
  if (y > 0) visit(i - nx);
  if (y + 1 < ny) visit(i + nx);
  if (z > 0) visit(i - nx * ny);
  if (z + 1 < nz) visit(i + nx * ny);
}

bool on_border(IVec3 size, std::size_t i) {
  const auto nx = static_cast<std::size_t>(size.x), ny = static_cast<std::size_t>(size.y),
             nz = static_cast<std::size_t>(size.z);
  const std::size_t x = i % nx, y = i / nx % ny, z = i / (nx * ny);
  return x == 0 || y == 0 || z == 0 || x + 1 == nx || y + 1 == ny || z + 1 == nz;
}

/// Connected bodies (by faces) of a mask: number of each voxel's body (0 = none, 1..), and sizes by
/// number.
struct Bodies {
  std::vector<std::uint32_t> number;
  std::vector<std::uint64_t> voxels{0};
  [[nodiscard]] std::uint32_t largest() const {
    return static_cast<std::uint32_t>(std::max_element(voxels.begin() + 1, voxels.end()) -
                                      voxels.begin());
  }
};
Bodies bodies_of(IVec3 size, const Mask& mask) {
  Bodies b;
  b.number.assign(mask.size(), 0);
  std::vector<std::size_t> front;
  for (std::size_t seed = 0; seed < mask.size(); ++seed) {
    if (!mask[seed] || b.number[seed]) continue;
    const auto number = static_cast<std::uint32_t>(b.voxels.size());
    b.voxels.push_back(0);
    b.number[seed] = number;
    front.push_back(seed);
    while (!front.empty()) {
      const auto i = front.back();
      front.pop_back();
      ++b.voxels[number];
      for_neighbours(size, i, [&](std::size_t j) {
        if (!mask[j] || b.number[j]) return;
        b.number[j] = number;
        front.push_back(j);
      });
    }
  }
  return b;
}

/// Rule 2: what a ball reaches from the border.
Mask outside_of(IVec3 size, const Mask& hard, double radius_voxels) {
  const auto nearest = nearest_seed(size, hard, radius_voxels);
  Mask reached(hard.size(), 0);
  std::vector<std::size_t> front;
  const auto enter = [&](std::size_t i) {
    if (reached[i] || nearest[i] >= 0) return;
    reached[i] = 1;
    front.push_back(i);
  };
  for (std::size_t i = 0; i < hard.size(); ++i)
    if (on_border(size, i)) enter(i);
  while (!front.empty()) {
    const auto i = front.back();
    front.pop_back();
    for_neighbours(size, i, enter);
  }
  const auto to_reached = nearest_seed(size, reached, radius_voxels + 0.5);
  Mask outside(hard.size());
  for (std::size_t i = 0; i < hard.size(); ++i) outside[i] = !hard[i] && to_reached[i] >= 0;
  return outside;
}

/// Rule 3, on voxels labelled by gray alone.
void give_rim_to_what_lies_beneath(Segmentation& s, const Mask& outside) {
  const auto to_outside = nearest_seed(s.size, outside, k_rim_voxels);
  Mask trusted(s.tissue.size());
  for (std::size_t i = 0; i < trusted.size(); ++i)
    trusted[i] = s.tissue[i] == k_enamel || (s.tissue[i] == k_dentin && to_outside[i] < 0);
  const auto nearest = nearest_seed(s.size, trusted, 4 * k_rim_voxels);
  const auto before = s.tissue;
  for (std::size_t i = 0; i < trusted.size(); ++i)
    if (before[i] == k_dentin && !trusted[i] && nearest[i] >= 0)
      s.tissue[i] = before[static_cast<std::size_t>(nearest[i])];
}

/// Share of the enamel's outer side that shows dentin: outer dentin voxels with enamel straight
/// below, within 3 voxels along the gray's gradient, against those and the outer enamel voxels
/// together.
double measure_rim_percent(const Segmentation& s, const Volume& v, const Mask& outside) {
  std::uint64_t covered = 0, bare = 0;
  for (std::int32_t z = 1; z + 1 < s.size.z; ++z)
    for (std::int32_t y = 1; y + 1 < s.size.y; ++y)
      for (std::int32_t x = 1; x + 1 < s.size.x; ++x) {
        const IVec3 at{x, y, z};
        const auto i = v.index(at);
        if (s.tissue[i] != k_enamel && s.tissue[i] != k_dentin) continue;
        bool outer = false;
        for_neighbours(s.size, i, [&](std::size_t j) { outer = outer || outside[j]; });
        if (!outer) continue;
        if (s.tissue[i] == k_enamel) {
          ++bare;
          continue;
        }
        const auto g = [&](IVec3 d) {
          return static_cast<double>(v.gray[v.index(at + d)]) -
                 static_cast<double>(v.gray[v.index(at - d)]);
        };
        const Vec3 inwards = normalized({g({1, 0, 0}), g({0, 1, 0}), g({0, 0, 1})}, {0, 0, 0});
        for (int step = 1; step <= 3; ++step) {
          const auto round = [](double w) {
            return static_cast<std::int32_t>(std::floor(w + 0.5));
          };
          const IVec3 below{x + round(inwards.x * step), y + round(inwards.y * step),
                            z + round(inwards.z * step)};
          if (!lies_in(below, s.size)) break;
          if (s.tissue[v.index(below)] == k_enamel) {
            ++covered;
            break;
          }
        }
      }
  return covered + bare > 0
             ? 100.0 * static_cast<double>(covered) / static_cast<double>(covered + bare)
             : 0.0;
}

/// 1-2-1 along each axis, the outermost voxels repeated.
void smooth(IVec3 size, std::vector<float>& f) {
  const std::size_t step[3] = {1, static_cast<std::size_t>(size.x),
                               static_cast<std::size_t>(size.x) * static_cast<std::size_t>(size.y)};
  const std::size_t length[3] = {static_cast<std::size_t>(size.x), static_cast<std::size_t>(size.y),
                                 static_cast<std::size_t>(size.z)};
  for (int a = 0; a < 3; ++a) {
    const auto from = f;
    for (std::size_t i = 0; i < f.size(); ++i) {
      const std::size_t p = i / step[a] % length[a];
      f[i] = 0.25f * from[p > 0 ? i - step[a] : i] + 0.5f * from[i] +
             0.25f * from[p + 1 < length[a] ? i + step[a] : i];
    }
  }
}

/// Rule 1: the tooth is the largest body of hard gray; the others are specks.
struct HardBodies {
  Bodies bodies;
  std::uint32_t tooth = 0;  // number of its body
  Mask in_tooth;
  [[nodiscard]] bool is_speck(std::size_t i) const {
    return bodies.number[i] != 0 && bodies.number[i] != tooth;
  }
  [[nodiscard]] std::size_t specks() const { return bodies.voxels.size() - 2; }
};
HardBodies find_tooth(const Volume& volume, double hard_gray, const std::string& where) {
  HardBodies found;
  Mask hard(volume.gray.size());
  for (std::size_t i = 0; i < hard.size(); ++i) hard[i] = volume.gray[i] > hard_gray;
  found.bodies = bodies_of(volume.size, hard);
  if (found.bodies.voxels.size() < 2 || found.bodies.voxels[found.bodies.largest()] < 100)
    throw Error(ImportError::no_tooth, Name{where},
                msg("no tooth found: nothing larger than 100 voxels is brighter than {}",
                    as_number(hard_gray)),
                msg("check the volume or --dentin-threshold"));
  found.tooth = found.bodies.largest();
  found.in_tooth.resize(hard.size());
  for (std::size_t i = 0; i < hard.size(); ++i)
    found.in_tooth[i] = found.bodies.number[i] == found.tooth;
  return found;
}

/// What is neither hard nor outside: pulp, pores in hard tissue (which are filled), and clefts in
/// the outer surface (which are outside).
struct Hollows {
  Bodies bodies;
  std::vector<std::uint64_t> outer_faces, hard_faces;  // of each body
  std::uint32_t pulp = 0;  // number of the largest body that is mostly enclosed

  [[nodiscard]] bool is_pulp(std::uint32_t b) const {
    return b != 0 &&
           (b == pulp || (outer_faces[b] == 0 && bodies.voxels[b] * 20 > bodies.voxels[pulp]));
  }
  [[nodiscard]] bool is_pore(std::uint32_t b) const {
    return b != 0 && !is_pulp(b) && outer_faces[b] == 0;
  }
};
Hollows find_hollows(IVec3 size, const Mask& hard, const Mask& outside, const std::string& where) {
  Hollows found;
  Mask enclosed(hard.size());
  for (std::size_t i = 0; i < hard.size(); ++i) enclosed[i] = !hard[i] && !outside[i];
  found.bodies = bodies_of(size, enclosed);
  const std::size_t count = found.bodies.voxels.size();
  if (count < 2)
    throw Error(ImportError::no_tissue, Name{where},
                msg("no pulp found: no hollow is enclosed by hard tissue"),
                msg("check --dentin-threshold"));
  found.outer_faces.assign(count, 0);
  found.hard_faces.assign(count, 0);
  for (std::size_t i = 0; i < hard.size(); ++i)
    if (enclosed[i])
      for_neighbours(size, i, [&](std::size_t j) {
        found.outer_faces[found.bodies.number[i]] += outside[j];
        found.hard_faces[found.bodies.number[i]] += hard[j];
      });
  for (std::uint32_t b = 1; b < count; ++b)
    if (found.outer_faces[b] * 5 < found.hard_faces[b] &&
        (found.pulp == 0 || found.bodies.voxels[b] > found.bodies.voxels[found.pulp]))
      found.pulp = b;
  if (found.pulp == 0)
    throw Error(
        ImportError::no_tissue, Name{where},
        msg("no pulp found: every hollow is open to the outside"),
        msg("check --dentin-threshold; of a scan that ends above the roots' tips the canals are open below: bring more of the root, or mark the "
            "pulp in a label map (--map)"));
  return found;
}

/// The tissue of every voxel by its gray. Returns how many voxels are of pores.
std::uint64_t label_by_gray(Segmentation& s, const Volume& volume, double enamel_gray,
                            const Mask& hard, const Hollows& hollows) {
  s.tissue.assign(hard.size(), k_air);
  std::uint64_t pores = 0;
  for (std::size_t i = 0; i < hard.size(); ++i) {
    const auto hollow = hollows.bodies.number[i];
    const bool pore = hollows.is_pore(hollow);
    pores += pore;
    if (hollows.is_pulp(hollow))
      s.tissue[i] = k_pulp;
    else if (hard[i] || pore)
      s.tissue[i] = volume.gray[i] > enamel_gray ? k_enamel : k_dentin;
  }
  return pores;
}

Mask voxels_of(const Segmentation& s, std::uint8_t tissue) {
  Mask mask(s.tissue.size());
  for (std::size_t i = 0; i < mask.size(); ++i) mask[i] = s.tissue[i] == tissue;
  return mask;
}

/// Bright specks, smaller than a fiftieth of the crown, are dentin.
void drop_specks_of_enamel(Segmentation& s, double enamel_gray, const std::string& where) {
  const Bodies caps = bodies_of(s.size, voxels_of(s, k_enamel));
  if (caps.voxels.size() < 2)
    throw Error(ImportError::no_tissue, Name{where},
                msg("no enamel found above gray {}", as_number(enamel_gray)),
                msg("check --enamel-threshold"));
  const auto crown = caps.voxels[caps.largest()];
  for (std::size_t i = 0; i < s.tissue.size(); ++i)
    if (caps.number[i] != 0 && caps.voxels[caps.number[i]] * 50 < crown) s.tissue[i] = k_dentin;
}

/// Gray of the surface at every voxel. It lies half way between the grays of the two sides, so it
/// depends on who meets whom.
std::vector<float> surface_gray(const Segmentation& s, const GrayLevels& levels) {
  const auto enamel_share = smoothed_indicator(s, k_enamel),
             dentin_share = smoothed_indicator(s, k_dentin),
             pulp_share = smoothed_indicator(s, k_pulp);
  std::vector<float> level(s.tissue.size());
  for (std::size_t i = 0; i < level.size(); ++i) {
    const double hard_share = enamel_share[i] + dentin_share[i];
    const double e = hard_share > 0 ? enamel_share[i] / hard_share : 0.0,
                 p = std::min(1.0, 3.0 * pulp_share[i]);
    level[i] = static_cast<float>(p * levels.pulp_surface +
                                  (1 - p) * (e * levels.enamel_surface + (1 - e) * levels.hard));
  }
  smooth(s.size, level);
  return level;
}

/// How far each voxel's gray is above that of the surface. Where the label was decided by more than
/// the voxel's gray (specks, pores), the label wins.
std::vector<float> solid_field(const Segmentation& s, const Volume& volume,
                               const GrayLevels& levels, const HardBodies& hard) {
  const std::vector<float> level = surface_gray(s, levels);
  const double full = std::max(levels.enamel - levels.hard, 1e-9);
  std::vector<float> solid(s.tissue.size());
  for (std::size_t i = 0; i < solid.size(); ++i) {
    const double value = std::clamp((volume.gray[i] - level[i]) / full, -1.0, 1.0);
    const bool is_hard = s.tissue[i] == k_enamel || s.tissue[i] == k_dentin;
    if (is_hard)
      solid[i] = static_cast<float>(hard.in_tooth[i] ? value : std::max(value, 0.3));
    else
      solid[i] = static_cast<float>(hard.is_speck(i) ? std::min(value, -0.3) : value);
  }
  return solid;
}

void count(Segmentation& s) {
  for (const auto tissue : s.tissue) ++s.voxels[tissue];
  s.pulp_bodies = bodies_of(s.size, voxels_of(s, k_pulp)).voxels.size() - 1;
}

}  // namespace

std::vector<float> smoothed_indicator(const Segmentation& s, std::uint8_t tissue) {
  std::vector<float> f(s.tissue.size());
  for (std::size_t i = 0; i < f.size(); ++i) f[i] = s.tissue[i] == tissue ? 1.0f : 0.0f;
  smooth(s.size, f);
  return f;
}

Segmentation segment(const Volume& volume, const GrayLevels& levels, const std::string& where) {
  Segmentation s;
  s.size = volume.size;
  const HardBodies hard = find_tooth(volume, levels.hard, where);
  const double mean_spacing_mm =
      (volume.spacing_mm[0] + volume.spacing_mm[1] + volume.spacing_mm[2]) / 3;
  const Mask outside =
      outside_of(s.size, hard.in_tooth, std::clamp(k_cap_mm / mean_spacing_mm, 2.0, 40.0));
  const Hollows hollows = find_hollows(s.size, hard.in_tooth, outside, where);
  s.pores = label_by_gray(s, volume, levels.enamel, hard.in_tooth, hollows);
  drop_specks_of_enamel(s, levels.enamel, where);
  const Mask air = voxels_of(s, k_air);
  give_rim_to_what_lies_beneath(s, air);
  s.rim_percent = measure_rim_percent(s, volume, air);
  s.solid = solid_field(s, volume, levels, hard);
  count(s);
  s.specks = hard.specks();
  return s;
}

Segmentation from_labels(const Volume& labels, const std::map<int, std::uint8_t>& meaning,
                         const std::string& where) {
  Segmentation s;
  s.size = labels.size;
  s.tissue.resize(labels.gray.size());
  std::set<int> unknown;
  for (std::size_t i = 0; i < s.tissue.size(); ++i) {
    const double value = labels.gray[i];
    if (value != std::floor(value) || std::fabs(value) > 1e6)
      throw Error(where, msg("not a label map: voxel {} is no whole number", i),
                  msg("leave out --map to import a CT volume"));
    const int label = static_cast<int>(value);
    const auto it = meaning.find(label);
    if (it != meaning.end())
      s.tissue[i] = it->second;
    else if (label != 0)
      unknown.insert(label);
  }
  if (!unknown.empty()) {
    List first;
    for (const int u : unknown)
      if (first.items.size() < 20) first.items.push_back(msg("{}", u));
    if (unknown.size() > first.items.size()) first.items.push_back(msg("..."));
    throw Error(ImportError::unknown_labels, Name{where},
                msg("labels without a meaning: {}", first),
                msg("name them in --map, as N=enamel, N=dentin, N=pulp or N=air"));
  }
  count(s);
  if (s.voxels[k_enamel] + s.voxels[k_dentin] == 0)
    throw Error(where, msg("no voxel is enamel or dentin"), msg("check --map"));
  const auto e = smoothed_indicator(s, k_enamel), d = smoothed_indicator(s, k_dentin);
  s.solid.resize(s.tissue.size());
  for (std::size_t i = 0; i < s.solid.size(); ++i) {
    const float value = 2 * (e[i] + d[i]) - 1;
    // A label's own voxel keeps its side, so that canals of a single voxel survive the smoothing.
    const bool hard = s.tissue[i] == k_enamel || s.tissue[i] == k_dentin;
    s.solid[i] = hard ? std::max(value, 0.15f) : std::min(value, -0.15f);
  }
  return s;
}

std::map<int, std::uint8_t> parse_label_map(const std::string& text) {
  std::map<int, std::uint8_t> map;
  std::istringstream parts(text);
  for (std::string part; std::getline(parts, part, ',');) {
    const auto equal = part.find('=');
    int label = 0;
    const auto read =
        std::from_chars(part.data(), part.data() + std::min(equal, part.size()), label);
    const std::string name = equal == std::string::npos ? "" : part.substr(equal + 1);
    std::uint8_t id = name == "air" ? std::uint8_t{k_air} : std::uint8_t{255};
    for (const auto& t : standard_tissues())
      if (t.name == name) id = t.id;
    if (read.ec != std::errc{} || equal == std::string::npos || read.ptr != part.data() + equal ||
        id == 255)
      throw Error(ImportError::bad_option, Name{"--map"}, msg("cannot read '{}'", part),
                  msg("write 1=enamel,2=dentin,3=pulp (also air and periodontium)"));
    if (!map.emplace(label, id).second)
      throw Error(ImportError::bad_option, Name{"--map"}, msg("label {} is given twice", label),
                  msg("give each label once"));
  }
  if (map.empty())
    throw Error(ImportError::bad_option, Name{"--map"}, msg("is empty"),
                msg("write 1=enamel,2=dentin,3=pulp"));
  return map;
}

}  // namespace cavum
