// Packed octree, little-endian:
//   leaf f64, origin 3 f64, size 3 i32   as in Octree::write
//   u32 bricks, u32 full bricks          (a full brick has distances beside its labels)
//   u64 size, range coded bits           of that size, see engine/base/range_coder.h
//   u64                                  fast_hash of the canonical bytes, seed 0
// The bits are, in this order, each in a context of its own (the functions below say which):
//   cells       from the root, children x fastest: uniform or not; a uniform cell's tissue; at
//   brick level, full or not labels      brick after brick: is it this of the tissues around, or
//   the next one? If none of them, the byte distances   in seven layers by the nearest leaf of the
//   other kind (solid or not), so that the surface itself comes first and is
//               known on both sides when the leaves farther off follow: code minus what
//               `fit_surface` expects
#include "engine/tooth/packed_octree.h"

#include <algorithm>
#include <bit>
#include <optional>
#include <utility>

#include "engine/base/error.h"
#include "engine/base/hash.h"
#include "engine/base/range_coder.h"
#include "engine/tooth/brick_lattice.h"
#include "engine/tooth/leaf_layers.h"
#include "engine/tooth/octree.h"
#include "engine/tooth/packed_fits.h"
#include "engine/tooth/surface_fit.h"

namespace cavum {
namespace {

constexpr std::size_t k_leaves = Octree::k_brick_leaves;
constexpr std::size_t k_head_bytes = 4 * sizeof(double) + 3 * sizeof(std::int32_t);
constexpr std::uint32_t k_max_bricks = 1u << 18;  // 15 us each, 4 s in all: six molars at a leaf of
                                                  // 0.05 mm; a few bytes can code them all

/// The three streams of Octree::write, with distance codes instead of their differences.
struct Streams {
  Bytes shape, tissue, distance;
};

using Brick = PackedFits::Brick;
using Expected = PackedFits::Expected;
constexpr std::uint32_t k_no_full = PackedFits::k_no_full;

/// One walk that writes (Coder = RangeEncoder) or reads (RangeDecoder) all three streams.
template <class Coder>
class Walk {
 public:
  Walk(Coder& coder, Streams& streams, const std::vector<Tissue>& tissues, int levels,
       std::uint32_t bricks, std::uint32_t full, const PackedFits* like = nullptr,
       KnownFits* keep = nullptr)
      : coder_(coder), streams_(streams), lattice_(levels), most_bricks_(bricks), most_full_(full) {
    for (const auto& t : tissues) solid_[t.id] = t.solid;
    code_cell({0, 0, 0}, levels);
    if (brick_.size() != most_bricks_ || full_brick_.size() != most_full_) throw_damaged();
    if constexpr (Coder::k_decodes) streams_.tissue.resize(brick_.size() * k_leaves);
    for (std::size_t i = 0; i < brick_.size(); ++i) code_labels(i);
    if constexpr (Coder::k_decodes) streams_.distance.resize(full_brick_.size() * k_leaves);
    if (like != nullptr && like->solid == solid_ && like->lattice.cells() == lattice_.cells()) {
      like_ = like;
      differences_.emplace(*like, lattice_, brick_, streams_.tissue);
    }
    if (keep != nullptr) expected_.resize(full_brick_.size() * k_leaves);
    sort_into_layers();
    for (std::size_t layer = 0; layer < k_leaf_layers; ++layer)
      for (std::size_t i = 0; i < full_brick_.size(); ++i)
        if (layers_[i][layer] != 0) code_distances(i, layer);
    if (keep != nullptr)
      *keep = std::make_shared<const PackedFits>(
          PackedFits{solid_, std::move(lattice_), std::move(brick_), streams_.tissue,
                     streams_.distance, std::move(expected_), std::move(layers_)});
  }

 private:
  static constexpr std::uint16_t k_not_yet = 256;  // a label that is not known yet
  using LabelWindow = std::array<std::uint16_t, 512>;

  [[noreturn]] static void throw_damaged() {
    throw Error(msg("tooth"), msg("the packed octree does not fit its header"),
                msg("the file is damaged: use an intact copy"));
  }

  // --- cells

