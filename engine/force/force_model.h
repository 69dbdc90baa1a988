// A force model: the materials of the tissues, the law of cutting, force terms beyond the Voigt law, and the
// constants of rendering. It is a TOML file read by the exam and the rigs alike; two ship in data/materials.
#pragma once

#include <map>
#include <string>

#include "engine/force/force_terms.h"
#include "engine/force/rendering.h"
#include "engine/force/voigt.h"

namespace cavum {

struct Material {
  Viscoelastic voigt;
  double tau_s = 0.0;  ///< the surface recedes at X/τ at the reference speed; 0 = not cut (void tissue)
};

struct ForceModel {
  std::string name;
  double rpm_ref = 200000.0;  ///< speed of the handpiece that τ holds for; recession is proportional to speed
  RenderingModel rendering;
  std::map<std::string, Material, std::less<>> materials;  ///< by tissue name
  ForceTerms terms;                                        ///< [[terms]] in the order of the file; shared by copies, constant
};

/// Throws Error(where:line:column, ...) on anything missing, unknown or out of range.
[[nodiscard]] ForceModel parse_force_model(const std::string& text, const std::string& where);

}  // namespace cavum
