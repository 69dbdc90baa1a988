#include "grading/trial/sitting.h"

#include <algorithm>
#include <memory>

#include "engine/base/error.h"
#include "engine/tooth/octree_edit.h"
#include "grading/perforation/exposure.h"
#include "scenarios/exam/runner.h"

namespace cavum::grading {
namespace {

constexpr std::int64_t k_ticks_per_layer = 2, k_lead_ticks = 20;

/// So that no cube is passed over for a distance that is none: the octree asks at a cube's centre.
double careful(double distance_mm, double leaf_mm) {
  const double brick_mm =
      (0.5 * Octree::k_brick_edge * k_half_diagonal + k_distance_band_leaves) * leaf_mm;
  return std::min(distance_mm, brick_mm);
}

struct Carved {
  Octree after;
  std::vector<RemovedLeaf> leaves;
};

Carved carve(const Tooth& tooth, const Cut& cut, const CutBox& box) {
  const double leaf = tooth.octree.leaf_mm();
  const Vec3 size = (box.high_mm - box.low_mm) / leaf;
  const auto most = static_cast<std::size_t>(size.x * size.y * size.z) + 64;
  Carved c{tooth.octree, {}};
  c.after.reserve_edits(most / Octree::k_brick_leaves + 4096);
  c.leaves.reserve(most);
  const auto shape = [&](Vec3 p) { return careful(cut(p), leaf); };
  if (!c.after.carve(box.low_mm, box.high_mm, shape, c.leaves))
    throw Error(msg("trial"), msg("a piece of work needs more room than was reserved"),
                msg("report it with the scenario"));
  return c;
}

/// A tick as a simulated hand would give it.
struct Moment {
  Vec3 tip_mm;
  bool cuts = false;
};

class Sitting {
 public:
  explicit Sitting(const Task& task)
      : task_(task), runner_(task.scenario, task.zones, task.tooth, task.scenario.burs) {}

  /// One tick; what is done once the exam is over is late work.
  void tick(const Moment& m, std::span<const RemovedLeaf> gone) {
    const TickInput input =
        make_tick_input({m.tip_mm, {}}, m.cuts ? 1.0 : 0.0, k_stylus_fresh | k_pedal_fresh, 0, {});
    TickOutput output;
    output.proxy_mm = m.tip_mm;
    output.contact = output.cutting = m.cuts;
    if (m.cuts) {
      output.rpm = task_.scenario.max_rpm;
      output.rendered_force_n = task_.zones.approach() * k_sitting_force_n;
      output.model_force_n = k_sitting_force_n;
      output.penetration_mm = k_sitting_force_n;
      output.normal = task_.zones.approach();
    }
    output.removed_count = static_cast<std::uint32_t>(gone.size());
    for (const auto& leaf : gone)
      removed_.push_back({static_cast<std::int64_t>(inputs_.size()), leaf});
    runner_.advance(*state_, input, output, gone);
    inputs_.push_back(input);
    records_.push_back(make_tick_record(output));
  }
  /// Over, or nothing is left to do in it.
  [[nodiscard]] bool done() const {
    return state_->finish != Finish::running ||
           static_cast<std::size_t>(state_->step) >= task_.scenario.steps.size();
  }

  [[nodiscard]] Result hand_in(const Octree& after,
                               const std::function<void(const GradeInput&, const Result&)>& look) {
    runner_.end(*state_);
    const std::vector<TimedEvent> events = state_->events_from(0);
    const auto marked = [&](const GradeInput& in) {
      Result r = grade(in, task_.scenario.rubric);
      if (look) look(in, r);
      return r;
    };
    if (!task_.apart)
      return marked({task_.scenario, task_.tooth, task_.zones, after, inputs_, records_, removed_,
                     events, -1, nullptr, &task_.around});
    const WorkApart own = take_apart(*task_.apart, after, removed_);
    const AdjacentInput beside{*task_.apart, task_.tooth, after, removed_};
    return marked({task_.scenario, task_.apart->own, task_.zones, own.after, inputs_, records_,
                   own.removed, events, -1, nullptr, &task_.around, &beside});
  }

 private:
  const Task& task_;
  scenarios::Runner runner_;
  std::unique_ptr<scenarios::RunnerState> state_ = std::make_unique<scenarios::RunnerState>();
  std::vector<TickInput> inputs_;
  std::vector<TickRecord> records_;
  std::vector<RemovedAt> removed_;
};

/// Leaves by how far out they lie, the outermost first, in layers of a leaf.
std::vector<std::vector<RemovedLeaf>> in_layers(const std::vector<RemovedLeaf>& leaves,
                                                const Octree& tree, Vec3 out) {
  std::vector<std::vector<RemovedLeaf>> layers;
  if (leaves.empty()) return layers;
  const auto height = [&](const RemovedLeaf& l) {
    return dot(tree.centre_mm(l.leaf()), out) / tree.leaf_mm();
  };
  double top = height(leaves.front());
  for (const auto& l : leaves) top = std::max(top, height(l));
  for (const auto& l : leaves) {
    const auto at = static_cast<std::size_t>(top - height(l) + 0.5);
    if (layers.size() <= at) layers.resize(at + 1);
    layers[at].push_back(l);
  }
  return layers;
}

}  // namespace

Task make_task(const scenarios::Scenario& scenario, const Tooth& tooth,
               const scenarios::ZoneMap& zones) {
  std::array<bool, 256> either{};
  for (const auto* names : {&scenario.perforation.aims, &scenario.perforation.faults})
    for (const auto& t : tooth.tissues)
      either[t.id] =
          either[t.id] || std::find(names->begin(), names->end(), t.name) != names->end();
  auto apart = take_apart(tooth);
  const auto around = tissues_around(apart ? apart->own : tooth, either);
  return {scenario, tooth, zones, around, std::move(apart)};
}

Result sit(const Task& task, const Cut& cut, const CutBox& box, std::int64_t wait_ticks,
           const std::function<void(const GradeInput&, const Result&)>& look) {
  const Carved carved = cut ? carve(task.tooth, cut, box) : Carved{task.tooth.octree, {}};
  const Vec3 out = task.zones.approach();
  const Vec3 above = task.zones.target_high_mm() + out * 5.0;
  Sitting sitting(task);
  for (std::int64_t i = 0; i < k_lead_ticks; ++i) sitting.tick({above, false}, {});
  for (const auto& layer : in_layers(carved.leaves, task.tooth.octree, out)) {
    const Vec3 tip =
        layer.empty() ? above : task.tooth.octree.centre_mm(layer[layer.size() / 2].leaf());
    for (std::int64_t i = 0; i < k_ticks_per_layer; ++i)
      sitting.tick({tip, true},
                   i == 0 ? std::span<const RemovedLeaf>(layer) : std::span<const RemovedLeaf>());
  }
  for (std::int64_t i = 0; i < k_lead_ticks; ++i) sitting.tick({above, false}, {});
  for (std::int64_t i = 0; i < wait_ticks && !sitting.done(); ++i) sitting.tick({above, false}, {});
  return sitting.hand_in(carved.after, look);
}

}  // namespace cavum::grading
