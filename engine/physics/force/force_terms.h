// The terms of a force model at work. Along a feed they simply add up. In the servo, the tip moves
// in space: terms of the tissue act along the contact normal, drag acts against the tip's motion,
// in air too.
#pragma once

#include <span>
#include <vector>

#include "engine/base/state_hash.h"
#include "engine/base/vec.h"
#include "engine/physics/force/rendering.h"
#include "engine/physics/force/term_kinds.h"

namespace cavum {

inline constexpr std::size_t k_max_terms = 8;
using ForceTerms = std::vector<ForceTermPtr>;  ///< at most k_max_terms

/// Force along a feed, N, resisting positive: F = max(0, k·X + c·V + Σ tissue) + Σ drag. For rigs:
/// `in` with X, V, k, c, rpm, dt and touching set; speed is V and the Voigt force is filled in
/// here. `memory` has one entry for each term, zero before the first sample. In air (not touching)
/// give V all the same: drag acts there too.
[[nodiscard]] double force_along_feed_n(const ForceTerms& terms, TermInput in,
                                        std::span<TermMemory> memory) noexcept;

/// What the terms remember in the servo.
struct TermsState {
  std::size_t count = 0;  ///< terms in use; the rest of `memory` is not
  Vec3 velocity_mm_s;     ///< of the tip, filtered
  Vec3 stretch_n;         ///< force of the spring that drag is rendered through, along the motion
  std::array<TermMemory, k_max_terms> memory{};
  bool counts_removed = false;  ///< a term looks at what was removed
  std::array<std::uint32_t, 256>
      removed_leaves{};  ///< by each bur of the tray; 0 unless `counts_removed`
};
/// Of terms that are not in use nothing counts.
template <class Visit>
void each_member(Visit& visit, const TermsState& state) noexcept {
  const auto& [count, velocity_mm_s, stretch_n, memory, counts_removed, removed_leaves] = state;
  visit(count, velocity_mm_s, stretch_n, counts_removed);
  for (std::size_t i = 0; i < count; ++i) visit(memory[i]);
  if (counts_removed) visit(removed_leaves);
}
/// Before the first tick of a model with these terms.
[[nodiscard]] TermsState make_terms_state(const ForceTerms& terms) noexcept;

struct TermsForce {
  double tissue_n = 0.0;  ///< to be added to the Voigt law, along the contact normal; 0 in air
  Vec3 drag_n;            ///< model, on the hand: Σ drag at the filtered velocity, against it
  Vec3 rendered_drag_n;   ///< what a sampled device may render of it
  bool finite = true;     ///< false: a term gave something else, and counted as zero
};

/// One tick, after the tip moved by `moved_mm`. Drag such as Fc·tanh(V/v0) is far too steep for a
/// device that samples (Fc/v0 = 260 N·s/m at 0.26 N and 1 mm/s; docs/physics.md section 7). So it
/// is rendered through a spring Ks in series, as the damper of the tissue is: z' = Ks·(V − u),
/// drag(u) = z, integrated implicitly. At constant speed this is the law itself; it holds like
/// stiction, slides at the law's force, and gives back no more than it took.
[[nodiscard]] TermsForce apply_terms(const ForceTerms& terms, const RenderingModel& rendering,
                                     TermInput in, Vec3 moved_mm, TermsState& state) noexcept;

}  // namespace cavum