  void code_cell(IVec3 low, int level) {
    std::uint8_t kind = Coder::k_decodes ? std::uint8_t{0} : streams_.shape[at_++];
    // Bricks known already: those that touch the cell's lower faces at their nearest and farthest
    // corner, and its lower edges.
    const int far = (1 << level) - 1;
    const std::array<IVec3, 9> step{IVec3{-1, 0, 0},     IVec3{0, -1, 0},     IVec3{0, 0, -1},
                                    IVec3{-1, far, far}, IVec3{far, -1, far}, IVec3{far, far, -1},
                                    IVec3{-1, -1, 0},    IVec3{-1, 0, -1},    IVec3{0, -1, -1}};
    std::array<std::uint32_t, 9> around;
    std::size_t uniform_around = 0, full_around = 0;
    for (std::size_t i = 0; i < around.size(); ++i) {
      around[i] = lattice_[low + step[i]];
      uniform_around = 2 * uniform_around + (around[i] < BrickLattice::k_unknown);
      full_around =
          2 * full_around + (around[i] >= BrickLattice::k_first_brick &&
                             brick_[around[i] - BrickLattice::k_first_brick].full != k_no_full);
    }
    const bool uniform =
        coder_.code(uniform_[static_cast<std::size_t>(level)][uniform_around], kind == 0);
    if (uniform) {
      emit(0);
      std::uint8_t tissue = Coder::k_decodes ? std::uint8_t{0} : streams_.shape[at_++];
      tissue = code_tissue(around, cell_tissue_, tissue,
                           [level](std::size_t) { return static_cast<std::size_t>(level); });
      emit(tissue);
      lattice_.fill(low, level, tissue);
    } else if (level > 0) {
      emit(1);
      const int half = 1 << (level - 1);
      for (int i = 0; i < 8; ++i)
        code_cell(low + IVec3{(i & 1) * half, (i >> 1 & 1) * half, (i >> 2) * half}, level - 1);
    } else {
      const bool full = coder_.code(full_[full_around], kind == 3);
      emit(full ? 3 : 2);
      if (brick_.size() == most_bricks_ || (full && full_brick_.size() == most_full_))
        throw_damaged();
      lattice_.fill(low, 0,
                    BrickLattice::k_first_brick + static_cast<std::uint32_t>(brick_.size()));
      brick_.push_back({low, full ? static_cast<std::uint32_t>(full_brick_.size()) : k_no_full});
      if (full) full_brick_.push_back(static_cast<std::uint32_t>(brick_.size() - 1));
    }
  }

  void emit(std::uint8_t byte) {
    if constexpr (Coder::k_decodes) streams_.shape.push_back(byte);
  }

  // --- labels

  /// A tissue by asking "is it this one?" for up to three that occur in `around` (tissues 0..255;
  /// other values are no tissue). `context(n)` chooses among the models of question n, and may look
  /// at `candidate_`.
  template <class Around, class Models, class Context>
  std::uint8_t code_tissue(const Around& around, Models& models, std::uint8_t tissue,
                           const Context& context) {
    std::array<std::uint32_t, 3> asked;
    std::size_t n = 0;
    for (const std::uint32_t t : around) {
      if (t > 255 || std::find(asked.begin(), asked.begin() + static_cast<std::ptrdiff_t>(n), t) !=
                         asked.begin() + static_cast<std::ptrdiff_t>(n))
        continue;
      candidate_ = t;
      if (coder_.code(models[n][context(n)], tissue == t)) return static_cast<std::uint8_t>(t);
      asked[n++] = t;
      if (n == asked.size()) break;
    }
    return code_byte(coder_, rare_tissue_, tissue);
  }

  [[nodiscard]] LabelWindow labels_around(IVec3 brick, std::size_t known_bricks) const {
    LabelWindow window;
    lattice_.gather(
        brick, window,
        [&](std::uint32_t ref) {
          return ref >= BrickLattice::k_first_brick &&
                         ref - BrickLattice::k_first_brick < known_bricks
                     ? &streams_.tissue[(ref - BrickLattice::k_first_brick) * k_leaves]
                     : nullptr;
        },
        [](std::uint32_t ref) {
          return static_cast<std::uint16_t>(std::min<std::uint32_t>(ref, k_not_yet));
        });
    return window;
  }

  [[nodiscard]] static constexpr int place_of(std::size_t leaf) {
    const int i = static_cast<int>(leaf);
    return FitWindow::index(i & 3, i >> 2 & 3, i >> 4);
  }

