// How fast a bur grinds each tissue under a constant load: a weight rests on the turning bur, on
// its end or on its side, and the depth is read while it sinks in. As bench tests of burs do, so
// that their published rates can stand beside ours (docs/cutting_rates.md).
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

#include "engine/base/lines.h"
#include "engine/physics/bur/bur.h"
#include "engine/physics/force/force_model.h"

namespace cavum {

struct GrindOptions {
  std::vector<double> load_n{0.35, 0.65, 1.05};  ///< clinical loads: 35 to 105 g (Liao 1995)
  double rpm = 200000.0;                         ///< free speed at a pedal pressed to the floor
  bool side = false;                             ///< the bur lies on its side, and grinds a groove
};

struct GrindRow {
  std::string tissue;
  double load_n = 0, rpm = 0;  ///< speed under that load
  double torque_n_mm = 0;      ///< that resists it; 0 without a drive
  double depth_mm_s = 0;       ///< recession along the load
  double mm3_per_min = 0;      ///< volume that leaves the block
  bool sunk = true;            ///< false: it did not come to the depth at which the rate is taken
};

struct GrindResult {
  GrindOptions options;
  std::string model, bur;
  std::vector<GrindRow> rows;
};

/// Each solid tissue of the model at each load. The rate is taken over `k_grind_window_mm`: on its
/// end from where the whole end is in, on its side in a shallow groove. Volume is what leaves the
/// tooth meanwhile. Throws Error when a tissue cannot be cut.
[[nodiscard]] GrindResult run_grind_rig(const ForceModel& force, const Bur& bur,
                                        const GrindOptions& options);
/// One of its rows.
[[nodiscard]] GrindRow grind(const ForceModel& force, const Bur& bur, const std::string& tissue,
                             double load_n, const GrindOptions& options);
inline constexpr double k_grind_window_mm = 0.2;

[[nodiscard]] Lines to_text(const GrindResult& result);
[[nodiscard]] nlohmann::json to_json(const GrindResult& result);

}  // namespace cavum
