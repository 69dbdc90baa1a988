// What differs from session to session without being a mechanism: the zero of the force, the place
// of the surface, how stiff the site is, how late the force comes, how strong the causes are. Each
// session draws its own, with a spread that is found from the data; so a session counts as one
// piece of evidence, however many rows it has. Integrated out of the products of columns, session
// by session. Sources: mixed model of Laird and Ware 1982; spreads by expectation maximisation
// (Dempster, Laird and Rubin 1977).
#pragma once

#include <Eigen/Core>
#include <array>
#include <vector>

#include "engine/lab/explain/model/scene.h"
#include "engine/lab/explain/recording/noise.h"

namespace cavum::explain {

enum SessionEffect : std::size_t {
  k_force_zero,        ///< N, in air too
  k_surface_position,  ///< mm: F(X + delta), to first order
  k_stiffness,         ///< relative, of the base force
  k_lateness,          ///< s: F(t - tau), to first order; c that differs looks the same
  k_strength,          ///< relative, of the force of the causes
  k_session_effects
};

/// Standard deviation of each effect between sessions; 0 = they are alike.
using SessionSpread = std::array<double, k_session_effects>;

/// In single precision, for they are many and only spreads hang on them.
using EffectColumns = Eigen::MatrixXf;

/// Columns of the effects, raw, shape [rows, k_session_effects]; a session's rows are its own.
/// `causes_n`: force of the causes, [rows], or empty.
[[nodiscard]] EffectColumns session_columns(const Scene& scene, const Series& causes_n);

/// (effects + spread^-2)^-1, zero where the spread is; and log det(1 + spread effects spread).
/// `effects`: products of a session's whitened effects.
[[nodiscard]] Eigen::MatrixXd shrunk_inverse(const Eigen::MatrixXd& effects,
                                             const SessionSpread& spread, double& log_det);

/// Spread that makes the whitened residual [rows] likeliest, from the whitened effects [rows,
/// effects]. All 0 with fewer than three sessions.
[[nodiscard]] SessionSpread estimate_spread(const Recording& recording,
                                            const EffectColumns& white_effects,
                                            const Series& white_residual);

/// The effects of each session as the residual shows them, times `raw`: their force, [rows].
[[nodiscard]] Series session_force_n(const Recording& recording, const EffectColumns& raw,
                                     const EffectColumns& white_effects,
                                     const Series& white_residual, const SessionSpread& spread);

/// `spread` itself, each of its effects smaller and away, and all away (last): a cause may explain
/// what the sessions differ in.
[[nodiscard]] std::vector<SessionSpread> narrower_spreads(const SessionSpread& spread);

}  // namespace cavum::explain