  void code_labels(std::size_t number) {
    // Leaves coded before this one, the nearest first, and three that may be known when they lie in
    // uniform cells.
    constexpr std::array<int, 16> k_step{
        window_step(-1, 0, 0),   window_step(0, -1, 0),  window_step(0, 0, -1),
        window_step(-1, -1, 0),  window_step(-1, 0, -1), window_step(0, -1, -1),
        window_step(1, -1, 0),   window_step(1, 0, -1),  window_step(0, 1, -1),
        window_step(-1, -1, -1), window_step(-2, 0, 0),  window_step(0, -2, 0),
        window_step(0, 0, -2),   window_step(1, 0, 0),   window_step(0, 1, 0),
        window_step(0, 0, 1)};
    LabelWindow window = labels_around(brick_[number].at, number);
    std::uint8_t* const labels = &streams_.tissue[number * k_leaves];
    std::array<std::uint16_t, k_step.size()> around;
    for (std::size_t leaf = 0; leaf < k_leaves; ++leaf) {
      const int place = place_of(leaf);
      for (std::size_t i = 0; i < around.size(); ++i)
        around[i] = window[static_cast<std::size_t>(place + k_step[i])];
      const auto same_around = [&](std::size_t) {
        std::size_t same = 0;
        for (std::size_t i = 0; i < k_label_context; ++i)
          same = 2 * same + (around[i] == candidate_);
        return same;
      };
      labels[leaf] = code_tissue(around, label_, labels[leaf], same_around);
      window[static_cast<std::size_t>(place)] = labels[leaf];
    }
  }

  // --- distances

  /// Which layer each leaf of the full bricks belongs to, and a guess of the distances next to the
  /// surface.
  void sort_into_layers() {
    leaf_.resize(full_brick_.size() * k_leaves);
    layers_.reserve(full_brick_.size());
    for (std::size_t i = 0; i < full_brick_.size(); ++i) {
      if (const std::uint32_t known = known_full(i); known != k_no_full) {
        layers_.push_back(like_->layers[known]);
      } else {
        const LabelWindow labels = labels_around(brick_[full_brick_[i]].at, brick_.size());
        WindowBits solid{};
        for (std::size_t j = 0; j < labels.size(); ++j)
          solid[j >> 6] |= std::uint64_t{solid_[labels[j] & 255]} << (j & 63);
        layers_.push_back(leaf_layers(solid));
      }
      constexpr std::array<std::int8_t, 3> k_usual{28, 55, 70};
      for (std::size_t layer = 0; layer < k_usual.size(); ++layer)
        for (std::uint64_t left = layers_[i][layer]; left != 0; left &= left - 1) {
          const auto leaf = static_cast<std::size_t>(std::countr_zero(left));
          const bool is_solid = solid_[streams_.tissue[full_brick_[i] * k_leaves + leaf]];
          leaf_[i * k_leaves + leaf] = {
              static_cast<std::int8_t>(is_solid ? -k_usual[layer] : k_usual[layer]),
              FitLeaf::k_guess};
        }
    }
  }

  /// The full brick of `like_` whose fits hold for full brick `number`, too; k_no_full when they
  /// may not.
  [[nodiscard]] std::uint32_t known_full(std::size_t number) const noexcept {
    const IVec3 at = brick_[full_brick_[number]].at;
    return like_ == nullptr || differences_->near(at) ? k_no_full : like_->full_at(at);
  }

  void gather_window(IVec3 at) {
    lattice_.gather(
        at, window_.leaf,
        [&](std::uint32_t ref) -> const FitLeaf* {
          if (ref < BrickLattice::k_first_brick) return nullptr;
          const std::uint32_t full = brick_[ref - BrickLattice::k_first_brick].full;
          return full == k_no_full ? nullptr : &leaf_[full * k_leaves];
        },
        [](std::uint32_t) { return FitLeaf{}; });
  }

  [[nodiscard]] static FitLeaf coded(std::int8_t code, int off) noexcept {
    if (std::abs(int{code}) >= k_distance_far) return {code, FitLeaf::k_unused};
    return {code, static_cast<std::uint8_t>(std::min<int>(std::abs(off), FitLeaf::k_max_error))};
  }

