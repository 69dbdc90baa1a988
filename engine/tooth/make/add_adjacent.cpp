#include "engine/tooth/make/add_adjacent.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "engine/base/det_math.h"
#include "engine/base/error.h"
#include "engine/base/text.h"
#include "engine/tooth/adjacent.h"
#include "engine/tooth/anatomy/polylines.h"
#include "engine/tooth/distance.h"
#include "engine/tooth/fill.h"
#include "engine/tooth/make/add_gum.h"
#include "engine/tooth/make/formula_tooth.h"
#include "engine/tooth/make/in_a_row.h"
#include "engine/tooth/octree_edit.h"

namespace cavum {
namespace {

constexpr double k_below_contact_mm = 5.0;
constexpr double k_area_mm = 0.05;      // surfaces nearer than that are the contact area
constexpr double k_seen_leaves = 1.95;  // further than that a distance only says "far"
constexpr double k_facing_mm = 2.5;  // of the tooth's surface, how deep behind its furthest place
constexpr double k_max_overlap_mm = 3.0;  // bodies that have not met by then do not face each other
constexpr int k_edge_leaves = 3;          // of air that stays at the lattice's sides

/// Places on the solid surface of a body with x beyond `from` on a side.
std::vector<Vec3> surface_positions(const Octree& tree, int side, double from_mm) {
  constexpr IVec3 k_steps[] = {{1, 0, 0}, {-1, 0, 0}, {0, 1, 0}, {0, -1, 0}, {0, 0, 1}, {0, 0, -1}};
  std::vector<Vec3> places;
  Octree::Cursor cursor;
  tree.for_each_cube([&](IVec3 at, int edge, std::uint8_t tissue) {
    if (!tree.is_solid(tissue) ||
        side * tree.centre_mm(at + IVec3{side > 0 ? edge - 1 : 0, 0, 0}).x < side * from_mm)
      return;
    for (int z = 0; z < edge; ++z)
      for (int y = 0; y < edge; ++y)
        for (int x = 0; x < edge; ++x) {
          const IVec3 leaf = at + IVec3{x, y, z};
          const Vec3 centre = tree.centre_mm(leaf);
          if (side * centre.x < side * from_mm) continue;
          if (std::none_of(std::begin(k_steps), std::end(k_steps),
                           [&](IVec3 s) { return !tree.is_solid(tree.tissue(leaf + s)); }))
            continue;
          const SurfaceSample s = tree.sample(centre, cursor);
          places.push_back(centre - normalized(s.gradient) * s.distance_mm);
        }
  });
  return places;
}

/// How far solid tissue reaches along x on a side, mm.
double furthest_mm(const Octree& tree, int side) {
  double far = -1e9;
  tree.for_each_cube([&](IVec3 at, int edge, std::uint8_t tissue) {
    if (tree.is_solid(tissue))
      far = std::max(
          far, side * (tree.origin_mm().x + (side > 0 ? at.x + edge : at.x) * tree.leaf_mm()));
  });
  return far;
}

double top_mm(const Octree& tree) {
  double top = -1e9;
  tree.for_each_cube([&](IVec3 at, int edge, std::uint8_t tissue) {
    if (tree.is_solid(tissue))
      top = std::max(top, tree.origin_mm().z + (at.z + edge) * tree.leaf_mm());
  });
  return top;
}

/// A neighbour in the frame of the tooth beside which it stands.
struct Placed {
  const Octree* tree = nullptr;
  Vec3 own, at;  ///< a place of its own frame, and where that lies in the tooth's
  SinCos turn;
  [[nodiscard]] Vec3 into(Vec3 p) const noexcept {
    const Vec3 q = p - at;
    return own + Vec3{q.x * turn.cos + q.y * turn.sin, q.y * turn.cos - q.x * turn.sin, q.z};
  }
  [[nodiscard]] Placed moved(double x_mm) const noexcept {
    Placed p = *this;
    p.at.x += x_mm;
    return p;
  }
  [[nodiscard]] double least_mm(const std::vector<Vec3>& places,
                                Octree::Cursor& cursor) const noexcept {
    double least = 1e9;
    for (const Vec3 p : places) least = std::min(least, tree->sample(into(p), cursor).distance_mm);
    return least;
  }
};

/// Moved along x until the least distance from `places` is `wanted_mm`; none where they do not
/// meet.
std::optional<Placed> moved_to_contact(Placed n, int side, const std::vector<Vec3>& places,
                                       double wanted_mm) {
  constexpr int k_halvings = 24;
  const double leaf = n.tree->leaf_mm();
  Octree::Cursor cursor;
  double apart = 0, met = 0;
  while (n.moved(side * met).least_mm(places, cursor) > wanted_mm) {
    apart = met;
    met -= 0.5 * leaf;
    if (met < -k_max_overlap_mm - k_facing_mm) return {};
  }
  for (int i = 0; i < k_halvings; ++i) {
    const double middle = 0.5 * (apart + met);
    (n.moved(side * middle).least_mm(places, cursor) > wanted_mm ? apart : met) = middle;
  }
  return n.moved(side * apart);
}

ContactFacts contact_facts(const Placed& n, const std::vector<Vec3>& places) {
  ContactFacts facts;
  Octree::Cursor cursor;
  facts.gap_mm = 1e9;
  Vec3 sum;
  Bounds box;
  double count = 0;
  std::vector<double> d;
  for (const Vec3 p : places)
    facts.gap_mm =
        std::min(facts.gap_mm, d.emplace_back(n.tree->sample(n.into(p), cursor).distance_mm));
  for (std::size_t i = 0; i < d.size(); ++i) {
    if (d[i] > std::min(facts.gap_mm + k_area_mm, k_seen_leaves * n.tree->leaf_mm())) continue;
    const Vec3 p = places[i];
    sum += p;
    count += 1;
    box.add(p);
  }
  facts.at_mm = sum / count;
  facts.width_mm = box.high.y - box.low.y;
  facts.height_mm = box.high.z - box.low.z;
  return facts;
}

/// The same leaves with more air around.
TissueGrid with_room(const TissueGrid& grid, IVec3 before, IVec3 after, const std::string& where) {
  const IVec3 size = grid.size + before + after;
  check_lattice(size, grid.leaf_mm, where, k_max_row_leaves);
  TissueGrid wide;
  wide.allocate(size, grid.leaf_mm, grid.origin_mm - to_vec3(before) * grid.leaf_mm);
  for (std::int32_t z = 0; z < grid.size.z; ++z)
    for (std::int32_t y = 0; y < grid.size.y; ++y) {
      const std::size_t from = grid.index({0, y, z}), to = wide.index(IVec3{0, y, z} + before);
      for (std::size_t x = 0; x < static_cast<std::size_t>(grid.size.x); ++x) {
        wide.tissue[to + x] = grid.tissue[from + x];
        wide.distance[to + x] = grid.distance[from + x];
      }
    }
  return wide;
}

/// The tissue of a neighbour at a place where its distance says solid.
std::uint8_t tissue_of_neighbour(const Octree& tree, std::uint8_t enamel, Vec3 q,
                                 Octree::Cursor& cursor, const AdjacentIds& ids) {
  std::uint8_t t = tree.tissue_at(q, cursor);
  if (!tree.is_solid(t)) {  // its leaf's centre lies just outside
    const Vec3 inwards = normalized(-tree.sample(q, cursor).gradient);
    t = tree.tissue_at(q + inwards * tree.leaf_mm(), cursor);
  }
  return t == enamel ? ids.enamel : ids.dentin;
}

/// A side of the work: who stands there, how far it is kept.
struct Side {
  int side = 1;
  std::string name;
  Tooth filled;
  std::uint8_t enamel = k_air;
  Placed placed;
  ContactFacts facts;
  double limit_x_mm = 0.0;
  Message doubt;  ///< whether it stands beside the tooth in a jaw: confirmed, or not checked
};

void lay_neighbour(TissueGrid& grid, const Side& s, const AdjacentIds& ids) {
  const double leaf = grid.leaf_mm, low_z = s.facts.at_mm.z - k_below_contact_mm;
  const Vec3 first = grid.centre_mm({k_edge_leaves, k_edge_leaves, k_edge_leaves});
  const Vec3 last =
      grid.centre_mm(grid.size - IVec3{k_edge_leaves + 1, k_edge_leaves + 1, k_edge_leaves + 1});
  Octree::Cursor cursor;
  std::size_t i = 0;
  for (std::int32_t z = 0; z < grid.size.z; ++z)
    for (std::int32_t y = 0; y < grid.size.y; ++y)
      for (std::int32_t x = 0; x < grid.size.x; ++x, ++i) {
        const Vec3 p = grid.centre_mm({x, y, z});
        if (s.side * (p.x - s.facts.at_mm.x) < -k_facing_mm || p.z < low_z - 2 * leaf ||
            s.side * (p.x - s.limit_x_mm) > 2 * leaf)
          continue;
        const Vec3 q = s.placed.into(p);
        const double cut = std::max({s.side * (p.x - s.limit_x_mm), low_z - p.z, first.y - p.y,
                                     p.y - last.y, p.z - last.z});
        const double d = std::max(s.placed.tree->sample(q, cursor).distance_mm, cut) / leaf;
        if (d < 0 && grid.tissue[i] == k_air) {
          grid.tissue[i] = tissue_of_neighbour(*s.placed.tree, s.enamel, q, cursor, ids);
          grid.distance[i] = std::min(encode_distance(d), std::int8_t{-1});
        } else if (grid.distance[i] > 0) {
          grid.distance[i] =
              std::min(grid.distance[i], std::max(encode_distance(d), std::int8_t{1}));
        }
      }
}

std::uint8_t id_of(const Tooth& tooth, const char* name) {
  for (const auto& t : tooth.tissues)
    if (t.name == name) return t.id;
  return k_air;
}

/// Without pulp: a hollow of the neighbour is of no interest.
Tooth without_hollows(const Tooth& neighbour) {
  TissueSet pulp{};
  if (const std::uint8_t id = id_of(neighbour, "pulp"); id != k_air) pulp[id] = true;
  return filled_tooth(own_tooth(neighbour), pulp);
}

Side place_side(const Tooth& tooth, const Landmarks& marks, const AdjacentTooth& beside, int side,
                const AdjacentSpec& spec, const std::string& where) {
  Side s;
  s.side = side;
  s.name = beside.tooth->name;
  const std::string word = side > 0 ? "mesial" : "distal", place = where + " --" + word;
  const double leaf = tooth.octree.leaf_mm();
  if (std::fabs(beside.tooth->octree.leaf_mm() - leaf) > 1e-9)
    throw Error(place,
                msg("the leaves of '{}' have {}, the tooth's {}", beside.tooth->name,
                    as_mm(beside.tooth->octree.leaf_mm(), k_as_needed), as_number(leaf)),
                msg("make it with --leaf-mm {}", as_number(leaf)));
  s.filled = without_hollows(*beside.tooth);
  s.enamel = id_of(s.filled, "enamel");
  s.placed.tree = &s.filled.octree;
  s.placed.turn = det_sincos(beside.turn_deg * k_pi / 180);
  const Landmarks other = find_landmarks(s.filled);
  const RowVerdict row =
      stand_in_a_row({tooth.name, tooth.kind, marks.tooth_class},
                     {beside.tooth->name, beside.tooth->kind, other.tooth_class}, side);
  if (!row.why_not.empty() && !spec.confirmed)
    throw Error(
        place, row.why_not,
        msg("give its neighbour; where they shall stand so all the same, --confirm neighbours takes them"));
  s.doubt = row.why_not.empty() ? row.unchecked : msg("confirmed (neighbours): {}", row.why_not);
  const Vec3 *own_contact = furthest_along(marks.height_of_contour_mm, Vec3{1.0 * side, 0, 0}),
             *its_contact = furthest_along(other.height_of_contour_mm, Vec3{-1.0 * side, 0, 0});
  if (own_contact != nullptr && its_contact != nullptr) {
    s.placed.own = *its_contact;
    s.placed.at = *own_contact;
  }
  const double far = furthest_mm(tooth.octree, side);
  const std::vector<Vec3> facing =
      surface_positions(tooth.octree, side, side * (far - k_facing_mm));
  double its_reach = -1e9;  // towards the tooth, in the tooth's frame
  for (const Vec3 q :
       surface_positions(s.filled.octree, -side,
                         -side * (furthest_mm(s.filled.octree, -side) - k_max_overlap_mm))) {
    const Vec3 r = q - s.placed.own;
    its_reach = std::max(
        its_reach, -side * (s.placed.at.x + r.x * s.placed.turn.cos - r.y * s.placed.turn.sin));
  }
  s.placed = s.placed.moved(side * (far + its_reach + 2 * leaf));
  const auto met = moved_to_contact(s.placed, side, facing, spec.contact_mm);
  if (!met)
    throw Error(place, msg("its surface and the tooth's do not face each other"),
                msg("check its frame: +x is mesial, +y buccal, +z occlusal"));
  s.placed = *met;
  s.facts = contact_facts(s.placed, facing);
  s.limit_x_mm = s.facts.at_mm.x + side * spec.reach_mm;
  return s;
}

/// Numbers for the new tissues: their own where the tooth's table leaves them free, else the next
/// ones.
AdjacentIds ids_for(Tooth& tooth, bool neighbours, bool gum) {
  const auto taken = [&](std::uint8_t id) {
    return std::any_of(tooth.tissues.begin(), tooth.tissues.end(),
                       [&](const Tissue& t) { return t.id == id; });
  };
  const auto add = [&](const char* name) {
    std::uint8_t wanted = known_tissue(name).id;
    while (taken(wanted)) ++wanted;
    tooth.tissues.push_back({wanted, name, true});
    return wanted;
  };
  constexpr std::size_t k_max_tissues = 200;
  if (tooth.tissues.size() > k_max_tissues)
    throw Error(msg("tooth"), msg("has too many tissues to set something beside it"),
                msg("use fewer"));
  AdjacentIds ids;
  if (neighbours) {
    ids.enamel = add("neighbour_enamel");
    ids.dentin = add("neighbour_dentin");
  }
  if (gum) ids.gum = add("gingiva");
  return ids;
}

int whole_bricks(double leaves) {
  return leaves <= 0 ? 0 : (static_cast<int>(std::ceil(leaves)) + 3) / 4 * 4;
}

/// Room for the neighbours' parts and for the gum.
TissueGrid grid_for(const Tooth& tooth, const std::vector<Side>& sides, bool gum,
                    const std::string& where) {
  const Octree& tree = tooth.octree;
  const double leaf = tree.leaf_mm();
  const IVec3 n = tree.size();
  IVec3 before{0, 0, 0}, after{0, 0, 0};
  constexpr int k_room = k_edge_leaves + 2;
  for (const Side& s : sides) {
    const double x = (s.limit_x_mm - tree.origin_mm().x) / leaf;
    if (s.side > 0)
      after.x = std::max(after.x, whole_bricks(x + k_room - n.x));
    else
      before.x = std::max(before.x, whole_bricks(k_room - x));
    const double top =
        (top_mm(s.filled.octree) - s.placed.own.z + s.placed.at.z - tree.origin_mm().z) / leaf;
    after.z = std::max(after.z, whole_bricks(top + k_room - n.z));
  }
  if (gum) {
    const int around = whole_bricks(k_gum_room_mm / leaf);
    before.y += around;
    after.y += around;
    before.x = std::max(before.x, around);
    after.x = std::max(after.x, around);
  }
  return with_room(tree.to_grid(), before, after, where);
}

/// A brick of the octree without distances is all solid or all void: where something solid that was
/// set beside the tooth borders a void tissue of its own (periodontium), both get the distance of a
/// border.
void mark_borders(TissueGrid& grid, const std::vector<Tissue>& tissues) {
  constexpr std::int8_t k_half = encode_distance(0.5);
  std::array<bool, 256> solid{}, set{};
  for (const Tissue& t : tissues) {
    solid[t.id] = t.solid;
    set[t.id] = is_adjacent(t.name);
  }
  const std::size_t strides[3] = {1, grid.index({0, 1, 0}), grid.index({0, 0, 1})};
  const auto border = [&](std::size_t a, std::size_t b) {
    if (!set[grid.tissue[a]] || grid.tissue[b] == k_air || solid[grid.tissue[b]]) return;
    grid.distance[a] = std::max(grid.distance[a], static_cast<std::int8_t>(-k_half));
    grid.distance[b] = std::min(grid.distance[b], k_half);
  };
  for (const std::size_t stride : strides)
    for (std::size_t i = 0; i + stride < grid.count(); ++i) {
      border(i, i + stride);
      border(i + stride, i);
    }
}

}  // namespace

AddedAdjacent add_adjacent(const Tooth& tooth, const AdjacentSpec& spec, const std::string& where) {
  const double leaf = tooth.octree.leaf_mm();
  check_choice("--contact-mm", spec.contact_mm, 0.0, k_widest_contact_leaves * leaf);
  check_choice("--reach-mm", spec.reach_mm, 1.0, 6.0);
  if (has_adjacent(tooth))
    throw Error(where, msg("something stands beside the tooth already"),
                msg("give the tooth alone"));
  if (spec.mesial.tooth == nullptr && spec.distal.tooth == nullptr && !spec.gum)
    throw Error(where, msg("nothing is to be set beside the tooth"),
                msg("give --mesial, --distal or --gum"));
  const Landmarks marks = find_landmarks(tooth);
  std::vector<Side> sides;
  for (const auto& [beside, side] : {std::pair(&spec.mesial, 1), std::pair(&spec.distal, -1)}) {
    check_choice("--turn-deg", beside->turn_deg, -45.0, 45.0);
    if (beside->tooth == nullptr) continue;
    sides.push_back(place_side(tooth, marks, *beside, side, spec, where));
    sides.back().placed.tree = &sides.back().filled.octree;
  }
  for (Side& s : sides) s.placed.tree = &s.filled.octree;  // the list has grown

  AddedAdjacent out;
  out.tooth = Tooth{tooth, {}, tooth.tissues};
  const AdjacentIds ids = ids_for(out.tooth, !sides.empty(), spec.gum);
  TissueGrid grid = grid_for(tooth, sides, spec.gum, where);
  std::vector<Vec3> contacts;
  for (const Side& s : sides) {
    lay_neighbour(grid, s, ids);
    contacts.push_back(s.facts.at_mm);
    (s.side > 0 ? out.mesial : out.distal) = s.facts;
    out.tooth.source.push_back(
        NeighbourSet{s.side > 0, s.name, s.side > 0 ? spec.mesial.turn_deg : spec.distal.turn_deg,
                     s.facts.gap_mm, s.facts.at_mm});
    if (!s.doubt.empty()) out.tooth.notes.push_back({ToothNote::Kind::warning, s.doubt});
  }
  if (spec.gum) {
    add_gum(grid, out.tooth.tissues, ids, marks, contacts, where);
    out.tooth.source.push_back(GumSet{});
  }
  mark_borders(grid, out.tooth.tissues);
  if (!sides.empty())
    out.tooth.name += sides.size() > 1 ? ", between its neighbours" : ", beside its neighbour";
  if (spec.gum) out.tooth.name += ", in gum";
  out.tooth.octree = Octree(grid, out.tooth.tissues);
  const auto counts = out.tooth.octree.count_leaves();
  for (const Tissue& t : out.tooth.tissues)
    (is_gum(t.name) ? out.gum_mm3 : out.neighbour_mm3) +=
        is_adjacent(t.name) ? static_cast<double>(counts[t.id]) * out.tooth.octree.leaf_volume_mm3()
                            : 0.0;
  return out;
}

}  // namespace cavum
