#include "engine/tooth/octree.h"

#include <algorithm>
#include <cmath>
#include <string>

#include "engine/base/error.h"
#include "engine/tooth/octree_edit.h"

namespace cavum {

Octree::Octree(const TissueGrid& grid, const std::vector<Tissue>& tissues)
    : leaf_mm_(grid.leaf_mm),
      leaves_per_mm_(1.0 / grid.leaf_mm),
      origin_mm_(grid.origin_mm),
      size_(grid.size) {
  const int widest = std::max({grid.size.x, grid.size.y, grid.size.z});
  const int thinnest = std::min({grid.size.x, grid.size.y, grid.size.z});
  if (thinnest < 1 || grid.tissue.size() != grid.count() || grid.distance.size() != grid.count() ||
      !(grid.leaf_mm > 0))
    throw Error(msg("tooth"), msg("the tissue grid is empty"),
                msg("check size and leaf of the input"));
  if (widest > k_max_edge_leaves)
    throw Error(msg("tooth"), msg("{} leaves along one edge, 1024 is the most", widest),
                msg("use a larger leaf"));
  for (const auto& t : tissues) solid_[t.id] = t.solid;
  while ((k_brick_edge << levels_) < widest) ++levels_;
  root_ = build(grid, {0, 0, 0}, levels_);
  nodes_.items.shrink_to_fit();
  labels_.items.shrink_to_fit();
  bricks_.items.shrink_to_fit();
}

std::uint32_t Octree::canonical(const FullBrick& brick) {
  unsigned near =
      0;  // in a form that compilers turn into vectors: a carve asks this of hundreds of bricks
  for (const int code : brick.distance)
    near |= static_cast<unsigned>(code != k_distance_far) &
            static_cast<unsigned>(code != -k_distance_far);
  if (near != 0) return k_full_brick | bricks_.add(brick);
  bool one_tissue = true, far = true;
  for (std::size_t i = 0; i < k_brick_leaves; ++i) {
    one_tissue = one_tissue && brick.tissue[i] == brick.tissue[0];
    far = far && brick.distance[i] == uniform_code(brick.tissue[i]);
  }
  if (far && one_tissue) return k_uniform | brick.tissue[0];
  if (far) return k_label_brick | labels_.add({brick.tissue});
  return k_full_brick | bricks_.add(brick);
}

std::uint32_t Octree::build(const TissueGrid& grid, IVec3 low, int level) {
  if (low.x >= grid.size.x || low.y >= grid.size.y || low.z >= grid.size.z)
    return k_uniform | k_air;
  if (level == 0) {
    FullBrick brick;
    std::size_t i = 0;
    for (int z = 0; z < 4; ++z)
      for (int y = 0; y < 4; ++y)
        for (int x = 0; x < 4; ++x, ++i) {
          const IVec3 leaf = low + IVec3{x, y, z};
          const bool in = grid.inside(leaf);
          brick.tissue[i] = in ? grid.tissue[grid.index(leaf)] : std::uint8_t{k_air};
          brick.distance[i] = in ? grid.distance[grid.index(leaf)] : std::int8_t{k_distance_far};
        }
    return canonical(brick);
  }
  Node node;
  const int half = (k_brick_edge << level) / 2;
  bool equal = true;
  for (int i = 0; i < 8; ++i) {
    const auto c =
        build(grid, low + IVec3{(i & 1) * half, (i >> 1 & 1) * half, (i >> 2) * half}, level - 1);
    node.child[static_cast<std::size_t>(i)] = c;
    equal = equal && (c & k_kind) == k_uniform && c == node.child[0];
  }
  return equal ? node.child[0] : k_node | nodes_.add(node);
}

IVec3 Octree::clamp_to_tree(Vec3 mm) const noexcept {
  const IVec3 l = leaf_at(mm);
  const int last = (k_brick_edge << levels_) - 1;
  return {std::clamp(l.x, -1, last + 1), std::clamp(l.y, -1, last + 1),
          std::clamp(l.z, -1, last + 1)};
}

std::uint32_t Octree::find(IVec3 brick) const noexcept {
  if (((brick.x | brick.y | brick.z) >> levels_) != 0)
    return k_uniform | k_air;  // also catches negatives
  std::uint32_t ref = root_;
  for (int l = levels_ - 1; l >= 0 && (ref & k_kind) == k_node; --l)
    ref = nodes_.items[ref & k_index].child[static_cast<std::size_t>(
        (brick.x >> l & 1) | (brick.y >> l & 1) << 1 | (brick.z >> l & 1) << 2)];
  return ref;
}

std::uint32_t Octree::find_again(IVec3 brick, Cursor& cursor) const noexcept {
  if (cursor.version_ != version_) {
    cursor.entries_.fill({});
    cursor.version_ = version_;
  }
  const std::uint32_t ref = find(brick);
  cursor.entries_[Cursor::place_of(brick)] = {Cursor::key_of(brick), ref};
  return ref;
}

int Octree::code_in(std::uint32_t ref, int leaf) const noexcept {
  const auto i = static_cast<std::size_t>(leaf);
  switch (ref & k_kind) {
    case k_full_brick:
      return bricks_.items[ref & k_index].distance[i];
    case k_label_brick:
      return uniform_code(labels_.items[ref & k_index].tissue[i]);
    default:
      return uniform_code(static_cast<std::uint8_t>(ref & k_index));
  }
}

std::uint8_t Octree::tissue_in(std::uint32_t ref, int leaf) const noexcept {
  const auto i = static_cast<std::size_t>(leaf);
  switch (ref & k_kind) {
    case k_full_brick:
      return bricks_.items[ref & k_index].tissue[i];
    case k_label_brick:
      return labels_.items[ref & k_index].tissue[i];
    default:
      return static_cast<std::uint8_t>(ref & k_index);
  }
}

Octree::FullBrick Octree::expanded(std::uint32_t ref) const noexcept {
  if ((ref & k_kind) == k_full_brick) return bricks_.items[ref & k_index];
  FullBrick brick;
  if ((ref & k_kind) == k_label_brick)
    brick.tissue = labels_.items[ref & k_index].tissue;
  else
    brick.tissue.fill(static_cast<std::uint8_t>(ref & k_index));
  brick.distance.fill(static_cast<std::int8_t>(
      uniform_code(brick.tissue[0])));  // without distances all leaves are solid, or none is
  return brick;
}

std::uint8_t Octree::tissue(IVec3 leaf) const noexcept {
  return tissue_in(find({leaf.x >> 2, leaf.y >> 2, leaf.z >> 2}), leaf_in_brick(leaf));
}

int Octree::distance_code(IVec3 leaf) const noexcept {
  return code_in(find({leaf.x >> 2, leaf.y >> 2, leaf.z >> 2}), leaf_in_brick(leaf));
}

std::uint8_t Octree::tissue_at(Vec3 mm, Cursor& cursor) const noexcept {
  const IVec3 leaf = leaf_at(mm);
  return tissue_in(find({leaf.x >> 2, leaf.y >> 2, leaf.z >> 2}, cursor), leaf_in_brick(leaf));
}

inline bool Octree::cell_around(Vec3 mm, Cell& cell) const noexcept {
  const Vec3 p = (mm - origin_mm_) * leaves_per_mm_ - Vec3{0.5, 0.5, 0.5};
  if (!(std::fabs(p.x) < 1e6 && std::fabs(p.y) < 1e6 && std::fabs(p.z) < 1e6)) return false;
  cell.low = {floor_of(p.x), floor_of(p.y), floor_of(p.z)};
  cell.fx = p.x - cell.low.x;
  cell.fy = p.y - cell.low.y;
  cell.fz = p.z - cell.low.z;
  return true;
}

template <class T, class RowOf>
inline void Octree::read_cell(IVec3 low, Cursor& cursor, const RowOf& row_of,
                              T* out) const noexcept {
  const IVec3 brick{low.x >> 2, low.y >> 2, low.z >> 2};
  const unsigned crossing =
      ((low.x & 3) == 3 ? 1u : 0u) | ((low.y & 3) == 3 ? 2u : 0u) | ((low.z & 3) == 3 ? 4u : 0u);
  const auto row = row_of(find(brick, cursor));
  const int first = leaf_in_brick(low);
  if (crossing == 0) {
    for (std::size_t i = 0; i < 8; ++i) out[i] = row.first[(first + k_leaf_of_block[i]) & row.mask];
    return;
  }
  std::array<decltype(row_of(0u)), 8> rows;  // by the corner's bits that cross
  rows[0] = row;
  for (unsigned i = 1; i <= crossing; ++i)
    if ((i & ~crossing) == 0)
      rows[i] = row_of(find(brick + IVec3{static_cast<int>(i & 1), static_cast<int>(i >> 1 & 1),
                                          static_cast<int>(i >> 2)},
                            cursor));
  const int x[2]{low.x & 3, (low.x + 1) & 3}, y[2]{(low.y & 3) << 2, ((low.y + 1) & 3) << 2},
      z[2]{(low.z & 3) << 4, ((low.z + 1) & 3) << 4};
  for (unsigned i = 0; i < 8; ++i) {
    const auto& r = rows[i & crossing];
    out[i] = r.first[(x[i & 1] | y[i >> 1 & 1] | z[i >> 2]) & r.mask];
  }
}

SurfaceSample Octree::sample(Vec3 mm, Cursor& cursor) const noexcept {
  Cell cell;
  if (!cell_around(mm, cell)) return {k_distance_band_leaves * leaf_mm_, {}};
  int c[8];
  read_cell(
      cell.low, cursor, [this](std::uint32_t ref) { return codes_of(ref); }, c);
  const double fx = cell.fx, fy = cell.fy, fz = cell.fz, gx = 1 - fx, gy = 1 - fy, gz = 1 - fz;
  // along x first, then y, then z; the gradient falls out of the same differences
  const double e00 = c[0] * gx + c[1] * fx, e10 = c[2] * gx + c[3] * fx,
               e01 = c[4] * gx + c[5] * fx, e11 = c[6] * gx + c[7] * fx;
  const double f0 = e00 * gy + e10 * fy, f1 = e01 * gy + e11 * fy;
  const double dx = ((c[1] - c[0]) * gy + (c[3] - c[2]) * fy) * gz +
                    ((c[5] - c[4]) * gy + (c[7] - c[6]) * fy) * fz;
  const double dy = (e10 - e00) * gz + (e11 - e01) * fz;
  const double leaves = k_distance_band_leaves / k_distance_far;
  return {(f0 * gz + f1 * fz) * leaves * leaf_mm_, Vec3{dx, dy, f1 - f0} * leaves};
}

TissueMix Octree::mix(Vec3 mm, Cursor& cursor) const noexcept {
  TissueMix mix{1, {k_air}, {1.0}};
  Cell cell;
  if (!cell_around(mm, cell)) return mix;
  read_cell(
      cell.low, cursor, [this](std::uint32_t ref) { return labels_of(ref); }, mix.label.data());
  if (std::bit_cast<std::uint64_t>(mix.label) == k_each_byte * mix.label[0]) return mix;
  mix.count = 8;
  for (std::size_t i = 0; i < 8; ++i)
    mix.share[i] = ((i & 1) != 0 ? cell.fx : 1 - cell.fx) * ((i & 2) != 0 ? cell.fy : 1 - cell.fy) *
                   ((i & 4) != 0 ? cell.fz : 1 - cell.fz);
  return mix;
}

bool Octree::clear_in(std::uint32_t ref, int level, IVec3 low, IVec3 box_low, IVec3 box_high,
                      bool air_only) const noexcept {
  const int edge = k_brick_edge << level;
  if (low.x > box_high.x || low.y > box_high.y || low.z > box_high.z) return true;
  if (low.x + edge <= box_low.x || low.y + edge <= box_low.y || low.z + edge <= box_low.z)
    return true;
  switch (ref & k_kind) {
    case k_uniform:
      return (ref & k_index) == k_air || (!air_only && !solid_[ref & k_index]);
    case k_node: {
      const int half = edge / 2;
      for (int i = 0; i < 8; ++i)
        if (!clear_in(nodes_.items[ref & k_index].child[static_cast<std::size_t>(i)], level - 1,
                      low + IVec3{(i & 1) * half, (i >> 1 & 1) * half, (i >> 2) * half}, box_low,
                      box_high, air_only))
          return false;
      return true;
    }
    case k_label_brick:
      return !air_only && !solid_[labels_.items[ref & k_index].tissue[0]];  // never mixed: a border
                                                                            // would carry distances
    default:
      return false;
  }
}

std::array<std::uint64_t, 256> Octree::count_leaves() const {
  std::array<std::uint64_t, 256> count{};
  for_each_cube([&](IVec3, int edge, std::uint8_t t) {
    count[t] += static_cast<std::uint64_t>(edge) * static_cast<std::uint64_t>(edge) *
                static_cast<std::uint64_t>(edge);
  });
  return count;
}

TissueGrid Octree::to_grid() const {
  TissueGrid grid;
  grid.allocate(size_, leaf_mm_, origin_mm_);
  for (int bz = 0; bz < size_.z; bz += 4)
    for (int by = 0; by < size_.y; by += 4)
      for (int bx = 0; bx < size_.x; bx += 4) {
        const auto ref = find({bx >> 2, by >> 2, bz >> 2});
        if (ref == (k_uniform | k_air)) continue;
        for (int i = 0; i < k_brick_leaves; ++i) {
          const IVec3 leaf{bx + (i & 3), by + (i >> 2 & 3), bz + (i >> 4)};
          if (!grid.inside(leaf)) continue;
          grid.tissue[grid.index(leaf)] = tissue_in(ref, i);
          grid.distance[grid.index(leaf)] = static_cast<std::int8_t>(code_in(ref, i));
        }
      }
  return grid;
}

Octree Octree::emptied() const {
  Octree empty;
  empty.leaf_mm_ = leaf_mm_;
  empty.leaves_per_mm_ = leaves_per_mm_;
  empty.origin_mm_ = origin_mm_;
  empty.size_ = size_;
  empty.levels_ = levels_;
  empty.solid_ = solid_;
  return empty;
}

Octree Octree::with_leaves(IVec3 low, const TissueGrid& part) const {
  const int edge = k_brick_edge << levels_;
  const auto whole = [&](int from, int n) {
    return from >= 0 && n > 0 && from % k_brick_edge == 0 && n % k_brick_edge == 0 &&
           from + n <= edge;
  };
  if (!whole(low.x, part.size.x) || !whole(low.y, part.size.y) || !whole(low.z, part.size.z) ||
      part.tissue.size() != part.count() || part.distance.size() != part.count())
    throw Error(msg("tooth"), msg("the part to be replaced is not of whole bricks"),
                msg("report it with the tooth"));
  Octree copy = *this;
  copy.root_ = copy.replaced(root_, levels_, {0, 0, 0}, low, part);
  ++copy.version_;
  return copy;
}

std::uint32_t Octree::replaced(std::uint32_t ref, int level, IVec3 low, IVec3 first,
                               const TissueGrid& part) {
  const int edge = k_brick_edge << level;
  const IVec3 end = first + part.size;
  if (low.x >= end.x || low.y >= end.y || low.z >= end.z || low.x + edge <= first.x ||
      low.y + edge <= first.y || low.z + edge <= first.z)
    return ref;
  if (level == 0) {
    if ((ref & k_kind) == k_full_brick) bricks_.release(ref & k_index);
    if ((ref & k_kind) == k_label_brick) labels_.release(ref & k_index);
    FullBrick brick;
    for (int i = 0; i < k_brick_leaves; ++i) {
      const std::size_t at = part.index(low - first + IVec3{i & 3, i >> 2 & 3, i >> 4});
      brick.tissue[static_cast<std::size_t>(i)] = part.tissue[at];
      brick.distance[static_cast<std::size_t>(i)] = part.distance[at];
    }
    return canonical(brick);
  }
  Node node;
  const bool split = (ref & k_kind) == k_uniform;
  if (split)
    node.child.fill(ref);
  else
    node = nodes_.items[ref & k_index];
  bool equal = true;
  for (std::uint32_t i = 0; i < 8; ++i) {
    node.child[i] = replaced(node.child[i], level - 1, low_of_child(low, i, edge / 2), first, part);
    equal = equal && (node.child[i] & k_kind) == k_uniform && node.child[i] == node.child[0];
  }
  if (!split) nodes_.release(ref & k_index);
  return equal ? node.child[0] : k_node | nodes_.add(node);
}

std::size_t Octree::memory_bytes() const noexcept {
  return nodes_.used() * sizeof(Node) + labels_.used() * sizeof(LabelBrick) +
         bricks_.used() * sizeof(FullBrick) + marks_.size() * sizeof(marks_[0]);
}

void Octree::write(ByteWriter& out) const {
  out.put(leaf_mm_);
  for (const double v : {origin_mm_.x, origin_mm_.y, origin_mm_.z}) out.put(v);
  for (const std::int32_t v : {size_.x, size_.y, size_.z}) out.put(v);
  ByteWriter shape, tissue, distance;
  write_ref(root_, shape, tissue, distance);
  for (const auto* part : {&shape, &tissue, &distance}) {
    out.put(static_cast<std::uint64_t>(part->bytes().size()));
    out.put_bytes(part->bytes());
  }
}

void Octree::write_ref(std::uint32_t ref, ByteWriter& shape, ByteWriter& tissue,
                       ByteWriter& distance) const {
  shape.put(static_cast<std::uint8_t>(ref >> 30));
  switch (ref & k_kind) {
    case k_uniform:
      shape.put(static_cast<std::uint8_t>(ref & k_index));
      break;
    case k_node:
      for (const auto c : nodes_.items[ref & k_index].child) write_ref(c, shape, tissue, distance);
      break;
    case k_label_brick:
      tissue.put_bytes(labels_.items[ref & k_index].tissue);
      break;
    default: {
      const auto& b = bricks_.items[ref & k_index];
      tissue.put_bytes(b.tissue);
      int before = 0;
      for (const int d : b.distance) {  // differences along x compress better
        distance.put(static_cast<std::uint8_t>(d - before));
        before = d;
      }
    }
  }
}

// As many as a packed tooth file may have: six molars at a leaf of 0.05 mm.
constexpr std::size_t k_max_bricks_read = 1u << 18;

Octree Octree::read(ByteReader& in, const std::vector<Tissue>& tissues) {
  Octree tree;
  tree.leaf_mm_ = in.get<double>();
  tree.leaves_per_mm_ = 1.0 / tree.leaf_mm_;
  tree.origin_mm_ = {in.get<double>(), in.get<double>(), in.get<double>()};
  tree.size_ = {in.get<std::int32_t>(), in.get<std::int32_t>(), in.get<std::int32_t>()};
  constexpr double k_largest_box_mm = 60.0;  // no tooth is half as long
  const auto usable = [&](int n) {
    return n >= 1 && n <= k_max_edge_leaves && n * tree.leaf_mm_ <= k_largest_box_mm;
  };
  constexpr double k_min_leaf_mm = 0.005, k_largest_leaf_mm = 2.0;
  if (!(tree.leaf_mm_ >= k_min_leaf_mm && tree.leaf_mm_ <= k_largest_leaf_mm) ||
      !is_finite(tree.origin_mm_) || !usable(tree.size_.x) || !usable(tree.size_.y) ||
      !usable(tree.size_.z))
    in.fail(msg(
        "impossible leaf or size: leaves have 0.005 to 2 mm, and a tooth's box at most 60 mm and {} leaves a side",
        k_max_edge_leaves));
  for (const auto& t : tissues) tree.solid_[t.id] = t.solid;
  while ((k_brick_edge << tree.levels_) < std::max({tree.size_.x, tree.size_.y, tree.size_.z}))
    ++tree.levels_;
  const auto part = [&in] {
    return ByteReader(in.get_bytes(in.get<std::uint64_t>()), msg("tooth"));
  };
  ByteReader shape = part(), tissue = part(), distance = part();
  tree.root_ = tree.read_ref(shape, tissue, distance, tree.levels_);
  if (shape.left() + tissue.left() + distance.left() != 0)
    in.fail(msg("data after the end of the octree"));
  return tree;
}

std::uint32_t Octree::read_ref(ByteReader& shape, ByteReader& tissue, ByteReader& distance,
                               int level) {
  const auto kind = static_cast<std::uint32_t>(shape.get<std::uint8_t>()) << 30;
  if (kind == k_uniform) return k_uniform | shape.get<std::uint8_t>();
  if (kind == k_node) {
    if (level == 0) shape.fail(msg("the octree is too deep"));
    Node node;
    for (auto& c : node.child) c = read_ref(shape, tissue, distance, level - 1);
    return k_node | nodes_.add(node);
  }
  if (level != 0) shape.fail(msg("a brick in the wrong place"));
  if (labels_.items.size() + bricks_.items.size() >= k_max_bricks_read)
    shape.fail(msg("has more bricks than the limit of {}", k_max_bricks_read));
  FullBrick brick;
  const auto labels = tissue.get_bytes(k_brick_leaves);
  std::copy(labels.begin(), labels.end(), brick.tissue.begin());
  if (kind == k_label_brick) return k_label_brick | labels_.add({brick.tissue});
  const auto deltas = distance.get_bytes(k_brick_leaves);
  std::uint8_t d = 0;
  for (std::size_t i = 0; i < k_brick_leaves; ++i) {
    d = static_cast<std::uint8_t>(d + deltas[i]);
    brick.distance[i] = static_cast<std::int8_t>(d);
  }
  return k_full_brick | bricks_.add(brick);
}

}  // namespace cavum
