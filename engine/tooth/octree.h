// The tooth while it is drilled: an octree of tissue, editable in place. A branch ends in a uniform
// cube of one tissue or in a brick of 4x4x4 leaves; near the solid surface a brick also carries the
// signed distance to it, which is what the contact feels between leaves. Edits allocate nothing.
#pragma once

#include <array>
#include <bit>
#include <cstdint>
#include <cstring>
#include <span>
#include <vector>

#include "engine/base/bytes.h"
#include "engine/base/reserved_vector.h"
#include "engine/base/vec.h"
#include "engine/tooth/tissue_grid.h"

namespace cavum {

/// A leaf that a carve turned to air, and the tissue it was.
struct RemovedLeaf {
  std::int16_t x = 0, y = 0, z = 0;
  std::uint8_t tissue = k_air;
  std::uint8_t reserved = 0;
  [[nodiscard]] IVec3 leaf() const noexcept { return {x, y, z}; }
  friend bool operator==(const RemovedLeaf&, const RemovedLeaf&) = default;
};

/// Distance to the solid surface, mm (positive = outside), and its gradient (unit-free, about
/// length 1; zero where the distance is saturated).
struct SurfaceSample {
  double distance_mm = 0.0;
  Vec3 gradient;
};

/// Shares of the tissues around a place, as trilinear interpolation between leaf centres sees them;
/// they add up to 1. Continuous in the place, so that what is averaged with them is, too. A label
/// may appear more than once.
struct TissueMix {
  int count = 0;
  std::array<std::uint8_t, 8> label{};
  std::array<double, 8> share{};
};

class Octree {
 public:
  static constexpr int k_brick_edge = 4;
  static constexpr int k_brick_leaves = 64;
  static constexpr int k_max_edge_leaves = 1024;

  Octree() = default;
  /// Builds from a dense grid. Throws Error when the grid is empty or wider than 1024 leaves.
  Octree(const TissueGrid& grid, const std::vector<Tissue>& tissues);

  [[nodiscard]] double leaf_mm() const noexcept { return leaf_mm_; }
  [[nodiscard]] Vec3 origin_mm() const noexcept { return origin_mm_; }
  /// Leaves along x, y, z of the grid it was built from.
  [[nodiscard]] IVec3 size() const noexcept { return size_; }
  [[nodiscard]] double leaf_volume_mm3() const noexcept { return leaf_mm_ * leaf_mm_ * leaf_mm_; }
  [[nodiscard]] Vec3 centre_mm(IVec3 leaf) const noexcept {
    return origin_mm_ + Vec3{leaf.x + 0.5, leaf.y + 0.5, leaf.z + 0.5} * leaf_mm_;
  }
  /// The leaf that holds `mm`; may lie outside `size()`, where everything is air.
  [[nodiscard]] IVec3 leaf_at(Vec3 mm) const noexcept {
    constexpr double k_far = 1e6;  // leaves; NaN ends there too
    const auto down = [](double v) {
      return v > -k_far ? (v < k_far ? floor_of(v) : static_cast<std::int32_t>(k_far))
                        : -static_cast<std::int32_t>(k_far);
    };
    const Vec3 p = (mm - origin_mm_) * leaves_per_mm_;
    return {down(p.x), down(p.y), down(p.z)};
  }
  [[nodiscard]] bool is_solid(std::uint8_t tissue) const noexcept { return solid_[tissue]; }

  /// Tissue of a leaf; air outside.
  [[nodiscard]] std::uint8_t tissue(IVec3 leaf) const noexcept;
  [[nodiscard]] std::uint8_t tissue_at(Vec3 mm) const noexcept { return tissue(leaf_at(mm)); }
  /// Distance code of a leaf (see `encode_distance`); far outside the grid.
  [[nodiscard]] int distance_code(IVec3 leaf) const noexcept;

