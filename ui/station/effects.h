// How much a picture may cost: levels of effects, and which of them the computer keeps up with.
// Level 0 is the richest; a picture that takes too long puts it down a level, time to spare puts it
// up again after a while.
#pragma once

#include <array>
#include <cstddef>

namespace cavum::station {

struct Effects {
  int shadow_edge;    ///< of the lamp's shadow, pixels
  int shadow_taps;    ///< looks a pixel: 1, 4 or 9
  int samples;        ///< a pixel, by the graphics card; 1 = none
  bool smooth_edges;  ///< by a pass over the picture instead
  bool reflections;   ///< of the room in wet enamel and metal; else of the lamp alone
  int drops;          ///< of spray and chips in the air; 0 = none
  float scale;        ///< of the picture drawn, to what is shown
};
inline constexpr std::array<Effects, 6> k_effects{{
    {2048, 9, 4, false, true, 480, 1.0F},
    {1024, 9, 1, true, true, 480, 1.0F},
    {1024, 4, 1, true, true, 320, 1.0F},
    {512, 4, 1, true, false, 160, 1.0F},
    {512, 1, 1, false, false, 0, 1.0F},
    {512, 1, 1, false, false, 0, 0.7F},
}};

class EffectGovernor {
 public:
  /// `budget_ms`: what a picture may take. Begins at `level`.
  EffectGovernor(double budget_ms, std::size_t level) : budget_ms_(budget_ms), level_(level) {}
  /// A picture of this level took so long.
  void took(double ms);
  [[nodiscard]] std::size_t level() const noexcept { return level_; }

 private:
  static constexpr std::size_t k_looked_at = 8;  // pictures
  double budget_ms_;
  std::size_t level_;
  std::array<double, k_looked_at> last_ms_{};
  std::size_t measured_ = 0, in_time_ = 0, patience_ = 60;
};

}  // namespace cavum::station
