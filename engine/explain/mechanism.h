// The mechanisms that a simulation may lack, one unit each: what force it adds, on which shape parameters that force
// depends, and what its coefficients mean. All are linear but for the few shape parameters, so they are fitted
// together with k and c (variable projection, Golub and Pereyra 1973) and never to a frozen residual.
// Formulae and names: PHYSICS.md section 4.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "engine/explain/scene.h"

namespace cavum::explain {

/// What a mechanism puts into the fit, each of shape [rows].
struct Columns {
  std::vector<Series> own;  ///< each with a coefficient of its own
  Series spring, damper;    ///< added to the columns of k and of c, when it changes what they act on; empty = nothing
};

/// One shape parameter: a number that enters other than linearly.
struct ShapeRange {
  const char* name;          ///< ends in its unit
  double low = 0, high = 0;  ///< the search stays inside
  bool logarithmic = true;
  bool fitted = true;  ///< false: a variant of the formula, tried but not refined
};

/// A fitted or assumed number of a mechanism.
struct NamedValue {
  std::string name;
  double value = 0;
};

struct Mechanism {
  const char* name;      ///< as in DESIGN.md section 7
  const char* equation;  ///< of the force it adds
  const char* words;     ///< what it means, for a person: completes "the simulation lacks ..."
  const char* separate;  ///< the experiment that shows it best
  bool live;             ///< acts in a live exam too (a force term), or only in the measurement
  std::vector<ShapeRange> shape;
  /// Points of the shape to start from, each of the size of `shape`. Empty: these data lack what it needs.
  std::function<std::vector<std::vector<double>>(const Scene&)> grid;
  std::function<Columns(const Scene&, const std::vector<double>& shape)> columns;
  /// Parameters in the names of the formula, from shape and own coefficients.
  std::function<std::vector<NamedValue>(const std::vector<double>& shape, const std::vector<double>& own, Base base)> parameters;
  /// The columns come session after session, the same number for each: what they share is no coefficient (a phase differs from session to session).
  bool by_session = false;
  /// Acts inside max(0, ...) of the contact, which never pulls; otherwise it is added to it.
  bool inside = false;
};

/// Sessions that have coefficients of their own in a mechanism with `by_session`: all, when there are 2 to 12 of them; else 1, for all rows together.
[[nodiscard]] std::size_t session_groups(const Recording& recording);

/// True when own coefficients make sense for the mechanism: friction resists, mass is positive, static friction exceeds sliding.
/// A fit that needs the opposite is another mechanism in disguise.
[[nodiscard]] bool makes_sense(const Mechanism& mechanism, const double* own, std::size_t count);
/// Mechanisms that are variants of one law, of which a model holds one at most; the same number = the same law, else unique.
[[nodiscard]] int law_of(int mechanism);

/// All of them in the order of DESIGN.md; constant.
[[nodiscard]] const std::vector<Mechanism>& mechanisms();
/// Position in `mechanisms()`; -1 when there is none of that name.
[[nodiscard]] int find_mechanism(const std::string& name);

/// Volume that the diamond point had removed since it was new, mm³, shape [rows], from the columns removed_mm3 (which must be there) and
/// bur_id. `carried`: it goes on where a session begins to count anew with the same point.
[[nodiscard]] Series removed_since_new_mm3(const Scene& scene, bool carried);

// Families, one file each.
[[nodiscard]] std::vector<Mechanism> sensor_mechanisms();    ///< bias drift gain_error cross_talk delay low_pass saturation gravity_posture inertia
[[nodiscard]] std::vector<Mechanism> friction_mechanisms();  ///< coulomb_friction stribeck_friction viscous_friction backlash hysteresis
[[nodiscard]] std::vector<Mechanism> tissue_mechanisms();    ///< series_compliance nonlinear_stiffness hidden_layer graded_stiffness relaxation …
[[nodiscard]] std::vector<Mechanism> cutting_mechanisms();   ///< edge_force wear run_out chatter coolant thermal_softening

}  // namespace cavum::explain