  /// Tissues and distance codes of a brick's leaves, x fastest.
  struct FullBrick {
    std::array<std::uint8_t, k_brick_leaves> tissue;
    std::array<std::int8_t, k_brick_leaves> distance;
  };
  /// `at` is the brick's lowest leaf over `k_brick_edge`; air outside.
  [[nodiscard]] FullBrick brick(IVec3 at) const noexcept { return expanded(find(at)); }

  /// Remembers where the last bricks were found. One per reader; renew nothing by hand.
  class Cursor {
   public:
    friend class Octree;

   private:
    struct Entry {
      std::uint32_t key = ~0u, ref = 0;
    };
    [[nodiscard]] static std::uint32_t key_of(IVec3 brick) noexcept {
      return static_cast<std::uint32_t>(brick.x | brick.y << 10 | brick.z << 20);
    }
    [[nodiscard]] static std::size_t place_of(IVec3 brick) noexcept {
      return static_cast<std::size_t>((brick.x & 15) | (brick.y & 15) << 4 | (brick.z & 15) << 8);
    }
    std::array<Entry, 4096>
        entries_{};  // a head at a leaf of 0.025 mm spans some ten bricks each way
    std::uint64_t version_ = ~0ULL;
  };
  /// Trilinear distance and gradient at `mm`.
  [[nodiscard]] SurfaceSample sample(Vec3 mm, Cursor& cursor) const noexcept;
  [[nodiscard]] std::uint8_t tissue_at(Vec3 mm, Cursor& cursor) const noexcept;
  /// The same as without a cursor, sooner for whoever asks for many leaves near one another.
  [[nodiscard]] std::uint8_t tissue(IVec3 leaf, Cursor& cursor) const noexcept {
    const auto row = labels_of(find({leaf.x >> 2, leaf.y >> 2, leaf.z >> 2}, cursor));
    return row.first[leaf_in_brick(leaf) & row.mask];
  }
  [[nodiscard]] int distance_code(IVec3 leaf, Cursor& cursor) const noexcept {
    const auto row = codes_of(find({leaf.x >> 2, leaf.y >> 2, leaf.z >> 2}, cursor));
    return row.first[leaf_in_brick(leaf) & row.mask];
  }
  [[nodiscard]] TissueMix mix(Vec3 mm, Cursor& cursor) const noexcept;
  /// True when no solid leaf and no distance below the band lies in the box `low`..`high` (mm). May
  /// say false for an empty box, never true for one that is not.
  [[nodiscard]] bool is_clear(Vec3 low_mm, Vec3 high_mm) const noexcept {
    return clear_in(root_, levels_, {0, 0, 0}, leaf_at(low_mm), leaf_at(high_mm), false);
  }
  /// The same for every tissue, pulp and other void ones too: nothing but air.
  [[nodiscard]] bool is_air(Vec3 low_mm, Vec3 high_mm) const noexcept {
    return clear_in(root_, levels_, {0, 0, 0}, leaf_at(low_mm), leaf_at(high_mm), true);
  }

  /// Room for `bricks` more bricks, so that carving needs no allocation; copies keep it. Untouched
  /// room costs no memory.
  void reserve_edits(std::size_t bricks);
  /// Removes what lies inside a shape: `shape(mm)` is its signed distance, mm, negative inside,
  /// never changing faster than 1 mm per mm. Only leaves in the box are looked at; the box must
  /// hold the shape and two leaves around it. Removed leaves are appended to `removed` up to its
  /// capacity, in a fixed order. The distance field is cut wider by `clearance_mm` than the labels:
  /// what interpolation between leaves rounds off would otherwise clamp a tool in the very hole it
  /// has cut. `shape.unchanged(centre, radius)` may say true for a ball (mm) in which an earlier
  /// carve did all of it already, `shape.brick(low_mm)` may answer for a whole brick: see
  /// KnowsBricks. Returns false, and leaves the rest untouched, when the reserved room or `removed`
  /// is full.
  template <class Shape>
  bool carve(Vec3 low_mm, Vec3 high_mm, const Shape& shape, std::vector<RemovedLeaf>& removed,
             double clearance_mm = 0.0);

