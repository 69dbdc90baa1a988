// A force model: the materials of the tissues, the law of cutting, force terms beyond the Voigt
// law, and the constants of rendering. It is a TOML file read by the exam and the rigs alike; three
// ship in data/materials.
#pragma once

#include <map>
#include <string>
#include <vector>

#include "engine/physics/force/force_terms.h"
#include "engine/physics/force/rendering.h"
#include "engine/physics/force/voigt.h"

namespace cavum {

/// How fast the surface recedes under the coated head (docs/physics.md section 8): one of the two,
/// for all tissues of a model.
enum class CuttingLaw {
  penetration,  ///< X/τ · rpm/rpm_ref: what the HAP-DENT paper's line asks for
  pressure,     ///< Preston 1927: wear rate · pressure · speed of the coating
};

struct Material {
  Viscoelastic voigt;
  double tau_s = 0.0;  ///< law `penetration`: the surface recedes at X/τ at the reference speed; 0
                       ///< = not cut (void tissue)
  double wear_mm3_per_n_m = 0.0;  ///< law `pressure`: K, volume removed for each newton and each
                                  ///< metre that the coating slid; 0 = not cut
};

/// What turns the bur. Its torque falls in proportion to how far the speed is below what the pedal
/// asks for: T = torque · clamp((wanted − rpm)/slip, −1, 1). An air turbine is slow to give torque
/// (slip: its free speed), an electric motor quick (1 %).
struct HandpieceDrive {
  double torque_n_mm = 0.0;  ///< the most it gives, at the bur; a turbine's stall torque. 0 = speed
                             ///< follows the pedal whatever the load
  double slip_rpm = 1.0;     ///< so far does the speed fall under that torque
};

/// What a measurement adds to the force, found by `explain` in recorded data (bias, cross-talk, a
/// lag …): the hand does not feel it, so exams and rigs pass over it; `explain` takes it off before
/// it looks for more.
struct MeasurementEffect {
  std::string kind;            ///< a mechanism of engine/lab/explain
  std::vector<double> shape;   ///< its shape parameters, in order
  std::vector<double> values;  ///< its coefficients, in order
};

/// A force term as the file gives it, for writing it again.
struct TermValues {
  std::string kind;
  std::vector<std::pair<std::string, double>> parameters;  ///< those that were given
};

struct ForceModel {
  std::string name;
  CuttingLaw law = CuttingLaw::penetration;
  double rpm_ref = 200000.0;  ///< law `penetration`: speed of the handpiece that τ holds for;
                              ///< recession is proportional to speed
  double force_ratio = 0.0;   ///< law `pressure`: force along the sliding over force into the
                              ///< surface; it makes the torque
  HandpieceDrive drive;       ///< [handpiece], with law `pressure` only
  RenderingModel rendering;
  std::map<std::string, Material, std::less<>> materials;  ///< by tissue name
  ForceTerms terms;  ///< [[terms]] in the order of the file; shared by copies, constant
  std::vector<TermValues> term_values;         ///< of `terms`, in the same order
  std::vector<MeasurementEffect> measurement;  ///< [[measurement]]
};

/// Throws Error(where:line:column, ...) on anything missing, unknown or out of range.
[[nodiscard]] ForceModel parse_force_model(const std::string& text, const std::string& where);

}  // namespace cavum
