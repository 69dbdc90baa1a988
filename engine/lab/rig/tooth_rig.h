// The paper's cut through a whole tooth (its Fig. 9): the stylus on a testing machine goes down at
// 0.25 mm/s through hard tissue into the pulp, at slightly different places, and the force falls
// where the pulp is reached.
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>
#include <vector>

#include "engine/base/lines.h"
#include "engine/base/statistics.h"
#include "engine/lab/rig/testing_machine.h"

namespace cavum {

struct ToothRigOptions {
  int runs = 30;
  std::uint64_t seed = 1;
  MachineSettings machine;
  std::optional<std::pair<double, double>>
      at_mm;               ///< x and y of the middle; else over the middle of the pulp's roof
  double spread_mm = 0.4;  ///< places lie at most this far from the middle
  double after_s = 3.0;    ///< the crosshead goes on after the pulp is reached
};

/// Readings at 100 Hz, zero at the first contact.
struct ToothSample {
  double t_s = 0, f_n = 0;
  std::uint8_t tissue = 0;  ///< the first one below the tip's proxy, in the tooth as it was
};

struct ToothRun {
  double x_mm = 0, y_mm = 0;
  std::vector<ToothSample> samples;
  double first_tissue_s = 0;  ///< contact, s after the start of the crosshead
  bool reached_pulp = false;
  bool held = false;  ///< X passed twice V τ: the head is held in its hole. Left out of the
                      ///< figures, as are runs that miss the pulp
  double pulp_s = 0;  ///< the tip's way opens into pulp, s after contact
  double before_n = 0, after_n = 0;  ///< means over half a second, ending half a second before, and
                                     ///< beginning two seconds after
  double fall_s = 0;                 ///< from 90 % to 10 % of the fall
  std::vector<std::pair<std::string, double>>
      tissue_mean_n;  ///< mean force by the tissue before the tip, from the top down
  std::uint16_t notices = 0;
};

/// Mean force and its scatter over the runs, at one time.
struct BandPoint {
  double t_s = 0;
  MeanSd force_n;
  int runs = 0;
};

struct ToothLayer {
  std::string tissue;
  MeanSd from_s, to_s, force_n;  ///< over the runs; times after contact
};

struct ToothRigResult {
  ToothRigOptions options;
  std::string tooth, model, bur;
  std::vector<ToothRun> runs;
  std::vector<BandPoint> from_contact,
      around_pulp;  ///< the same runs, set to zero at the contact and at the pulp
  std::vector<ToothLayer> layers;
  MeanSd pulp_s, before_n, after_n, fall_s;  ///< of the runs counted
  int counted = 0;                           ///< runs in the figures
};

/// Throws Error when the tooth has no pulp under solid tissue there.
[[nodiscard]] ToothRigResult run_tooth_rig(const Tooth& tooth, const ForceModel& force,
                                           const Bur& bur, const ToothRigOptions& options);

[[nodiscard]] Lines to_text(const ToothRigResult& result);
[[nodiscard]] nlohmann::json to_json(const ToothRigResult& result);

}  // namespace cavum
