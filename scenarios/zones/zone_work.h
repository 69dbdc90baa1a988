// How much of the computer the zones of one scenario may take. Each body is asked for its distance
// at each leaf around the target, and tissues and surfaces are laid out leaf by leaf, so a text of
// a few lines can ask for minutes and gigabytes: it is counted before it is done.
#pragma once

#include <fmt/core.h>

#include <cstdint>
#include <string>

#include "engine/base/error.h"
#include "scenarios/file/mistake.h"

namespace cavum::scenarios {

/// Leaves of the box around the target with its leeway and container, all in the tooth: 2000 mm3 at
/// 0.05 mm. The shipped tasks have at most 3 million, a crown on a molar 13 million.
inline constexpr std::uint64_t k_max_zone_leaves = 16'000'000;
/// Leaves of the boxes of all bodies that are a tissue or a surface; a molar's periodontium has 16
/// million.
inline constexpr std::uint64_t k_max_body_leaves = 20'000'000;
/// Distances to single pieces (sides of an outline, walls of a cone, triangles) that are taken in
/// all, some 6 ns each.
inline constexpr std::uint64_t k_max_zone_steps = 250'000'000;

/// Counts for one scenario and throws Error(`where`, ...) with the limit named.
class ZoneWork {
 public:
  explicit ZoneWork(std::string where) : where_(std::move(where)) {}
  void zone_leaves(std::uint64_t leaves) const {
    require(leaves, k_max_zone_leaves,
            msg("the target and its margins hold {} leaves of the tooth", leaves),
            msg("make the target smaller, or the tooth with larger leaves"));
  }
  void body_leaves(std::uint64_t leaves) {
    body_leaves_ += leaves;
    require(body_leaves_, k_max_body_leaves,
            msg("the bodies that are tissues or surfaces reach over {} leaves", body_leaves_),
            msg("use fewer of them, or a smaller 'offset_mm'"));
  }
  void steps(std::uint64_t leaves, std::uint64_t pieces) {
    steps_ += leaves * pieces;
    require(
        steps_, k_max_zone_steps, msg("the zones need {} distances to pieces of bodies", steps_),
        msg("use fewer bodies, outlines of fewer points, surfaces of fewer triangles, or a smaller target"));
  }

 private:
  void require(std::uint64_t count, std::uint64_t most, const Message& what,
               const Message& what_to_do) const {
    if (count > most)
      throw Error(Mistake::too_large, Name{where_},
                  msg("{}, more than the limit of {}", what, most), what_to_do);
  }
  std::string where_;
  std::uint64_t body_leaves_ = 0, steps_ = 0;
};

}  // namespace cavum::scenarios