  class Plan;
  /// The same in two halves, for one tick may be too short for a carve: `plan` works out what
  /// bricks will hold, as far as `work` (about 15 ns a unit) and the plan's room reach, and goes on
  /// from there when called again; true when it has seen the whole box. Nothing but `apply` may
  /// edit the tooth in between.
  template <class Shape>
  bool plan(Vec3 low_mm, Vec3 high_mm, const Shape& shape, double clearance_mm, int work,
            Plan& plan) const noexcept;
  /// Puts planned bricks into the tree and empties the plan, which then stands where planning
  /// stopped. False, and the rest is lost, without room.
  bool apply(Plan& plan, std::vector<RemovedLeaf>& removed) noexcept;
  /// Changes with every edit, and is equal after equal edits of equal teeth.
  [[nodiscard]] std::uint64_t edit_hash() const noexcept { return edit_hash_; }
  /// `edit_hash` as it was after the last edit in a block of 16x16x16 leaves (its lowest leaf over
  /// 16): whoever keeps these numbers knows which blocks changed since.
  static constexpr int k_mark_edge = 16;
  [[nodiscard]] std::uint64_t last_edit(IVec3 block) const noexcept {
    return marks_.empty() ? edit_hash_
                          : marks_[mark_of({block.x * k_mark_edge, block.y * k_mark_edge,
                                            block.z * k_mark_edge})];
  }

  /// Leaves of each tissue (index = id); air is not counted.
  [[nodiscard]] std::array<std::uint64_t, 256> count_leaves() const;
  /// Calls `visit(low_leaf, edge, tissue)` for every uniform cube (edge 1 for single leaves), air
  /// left out.
  template <class Visit>
  void for_each_cube(const Visit& visit) const;
  /// Around the leaves whose tissue counts: the first of them, and beyond the last.
  template <class Counts>
  [[nodiscard]] LeafBounds bounds(const Counts& counts) const {
    LeafBounds box;
    for_each_cube([&](IVec3 at, int edge, std::uint8_t tissue) {
      if (counts(tissue)) box.add(at, at + IVec3{edge, edge, edge});
    });
    return box;
  }
  [[nodiscard]] TissueGrid to_grid() const;
  /// The same lattice, all of it air.
  [[nodiscard]] Octree emptied() const;
  /// A copy in which the leaves from `low` on are those of `part` (its lattice, leaf and origin are
  /// not looked at). Throws Error unless low and size are whole bricks within the tree.
  [[nodiscard]] Octree with_leaves(IVec3 low, const TissueGrid& part) const;
  /// Bytes in use (nodes, bricks), without spare room.
  [[nodiscard]] std::size_t memory_bytes() const noexcept;

  /// Canonical bytes: the same leaves give the same bytes. Used by the tooth file, and hashed as
  /// `hash`.
  void write(ByteWriter& out) const;
  /// Reads what `write` wrote. Throws Error on damaged data.
  [[nodiscard]] static Octree read(ByteReader& in, const std::vector<Tissue>& tissues);

