// Marks a prepared tooth by a scan of it, as a session's tooth is marked: registered to the
// unprepared tooth without hand work, what was removed worked out, and measured and marked by the
// same rubric. What needs time, way or force is not judged.
#pragma once

#include <string>
#include <vector>

#include "engine/lab/scan/cut_by_scan.h"
#include "engine/lab/scan/register_scan.h"
#include "engine/lab/scan/scan_fit.h"
#include "grading/measures/grade_input.h"
#include "grading/result/mark.h"
#include "scenarios/file/scenario.h"
#include "scenarios/zones/zone_map.h"

namespace cavum::grading {

/// How a scan was laid upon the tooth, and what it shows.
struct ScanFacts {
  std::size_t triangles = 0;
  ScanPose pose;
  double second_share = 0.0;  ///< of the scan that fits in the best of the poses elsewhere, 0..1
  ScanFit fit;
  double smoothed_noise_mm = 0.0;  ///< of the scan's surface once its noise was averaged out
  double surface_bound_mm = 0.0;  ///< how far a place of the cut surface may lie from the true one;
                                  ///< part of every bound of a place
  double surface_mean_bound_mm =
      0.0;  ///< and how far all of it together; part of the bounds of volumes
  int cavities = 0;
  double unseen_mm3 = 0.0;  ///< of the tooth below where the scan ends
  double left_as_noise_mm3 = 0.0;
  std::vector<ThinPiece> apart;  ///< thin pieces apart from the cavity: not counted
  std::optional<Finding>
      were_they_counted;  ///< where there are any: the verdict and points that there would be then
  double end_mm = 0.0;    ///< length of the rim where the scan ends; 0: it is closed
  int holes = 0;          ///< other rims
  Findings put_right;     ///< of the file
};

struct GradedScan {
  Result result;
  ScanFacts facts;
  Tooth after;
  std::vector<RemovedAt> removed;  ///< leaves, at k_untimed_tick
  NotShown not_shown;
  /// What was marked. Refers to all three and to this.
  [[nodiscard]] GradeInput input(const scenarios::Scenario& scenario, const Tooth& tooth,
                                 const scenarios::ZoneMap& zones) const;
};

/// How a scan's file is to be read.
struct ScanOptions {
  double unit_mm = 1.0;  ///< of its lengths
  bool mirror = false;  ///< it is of the real tooth, and the tooth was imported as its mirror image
};

/// `path`: STL, PLY, OBJ or OFF, open or closed, in any pose. `tooth`: the unprepared one that
/// `zones` were laid into. Throws Error naming the file when it cannot be read, is too small or too
/// full of holes, is of another size (by how much, where its form fits) or another tooth, shows too
/// little of the crown, or could as well lie otherwise. What is doubtful only makes the verdict
/// `review`.
[[nodiscard]] GradedScan grade_scan(const std::string& path, const ScanOptions& options,
                                    const scenarios::Scenario& scenario,
                                    const scenarios::RubricSpec& rubric, const Tooth& tooth,
                                    const scenarios::ZoneMap& zones);

}  // namespace cavum::grading
