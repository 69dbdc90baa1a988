#include "grading/perforation/drop.h"

#include <algorithm>
#include <deque>

#include "engine/session/simulation.h"
#include "grading/perforation/drill_frames.h"

namespace cavum::grading {
namespace {

constexpr std::int64_t k_before_opening_ticks = 500, k_after_opening_ticks = 1500;  // of an opening
constexpr double k_min_filled_n =
    0.05;  // of the filled tooth's force: less has no share worth naming

std::vector<double> simulated_n(const ServoModel& model, ServoState state,
                                std::span<const TickInput> inputs) {
  std::vector<TickRecord> again(inputs.size());
  for (std::size_t i = 0; i < inputs.size(); ++i)
    again[i] = make_tick_record(step(model, state, inputs[i]));
  return felt_force_n(again);
}

}  // namespace

/// Size of the force, mean over each 10 ms and the 20 before.
std::vector<double> felt_force_n(std::span<const TickRecord> records) {
  std::vector<Vec3> frames(records.size() / k_frame_ticks);
  for (std::size_t f = 0; f < frames.size(); ++f)
    for (std::size_t i = f * k_frame_ticks; i < (f + 1) * k_frame_ticks; ++i) {
      const auto& r = records[i].rendered_un;
      frames[f] += Vec3{r[0] * 1e-6, r[1] * 1e-6, r[2] * 1e-6} / static_cast<double>(k_frame_ticks);
    }
  std::vector<double> out(frames.size());
  for (std::size_t f = 0; f < out.size(); ++f) {
    Vec3 sum;
    const std::size_t first = f + 1 >= k_mean_frames ? f + 1 - k_mean_frames : 0;
    for (std::size_t i = first; i <= f; ++i) sum += frames[i];
    out[f] = length(sum) / static_cast<double>(f + 1 - first);
  }
  return out;
}

MissingForce missing_force(const ServoModel& filled_model, ServoState filled,
                           std::span<const TickInput> inputs, std::span<const TickRecord> records) {
  return {felt_force_n(records), simulated_n(filled_model, std::move(filled), inputs)};
}

std::vector<double> filled_force_n(const SessionSetup& setup, const Tooth& filled,
                                   std::span<const TickInput> inputs) {
  Simulation simulation = make_simulation(setup, "the session", &filled);
  return simulated_n(simulation.model, std::move(simulation.state), inputs);
}

std::int64_t last_asked_tick(std::span<const std::int64_t> opened) {
  return opened.empty() ? -1 : opened.back() + k_after_opening_ticks;
}

ForceDrop find_drop(const MissingForce& missing, std::span<const std::int64_t> opened) {
  ForceDrop best;
  double best_score = -1.0;
  const std::size_t frames = std::min(missing.felt_n.size(), missing.filled_n.size());
  const auto window = static_cast<std::size_t>(k_felt_drop_ticks / k_frame_ticks);
  std::vector<double> gone_n(frames), gone_share(frames);
  for (std::size_t f = 0; f < frames; ++f) {
    gone_n[f] = missing.filled_n[f] - missing.felt_n[f];
    gone_share[f] = missing.filled_n[f] >= k_min_filled_n
                        ? std::clamp(gone_n[f] / missing.filled_n[f], 0.0, 1.0)
                        : 0.0;
  }
  for (std::size_t f = 0; f < frames; ++f) {
    const std::int64_t tick = static_cast<std::int64_t>(f + 1) * k_frame_ticks - 1;
    const auto near = std::lower_bound(opened.begin(), opened.end(), tick - k_after_opening_ticks);
    if (near == opened.end() || *near > tick + k_before_opening_ticks) continue;
    // back as long as the hand presses on what would be solid: who comes back to an open cavity has
    // lost nothing
    for (std::size_t g = f + 1;
         g-- > 0 && f - g <= window && missing.filled_n[g] >= k_min_filled_n;) {
      const double n = gone_n[f] - gone_n[g], share = gone_share[f] - gone_share[g];
      const double score = std::min(n / k_felt_drop_n, share / k_felt_drop_share);
      if (score >= 1.0 && best.felt_tick < 0) best.felt_tick = tick;
      if (score <= best_score) continue;
      best_score = score;
      best.missing_n = n, best.share = share;
      best.from_tick = static_cast<std::int64_t>(g + 1) * k_frame_ticks - 1, best.to_tick = tick;
    }
  }
  if (best.felt())
    for (const std::int64_t tick : opened) best.cut_on_s += tick > best.felt_tick ? k_tick_s : 0.0;
  return best;
}

}  // namespace cavum::grading