 private:
  // A reference: two bits of kind above thirty bits of tissue or pool index.
  static constexpr std::uint32_t k_uniform = 0u << 30, k_node = 1u << 30, k_label_brick = 2u << 30,
                                 k_full_brick = 3u << 30;
  static constexpr std::uint32_t k_kind = 3u << 30, k_index = ~k_kind;
  struct Node {
    std::array<std::uint32_t, 8> child{};
  };
  struct LabelBrick {
    std::array<std::uint8_t, k_brick_leaves> tissue;
  };
  /// Pool with a free list; `items` never grows past its capacity during edits.
  template <class T>
  struct Pool {
    ReservedVector<T> items;
    ReservedVector<std::uint32_t> free;
    [[nodiscard]] bool full() const noexcept {
      return free.empty() && items.size() == items.capacity();
    }
    [[nodiscard]] std::size_t used() const noexcept { return items.size() - free.size(); }
    std::uint32_t add(const T& item) {
      if (!free.empty()) {
        const auto i = free.back();
        free.pop_back();
        items[i] = item;
        return i;
      }
      items.push_back(item);
      return static_cast<std::uint32_t>(items.size() - 1);
    }
    void release(std::uint32_t i) { free.push_back(i); }
    void reserve(std::size_t more) {
      items.reserve(items.size() + more);
      free.reserve(items.capacity());
    }
  };
  struct Planning;  // what goes down the tree with a plan

