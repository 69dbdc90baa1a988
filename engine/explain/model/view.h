// One look at a recording with the causes known so far: motion, base force, noise, what differs between sessions, weights, and the products of all
// hypotheses, ready for the search.
#pragma once

#include <memory>

#include "engine/explain/model/curves.h"
#include "engine/explain/model/fit.h"
#include "engine/explain/model/session_effects.h"

namespace cavum::explain {

/// A curve whose columns are in the products.
struct CurveHypothesis {
  std::string variable, form;
  Eigen::Index first = 0, count = 0;
  Eigen::MatrixXd mean_products;  ///< of the columns as they are, [count, count]
};

/// Products of a session's columns with its effects, for surrogates.
struct SessionProducts {
  Eigen::Index begin = 0, end = 0;  ///< rows
  Eigen::MatrixXd with_effects;     ///< [columns, effects]
  Eigen::MatrixXd effects;          ///< [effects, effects]
};

struct View {
  Scene scene;
  Noise noise;
  Series force_n;  ///< what is to be explained: measured force less the fixed forces of a loaded model
  Series robust;   ///< weights of single rows
  std::vector<Term> causes;
  FitResult base_fit;                      ///< k, c and the causes' coefficients (no tangents)
  Series model_n;                          ///< their force, [rows]
  SessionSpread spread{};                  ///< between sessions
  Eigen::MatrixXd effects, white_effects;  ///< session_columns, raw and whitened
  Series session_n;                        ///< force of what differs between sessions, [rows]
  Series residual_n;                       ///< force − model − session_n
  std::vector<Hypothesis> grid;            ///< all mechanisms at all points of their grids
  std::vector<Hypothesis> known;           ///< the causes, with tangents
  std::vector<CurveHypothesis> curves;     ///< of every variable
  Products products;
  std::vector<SessionProducts> by_session;
  std::shared_ptr<const Eigen::MatrixXf> white;  ///< all columns of the products, whitened, [rows, columns]; let go when the surrogates are scored
  std::vector<std::pair<Eigen::Index, Eigen::Index>> folds;  ///< rows [begin, end) that are left out together; products.folds follows them
};

/// At most 12 folds: sessions, neighbouring ones together when there are more; five stretches when there is one session.
[[nodiscard]] std::vector<std::pair<Eigen::Index, Eigen::Index>> folds_of(const Recording& recording);

struct ViewOptions {
  bool products = true;             ///< false: only the base and the causes are fitted
  const Series* fixed_n = nullptr;  ///< forces of a loaded model, [rows]; nullptr = none
};

/// `motion` as estimate_motion gives it. `start`: k and c to begin with; none = the rig's, or found from the data.
[[nodiscard]] View make_view(const Recording& recording, const Motion& motion, const std::vector<Term>& causes, std::optional<Base> start = {},
                             const ViewOptions& options = {});

/// The view with contact lost where base and `causes` together would pull, as they fit now; weights and noise stay, so that chi² can be compared.
[[nodiscard]] View without_pulling(const View& view, const std::vector<Term>& causes);
/// Whitening as the view's products were made with.
[[nodiscard]] Whitening whitening_of(const View& view);
/// Force of causes at given values (in the order of FitResult), on any scene.
[[nodiscard]] Series force_of(const Scene& scene, const std::vector<Term>& causes, const Eigen::VectorXd& value);
/// Numerical derivatives of a term's force by its fitted shapes, in the order of the shapes; k, c and own coefficients given.
[[nodiscard]] std::vector<Series> tangents_of(const Scene& scene, const Term& term, const std::vector<double>& own, Base base);
/// Fit of the base and `causes` alone, with columns computed anew: for refining shapes. Same whitening as the view's.
[[nodiscard]] FitResult fit_terms(const View& view, const std::vector<Term>& causes, bool covariance = false);

/// Pointers to the causes of a view, as `fit` takes them; good as long as the view.
[[nodiscard]] inline std::vector<const Hypothesis*> known_of(const View& v) {
  std::vector<const Hypothesis*> out;
  for (const auto& h : v.known) out.push_back(&h);
  return out;
}

}  // namespace cavum::explain