  void code_distances(std::size_t number, std::size_t layer) {
    const std::uint32_t brick = full_brick_[number];
    const IVec3 at = brick_[brick].at;
    const bool far =
        layer + 1 == k_leaf_layers;  // all distances there are, but for what a carve left behind
    const std::uint32_t before = far || like_ == nullptr ? k_no_full : like_->full_at(at);
    bool known = !far && known_full(number) != k_no_full;
    if (!far && !known) gather_window(at);
    for (std::uint64_t left = layers_[number][layer]; left != 0; left &= left - 1) {
      const auto leaf = static_cast<std::size_t>(std::countr_zero(left));
      const std::size_t here = number * k_leaves + leaf;
      const int sign = solid_[streams_.tissue[brick * k_leaves + leaf]] ? -1 : 1;
      Expected expected{static_cast<std::uint16_t>(k_fit_contexts),
                        static_cast<std::int8_t>(k_distance_far)};
      if (known)
        expected = like_->expected[before * k_leaves + leaf];
      else if (!far)
        expected = fit(window_, place_of(leaf), sign, layer == 0);
      if (!expected_.empty()) expected_[here] = expected;
      const int off =
          code_residual(residual_[expected.context],
                        sign * static_cast<std::int8_t>(streams_.distance[here]) - expected.code);
      leaf_[here] = coded(
          static_cast<std::int8_t>(static_cast<std::uint8_t>(sign * (expected.code + off))), off);
      streams_.distance[here] = static_cast<std::uint8_t>(leaf_[here].code);
      window_.leaf[static_cast<std::size_t>(place_of(leaf))] = leaf_[here];
      if (before != k_no_full && differs(before * k_leaves + leaf, sign, leaf_[here])) {
        differences_->note(at, 1);
        if (std::exchange(known, false)) gather_window(at);
      }
    }
  }

  /// Whether a leaf came out otherwise than that of `like_`.
  [[nodiscard]] bool differs(std::size_t leaf, int sign, FitLeaf is) const noexcept {
    const auto code = static_cast<std::int8_t>(like_->distance[leaf]);
    const FitLeaf was = coded(code, sign * code - like_->expected[leaf].code);
    return is.code != was.code || is.error != was.error;
  }

  /// The code expected (as if outside: 1..127) and the context: how the two planes differ, the
  /// errors around, near the limit or not, where between two codes the expectation lies.
  [[nodiscard]] static Expected fit(const FitWindow& window, int place, int sign, bool first) {
    const SurfaceFit f = fit_surface(window, place);
    const double near = std::clamp<double>(f.near * sign, 1, k_distance_far),
                 wide = std::clamp<double>(f.wide * sign, 1, k_distance_far);
    const int expected = static_cast<int>(near + 0.5);
    const auto part = static_cast<std::size_t>((near - expected + 0.5) * 4);  // 0..3
    const auto bend =
        static_cast<std::size_t>(std::clamp((wide - near) * 2, -6.0, 6.0) + 6.5);  // 0..12
    const auto errors = static_cast<std::size_t>(
        f.error_8 < 0 ? 18
                      : std::bit_width(static_cast<unsigned>(f.error_8 *
                                                             f.error_8)));  // 0..18, two per octave
    const std::size_t limit = expected == k_distance_far ? 2 : expected > 120 ? 1 : 0;
    const std::size_t context =
        (((bend * 19 + errors) * 3 + limit) * 2 + first) * 4 + (errors < 9 ? part : 0);
    return {static_cast<std::uint16_t>(context), static_cast<std::int8_t>(expected)};
  }
  static constexpr std::size_t k_fit_contexts = std::size_t{13} * 19 * 3 * 2 * 4;

  struct Residual {
    AdaptiveBit zero, positive;
    std::array<std::array<AdaptiveBit, 19>, 2> more;  // is its size more than 1, 2, 3 ...?
  };
  int code_residual(Residual& model, int residual) {
    if (coder_.code(model.zero, residual == 0)) return 0;
    const bool positive = coder_.code(model.positive, residual > 0);
    const int size = std::abs(residual);
    int n = 1;
    for (auto& more : model.more[positive]) {
      if (!coder_.code(more, size > n)) return positive ? n : -n;
      ++n;
    }
    n += code_byte(coder_, large_residual_, static_cast<std::uint8_t>(size - n));
    return positive ? n : -n;
  }

  Coder& coder_;
  Streams& streams_;
  BrickLattice lattice_;
  std::size_t most_bricks_, most_full_;
  std::array<bool, 256> solid_{};
  std::size_t at_ = 0;  // in the shape stream
  std::vector<Brick> brick_;
  std::vector<std::uint32_t> full_brick_;  // its number among all bricks
  FitWindow window_;
  std::vector<FitLeaf> leaf_;       // leaves of the full bricks, as far as known
  std::vector<LeafLayers> layers_;  // of each full brick
  std::vector<Expected> expected_;  // of the leaves of the full bricks, where they are to be kept
  const PackedFits* like_ = nullptr;
  std::optional<Differences> differences_;  // from `like_`
  std::uint32_t candidate_ = 0;             // the tissue that is asked about

