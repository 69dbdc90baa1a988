#include "scenarios/review/ridge_margins.h"

#include <algorithm>
#include <optional>

#include "engine/base/error.h"
#include "scenarios/zones/outline.h"
#include "scenarios/zones/placed.h"

namespace cavum::scenarios {
namespace {

constexpr std::array<double, 4> k_margins_mm{1.6, 1.2, 0.9, 0.7};
constexpr double k_min_left_mm = 0.5, k_inside_mm = 0.05;

/// From the line's nearest place, seen from above.
double away_mm(Vec3 p, const std::vector<Vec3>& line) {
  double best = 1e9;
  for (std::size_t i = 1; i < line.size(); ++i)
    best = std::min(best, segment_distance({p.x, p.y, 0}, {line[i - 1].x, line[i - 1].y, 0},
                                           {line[i].x, line[i].y, 0}));
  return best;
}

struct End {
  const std::optional<Vec3>& pit;
  const MarginalRidge& ridge;
  bool asked;  // the cavity ends there
};

/// An outline at one end.
struct Laid {
  double margin_mm = 0;
  std::array<bool, 2> takes_in{true, true};
  std::array<double, 2> left_mm{1e9, 1e9};  // from the outline to the crest
};

/// None where the fissure is too short for so much ridge.
std::optional<Laid> laid_with(const Landmarks& l, const std::array<End, 2>& ends, double width_mm,
                              int through, double margin_mm) {
  OutlineSpec spec;
  spec.kind = OutlineSpec::Kind::fissure;
  spec.width_mm = width_mm;
  spec.ridge_mm = margin_mm;
  spec.through = through;
  std::vector<Vec3> line;
  try {
    line = place_fissure(spec, l, {}).paths_mm.front();
  } catch (const Error&) {
    return {};
  }
  Laid laid;
  laid.margin_mm = margin_mm;
  for (std::size_t e = 0; e < ends.size(); ++e) {
    laid.takes_in[e] = !ends[e].asked || !ends[e].pit ||
                       away_mm(*ends[e].pit, line) <= 0.5 * width_mm - k_inside_mm;
    if (ends[e].asked)
      for (const Vec3& p : ends[e].ridge.crest_mm)
        laid.left_mm[e] = std::min(laid.left_mm[e], away_mm(p, line) - 0.5 * width_mm);
  }
  return laid;
}

}  // namespace

RidgeMargins ridge_margins(const Landmarks& l, double width_mm, int through) {
  const std::array<End, 2> ends{{{l.mesial_pit_mm, l.mesial_ridge, through <= 0},
                                 {l.distal_pit_mm, l.distal_ridge, through >= 0}}};
  std::vector<Laid> all;
  std::array<bool, 2> can{false, false};
  for (const double margin : k_margins_mm) {
    const auto laid = laid_with(l, ends, width_mm, through, margin);
    if (!laid) continue;
    for (std::size_t e = 0; e < ends.size(); ++e)
      can[e] = can[e] || (laid->takes_in[e] && laid->left_mm[e] >= k_min_left_mm);
    all.push_back(*laid);
  }
  RidgeMargins margins;
  for (const Laid& laid : all) {
    bool may = true;
    for (std::size_t e = 0; e < ends.size(); ++e) {
      may = may && laid.left_mm[e] >= k_min_left_mm && (laid.takes_in[e] || !can[e]);
      if (laid.left_mm[e] < k_min_left_mm && margins.why_none.empty())
        margins.why_none =
            e == 0
                ? msg("the crest of its mesial ridge, as it was found, comes within {} of the fissure's cavity",
                      as_mm(std::max(0.0, laid.left_mm[e]), 1))
                : msg("the crest of its distal ridge, as it was found, comes within {} of the fissure's cavity",
                      as_mm(std::max(0.0, laid.left_mm[e]), 1));
    }
    if (may)
      margins.may.push_back(
          {laid.margin_mm, std::min({laid.margin_mm, laid.left_mm[0], laid.left_mm[1]})});
  }
  if (margins.may.empty()) {
    if (margins.why_none.empty())
      margins.why_none = msg("nothing of its fissure is far enough from both marginal ridges");
    return margins;
  }
  margins.why_none = {};
  for (std::size_t e = 0; e < ends.size(); ++e) margins.pits_left[e] = !can[e];
  return margins;
}

}  // namespace cavum::scenarios