  [[nodiscard]] static constexpr int leaf_in_brick(IVec3 l) noexcept {
    return (l.x & 3) | (l.y & 3) << 2 | (l.z & 3) << 4;
  }
  /// Low leaf of the i-th child of a cube, whose children have `edge` leaves.
  [[nodiscard]] static constexpr IVec3 low_of_child(IVec3 low, std::uint32_t i, int edge) noexcept {
    return low + IVec3{static_cast<int>(i & 1) * edge, static_cast<int>(i >> 1 & 1) * edge,
                       static_cast<int>(i >> 2) * edge};
  }
  // A brick as eight blocks of 2x2x2 leaves: the first leaf of a block, and its leaves from there.
  [[nodiscard]] static constexpr int first_of_block(int block) noexcept {
    return (block & 1) * 2 + (block >> 1 & 1) * 8 + (block >> 2) * 32;
  }
  static constexpr std::array<int, 8> k_leaf_of_block{0, 1, 4, 5, 16, 17, 20, 21};
  /// The bytes of a block's eight leaves, the first in the lowest byte; leaves lie in pairs along
  /// x.
  [[nodiscard]] static std::uint64_t bytes_of_block(const void* leaves, int block) noexcept {
    const auto* first = static_cast<const unsigned char*>(leaves) + first_of_block(block);
    std::uint16_t a, b, c, d;
    std::memcpy(&a, first, 2);
    std::memcpy(&b, first + 4, 2);
    std::memcpy(&c, first + 16, 2);
    std::memcpy(&d, first + 20, 2);
    return static_cast<std::uint64_t>(a | static_cast<std::uint32_t>(b) << 16) |
           static_cast<std::uint64_t>(c | static_cast<std::uint32_t>(d) << 16) << 32;
  }
  static void put_bytes_of_block(void* leaves, int block, std::uint64_t bytes) noexcept {
    auto* first = static_cast<unsigned char*>(leaves) + first_of_block(block);
    const std::uint64_t b = bytes >> 16, c = bytes >> 32, d = bytes >> 48;
    std::memcpy(first, &bytes, 2);
    std::memcpy(first + 4, &b, 2);
    std::memcpy(first + 16, &c, 2);
    std::memcpy(first + 20, &d, 2);
  }
  static_assert(std::endian::native == std::endian::little);
  static constexpr std::uint64_t k_each_byte = 0x0101010101010101u;
  [[nodiscard]] static bool is_empty_block(const FullBrick& brick, int block) noexcept {
    return bytes_of_block(brick.distance.data(), block) == k_each_byte * k_distance_far &&
           bytes_of_block(brick.tissue.data(), block) == k_each_byte * k_air;
  }
  [[nodiscard]] int uniform_code(std::uint8_t tissue) const noexcept {
    return solid_[tissue] ? -k_distance_far : k_distance_far;
  }
  /// The eight leaves whose centres surround a place: bit 0, 1, 2 of a corner's number = along x,
  /// y, z.
  struct Cell {
    IVec3 low;          // leaf of the first corner
    double fx, fy, fz;  // place between the corners, 0..1
  };
  /// What a brick says of its leaves: `first[leaf & mask]`. A uniform one has a single entry.
  template <class T>
  struct Row {
    const T* first;
    std::int32_t mask;
  };
  [[nodiscard]] Row<std::int8_t> codes_of(std::uint32_t ref) const noexcept {
    static constexpr std::int8_t k_outside = k_distance_far, k_inside = -k_distance_far;
    const std::uint32_t at = ref & k_index, kind = ref & k_kind;
    if (kind == k_full_brick) return {bricks_.items[at].distance.data(), k_brick_leaves - 1};
    return {solid_[kind == k_label_brick ? labels_.items[at].tissue[0] : at & 255u] ? &k_inside
                                                                                    : &k_outside,
            0};  // one without distances has no border
  }
  [[nodiscard]] Row<std::uint8_t> labels_of(std::uint32_t ref) const noexcept {
    const std::uint32_t at = ref & k_index, kind = ref & k_kind;
    if (kind == k_full_brick) return {bricks_.items[at].tissue.data(), k_brick_leaves - 1};
    if (kind == k_label_brick) return {labels_.items[at].tissue.data(), k_brick_leaves - 1};
    return {&k_labels[at & 255u], 0};
  }
  static constexpr std::array<std::uint8_t, 256> k_labels = [] {
    std::array<std::uint8_t, 256> all{};
    for (std::size_t i = 0; i < all.size(); ++i) all[i] = static_cast<std::uint8_t>(i);
    return all;
  }();
  /// False far outside of any tooth.
  [[nodiscard]] bool cell_around(Vec3 mm, Cell& cell) const noexcept;
  /// What the eight leaves from `low` on hold, x fastest; `row_of(ref)` tells what a brick says.
  template <class T, class RowOf>
  void read_cell(IVec3 low, Cursor& cursor, const RowOf& row_of, T* out) const noexcept;
  [[nodiscard]] static std::int32_t floor_of(double v) noexcept {
    const auto i = static_cast<std::int32_t>(v);
    return i - (v < i ? 1 : 0);
  }
  [[nodiscard]] std::uint32_t find(IVec3 brick) const noexcept;
  [[nodiscard]] std::uint32_t find(IVec3 brick, Cursor& cursor) const noexcept {
    if (((brick.x | brick.y | brick.z) >> levels_) != 0)
      return k_uniform | k_air;  // also catches negatives
    const auto& e = cursor.entries_[Cursor::place_of(brick)];
    return cursor.version_ == version_ && e.key == Cursor::key_of(brick)
               ? e.ref
               : find_again(brick, cursor);
  }
  [[nodiscard]] std::uint32_t find_again(IVec3 brick, Cursor& cursor) const noexcept;
  [[nodiscard]] int code_in(std::uint32_t ref, int leaf) const noexcept;
  [[nodiscard]] FullBrick expanded(std::uint32_t ref) const noexcept;
  [[nodiscard]] std::uint8_t tissue_in(std::uint32_t ref, int leaf) const noexcept;
  std::uint32_t build(const TissueGrid& grid, IVec3 low, int level);
  /// What `ref` becomes when the leaves from `first` on are those of `part`.
  [[nodiscard]] std::uint32_t replaced(std::uint32_t ref, int level, IVec3 low, IVec3 first,
                                       const TissueGrid& part);
  [[nodiscard]] bool clear_in(std::uint32_t ref, int level, IVec3 low, IVec3 box_low,
                              IVec3 box_high, bool air_only) const noexcept;
  template <class Visit>
  void visit_cubes(std::uint32_t ref, int level, IVec3 low, const Visit& visit) const;
  template <class Shape>
  void plan_in(std::uint32_t ref, int level, IVec3 low, std::uint32_t place, const Shape& shape,
               Planning& planning) const noexcept;
  template <class Shape, class Brick>
  bool cut_brick(const Brick& in_shape, unsigned near, Planning& planning,
                 FullBrick& brick) const noexcept;
  /// A number for each leaf of a block: a vector type, of which every compiler and machine makes
  /// the same.
  using EightCodes = std::int16_t __attribute__((vector_size(16)));
  [[nodiscard]] static EightCodes eight_of(const std::int16_t* numbers) noexcept {
    EightCodes eight;
    std::memcpy(&eight, numbers, sizeof eight);
    return eight;
  }
  [[nodiscard]] static bool any_of(EightCodes marks) noexcept;
  /// Cuts a block with the shape's distance codes; `inside` is -1 for leaves in the shape and else
  /// 0, `solid_most` the largest code of a solid leaf.
  bool cut_block(FullBrick& brick, int block, EightCodes cut, EightCodes inside,
                 std::int16_t solid_most) const noexcept;
  void apply_in(std::uint32_t& ref, int level, IVec3 low, std::uint32_t place, Plan& plan,
                std::vector<RemovedLeaf>& removed) noexcept;
  void store_brick(std::uint32_t& ref, IVec3 low, const FullBrick& brick,
                   std::vector<RemovedLeaf>& removed) noexcept;
  void write_ref(std::uint32_t ref, ByteWriter& shape, ByteWriter& tissue,
                 ByteWriter& distance) const;
  std::uint32_t read_ref(ByteReader& shape, ByteReader& tissue, ByteReader& distance, int level);
  [[nodiscard]] std::uint32_t canonical(const FullBrick& brick);
  [[nodiscard]] IVec3 clamp_to_tree(Vec3 mm) const noexcept;
  /// Place in `marks_` of the block that holds a leaf; leaves beyond `size_` count with the
  /// nearest.
  [[nodiscard]] std::size_t mark_of(IVec3 leaf) const noexcept {
    const auto block = [](int at, int size) {
      return static_cast<std::size_t>(std::clamp(at, 0, size - 1) / k_mark_edge);
    };
    const auto blocks = [](int size) {
      return static_cast<std::size_t>((size + k_mark_edge - 1) / k_mark_edge);
    };
    return (block(leaf.z, size_.z) * blocks(size_.y) + block(leaf.y, size_.y)) * blocks(size_.x) +
           block(leaf.x, size_.x);
  }

