// The paper's virtual-cube experiment (its Fig. 6 and eq. 6): a stylus on a testing machine cuts
// cubes of stiffness k at 0.25 mm/s, many times, and the steady force over k is fitted by a line.
// Beside it a fit with a √k term, for that is what the published damping c = 2√k must add at
// constant speed.
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

#include "engine/base/lines.h"
#include "engine/base/statistics.h"
#include "engine/lab/rig/testing_machine.h"

namespace cavum {

/// A material set under test: its "dentin" is given every k of the experiment, with its own damping
/// ratio.
struct CubeModel {
  std::string name;  ///< for tables: "paper", "consistent", or a file
  ForceModel force;
};

struct CubeOptions {
  std::vector<double> k_n_per_mm{0.0, 0.2, 0.4, 0.6, 0.8, 1.0, 1.2};
  int runs = 20;
  std::uint64_t seed = 1;
  MachineSettings machine;
  double recorded_k_n_per_mm =
      -1.0;  ///< runs of the first model at this k are kept as recordings; -1 = none
};

/// A reading of the machine at 100 Hz, as its CSV holds it.
struct CubeReading {
  double t_s = 0, x_mm = 0;  ///< X; in air minus the distance to the cube
  double v_mm_s = 0, f_n = 0, spindle_rpm = 0, removed_mm3 = 0;
};

struct CubeRun {
  Vec3 start_mm;      ///< tip before the run; the cube's top is z = 0
  double mean_n = 0;  ///< load cell over the window, with joint friction and the cell's errors
  double penetration_mm = 0;  ///< X, mean over the window
  double trend_n_per_s = 0;   ///< slope of the force within the window: is it steady?
  std::uint16_t notices = 0;  ///< TickNotice bits of the servo's safety during the run
  double friction_n = 0;      ///< of the joints, contained in mean_n
  bool steady = false;  ///< X within 10 % of V τ; otherwise the head is held in its hole, and the
                        ///< run is left out of the figures
  std::vector<CubeReading> recording;
};

/// All runs of one model at one k; the figures are those of the steady runs.
struct CubeRow {
  double k_n_per_mm = 0, c_n_s_per_mm = 0;
  double seconds = 0;        ///< of contact: six times the slower of τ and c/Kvc
  double depth_mm = 0;       ///< feed in contact
  MeanSd with, without;      ///< force, N, with and without joint friction, over the runs
  MeanSd penetration;        ///< X, mm
  double expected_n = 0;     ///< k V τ + c V: the closed form, without friction
  double trend_n_per_s = 0;  ///< largest of the runs
  std::uint16_t notices = 0;
  int left_out = 0;  ///< runs that were not steady
  std::vector<CubeRun> runs;
};

/// F over k, all runs of a model: a line, and a line with √k.
struct CubeFit {
  Fit line;           ///< value[0] slope, mm; value[1] intercept, N
  Fit with_root;      ///< value[0] slope, value[1] intercept, value[2] of √k
  double bend_n = 0;  ///< largest departure of a mean force from the line
};

struct CubeSet {
  std::string name;
  double damping_ratio = 0;  ///< c/√k of the model, in the paper's units (2 h)
  double tau_s = 0;
  std::vector<CubeRow> rows;
  CubeFit with, without;  ///< joint friction
};

struct CubeResult {
  CubeOptions options;
  std::vector<CubeSet> sets;
};

/// Throws Error when a model has no material "dentin" with k, c and τ.
[[nodiscard]] CubeResult run_cube_rig(const std::vector<CubeModel>& models, const Bur& bur,
                                      const CubeOptions& options);

/// Whether a set's forces leave a straight line by more than the scatter of a run, with a √k term
/// that is not nothing.
[[nodiscard]] bool is_bent(const CubeSet& set);
/// What the figures say, sentence by sentence: slope, intercept, curvature; about friction and
/// about c.
[[nodiscard]] std::vector<Message> cube_reading(const CubeResult& result);
[[nodiscard]] Lines to_text(const CubeResult& result);
[[nodiscard]] nlohmann::json to_json(const CubeResult& result);
/// The kept recordings: session,t_s,x_mm,f_n and more columns. Empty text when none were kept.
[[nodiscard]] std::string recordings_csv(const CubeResult& result);
/// rig.toml to stand beside it.
[[nodiscard]] std::string recordings_rig_toml(const CubeResult& result);

}  // namespace cavum