  static constexpr std::size_t k_label_context = 13;
  std::array<std::array<AdaptiveBit, 512>, 9> uniform_;
  std::array<AdaptiveBit, 512> full_;
  std::array<std::array<AdaptiveBit, 9>, 3> cell_tissue_;
  std::vector<std::vector<AdaptiveBit>> label_ =
      std::vector(3, std::vector<AdaptiveBit>(std::size_t{1} << k_label_context));
  std::array<AdaptiveBit, 256> rare_tissue_, large_residual_;
  std::vector<Residual> residual_ = std::vector<Residual>(k_fit_contexts + 1);
};

/// Leaf, origin and size as they begin both forms; returns the levels above the bricks.
int copy_head(ByteReader& in, ByteWriter& out) {
  const auto head = in.get_bytes(k_head_bytes);
  out.put_bytes(head);
  ByteReader size(head.subspan(k_head_bytes - 3 * sizeof(std::int32_t)), msg("tooth"));
  std::int32_t widest = 0;
  for (int i = 0; i < 3; ++i) {
    const auto n = size.get<std::int32_t>();
    if (n < 1 || n > Octree::k_max_edge_leaves) in.fail(msg("an impossible size"));
    widest = std::max(widest, n);
  }
  int levels = 0;
  while ((Octree::k_brick_edge << levels) < widest) ++levels;
  return levels;
}

}  // namespace

void pack_octree(ByteReader& canonical, const std::vector<Tissue>& tissues, ByteWriter& out) {
  ByteWriter whole;  // for the hash
  const int levels = copy_head(canonical, whole);
  Streams streams;
  for (Bytes* part : {&streams.shape, &streams.tissue, &streams.distance}) {
    const auto size = canonical.get<std::uint64_t>();
    const auto bytes = canonical.get_bytes(size);
    part->assign(bytes.begin(), bytes.end());
    whole.put(size);
    whole.put_bytes(bytes);
  }
  for (std::size_t i = 0; i < streams.distance.size(); ++i)
    if (i % k_leaves != 0)
      streams.distance[i] =
          static_cast<std::uint8_t>(streams.distance[i] + streams.distance[i - 1]);
  const std::size_t bricks = streams.tissue.size() / k_leaves,
                    full = streams.distance.size() / k_leaves;
  if (bricks > k_max_bricks)
    throw Error(msg("tooth"), msg("too much detail for a tooth file: {} bricks", bricks),
                msg("use a larger leaf"));
  RangeEncoder coder;
  const Walk walk(coder, streams, tissues, levels, static_cast<std::uint32_t>(bricks),
                  static_cast<std::uint32_t>(full));
  const Bytes bits = coder.finish();
  out.put_bytes(std::span(whole.bytes()).first(k_head_bytes));
  out.put(static_cast<std::uint32_t>(bricks));
  out.put(static_cast<std::uint32_t>(full));
  out.put(static_cast<std::uint64_t>(bits.size()));
  out.put_bytes(bits);
  out.put(fast_hash(whole.bytes().data(), whole.bytes().size(), 0));
}

Bytes unpack_octree(ByteReader& in, const std::vector<Tissue>& tissues, const PackedFits* like,
                    KnownFits* keep) {
  ByteWriter out;
  const int levels = copy_head(in, out);
  const auto bricks = in.get<std::uint32_t>(), full = in.get<std::uint32_t>();
  if (bricks > k_max_bricks || full > bricks)
    in.fail(msg("has {} bricks, more than the limit of {}", bricks, k_max_bricks));
  ByteReader bits(in.get_bytes(in.get<std::uint64_t>()), msg("tooth"));
  RangeDecoder coder(bits);
  Streams streams;
  const Walk walk(coder, streams, tissues, levels, bricks, full, like, keep);
  if (bits.left() != 0) in.fail(msg("data after the end of the octree"));
  for (std::size_t i = streams.distance.size(); i-- > 0;)
    if (i % k_leaves != 0)
      streams.distance[i] =
          static_cast<std::uint8_t>(streams.distance[i] - streams.distance[i - 1]);
  for (const Bytes* part : {&streams.shape, &streams.tissue, &streams.distance}) {
    out.put(static_cast<std::uint64_t>(part->size()));
    out.put_bytes(*part);
  }
  if (in.get<std::uint64_t>() != fast_hash(out.bytes().data(), out.bytes().size(), 0))
    in.fail(msg("the octree does not match its hash"));
  return out.take();
}

}  // namespace cavum