  double leaf_mm_ = 0.05, leaves_per_mm_ = 20.0;
  Vec3 origin_mm_;
  IVec3 size_;
  int levels_ = 0;  // a root of 4·2^levels leaves
  std::array<bool, 256> solid_{};
  std::uint32_t root_ = k_uniform | k_air;
  Pool<Node> nodes_;
  Pool<LabelBrick> labels_;
  Pool<FullBrick> bricks_;
  std::uint64_t edit_hash_ = 0;
  std::vector<std::uint64_t> marks_;  // of last_edit; there once edits are reserved
  std::uint64_t version_ = 0;         // of the structure; tells cursors to look again
};

/// A carve worked out in part or in whole, and not yet made.
class Octree::Plan {
 public:
  Plan() { bricks_.reserve(k_room); }
  /// Begins another carve.
  void clear() noexcept {
    bricks_.clear();
    next_ = 0;
  }
  [[nodiscard]] bool full() const noexcept { return bricks_.size() == bricks_.capacity(); }
  /// Equal when equally much of the same carve is done.
  [[nodiscard]] std::uint64_t progress() const noexcept {
    return static_cast<std::uint64_t>(next_) << 32 | bricks_.size();
  }

 private:
  friend class Octree;
  static constexpr std::size_t k_room = 512;
  /// The place of a brick in the order of the tree: the bits of x, y and z in turn.
  struct Brick {
    std::uint32_t place = 0;
    FullBrick content;
  };
  ReservedVector<Brick> bricks_;
  std::uint32_t next_ = 0;   // all places before it are planned
  std::size_t applied_ = 0;  // of `bricks_`, while they are put into the tree
  bool out_of_room_ = false;
};

}  // namespace cavum
