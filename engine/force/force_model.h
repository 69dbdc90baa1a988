// A force model: the materials of the tissues, the law of cutting, force terms beyond the Voigt law, and the
// constants of rendering. It is a TOML file read by the exam and the rigs alike; two ship in data/materials.
#pragma once

#include <map>
#include <string>
#include <vector>

#include "engine/force/force_terms.h"
#include "engine/force/rendering.h"
#include "engine/force/voigt.h"

namespace cavum {

struct Material {
  Viscoelastic voigt;
  double tau_s = 0.0;  ///< the surface recedes at X/τ at the reference speed; 0 = not cut (void tissue)
};

/// What a measurement adds to the force, found by `explain` in recorded data (bias, cross-talk, a lag …): the hand does not feel
/// it, so exams and rigs pass over it; `explain` takes it off before it looks for more.
struct MeasurementEffect {
  std::string kind;            ///< a mechanism of engine/explain
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
  double rpm_ref = 200000.0;  ///< speed of the handpiece that τ holds for; recession is proportional to speed
  RenderingModel rendering;
  std::map<std::string, Material, std::less<>> materials;  ///< by tissue name
  ForceTerms terms;                                        ///< [[terms]] in the order of the file; shared by copies, constant
  std::vector<TermValues> term_values;                     ///< of `terms`, in the same order
  std::vector<MeasurementEffect> measurement;              ///< [[measurement]]
};

/// Throws Error(where:line:column, ...) on anything missing, unknown or out of range.
[[nodiscard]] ForceModel parse_force_model(const std::string& text, const std::string& where);

}  // namespace cavum
