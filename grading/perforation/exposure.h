// Truth of a perforation: which void tissue (pulp, periodontium) was laid open from the cavity,
// face by face between leaves. A floor that stops a hair's breadth beyond a pulp's roof takes no
// leaf of pulp, and is a hole all the same; soft tissue swept from outside, the tooth untouched, is
// none.
#pragma once

#include <array>
#include <span>
#include <vector>

#include "engine/tooth/tooth.h"
#include "grading/measures/removed_map.h"
#include "grading/result/result.h"

namespace cavum::grading {

/// What was opened of one tissue.
struct ExposedTissue {
  double area_mm2 = 0.0,
         area_bound_mm2 =
             0.0;  ///< of its wall that lies open to the cavity; bound: half a leaf along the rim
  double inside_mm3 = 0.0;   ///< removed from the cavity
  double outside_mm3 = 0.0;  ///< removed from outside the tooth
  Trace first;               ///< face opened first, or leaf removed from the cavity first
  Trace first_outside;
  std::vector<std::int64_t>
      ticks;  ///< in which it was opened further, or some of it removed from the cavity; ascending
  [[nodiscard]] bool opened() const noexcept { return first.tick >= 0; }
};

/// By tissue id, of those in `of_interest`: it lies around the tooth (see below). Takes longest of
/// all that grading does, and depends on the tooth alone: whoever marks much work on one tooth
/// finds it out once.
[[nodiscard]] std::array<bool, 256> tissues_around(const Tooth& tooth,
                                                   const std::array<bool, 256>& of_interest);

/// By tissue id, of those in `of_interest`, up to and with `last_tick`. `tooth`: before the exam;
/// `list`: what was removed, which `removed` maps.
///
/// A face counts between a hard leaf that was removed and a leaf of the tissue. Of a tissue that
/// the tooth encloses (pulp) every one does. Of one that lies around the tooth (periodontium: 45 %
/// of its wall or more borders air) it counts where the cavity came first, and where the hard
/// leaves removed by then and joined to it reach a leaf more than 0.3 mm below the tooth's surface:
/// there is a way through the tooth.
///
/// A face's share of the area is leaf² |n|, n the wall's unit normal about it along the face's
/// axis, so that slanted walls do not count as stairs. `around`: what tissues_around says, where
/// that is known.
[[nodiscard]] std::array<ExposedTissue, 256> measure_exposure(
    const Tooth& tooth, std::span<const RemovedAt> list, const RemovedMap& removed,
    std::int64_t last_tick, const std::array<bool, 256>& of_interest,
    const std::array<bool, 256>* around = nullptr);

}  // namespace cavum::grading
