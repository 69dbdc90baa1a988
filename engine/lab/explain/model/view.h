// One look at a recording with the causes known so far: motion, base force, noise, what differs
// between sessions, weights, and the products of all hypotheses, ready for the search.
#pragma once

#include <memory>

#include "engine/base/shared_value.h"
#include "engine/lab/explain/model/curves.h"
#include "engine/lab/explain/model/fit.h"
#include "engine/lab/explain/model/session_effects.h"
#include "engine/lab/explain/model/white_table.h"

namespace cavum::explain {

/// A curve whose columns are in the products.
struct CurveHypothesis {
  std::string variable;
  Message form;
  Eigen::Index first = 0, count = 0;
  Eigen::MatrixXd mean_products;  ///< of the columns as they are, [count, count]
};

/// Copies share what is large.
struct View {
  Shared<Scene> scene;
  Noise noise;
  Shared<Series>
      force_n;  ///< what is to be explained: measured force less the fixed forces of a loaded model
  Shared<Series> robust;  ///< weights of single rows
  std::vector<Term> causes;
  FitResult base_fit;      ///< k, c and the causes' coefficients (no tangents)
  Shared<Series> model_n;  ///< their force, [rows]
  SessionSpread spread{};  ///< between sessions
  Shared<EffectColumns> effects, white_effects;  ///< session_columns, raw and whitened
  Shared<Series> session_n;                      ///< force of what differs between sessions, [rows]
  Shared<Series> residual_n;                     ///< force − model − session_n
  std::vector<Hypothesis> grid;                  ///< all mechanisms at all points of their grids
  std::vector<Hypothesis> known;                 ///< the causes, with tangents
  std::vector<CurveHypothesis> curves;           ///< of every variable
  Shared<Products> products;
  std::shared_ptr<const WhiteTable>
      white;  ///< all columns of the products; let go when the surrogates are scored
  std::vector<std::pair<Eigen::Index, Eigen::Index>>
      folds;  ///< rows [begin, end) that are left out together; products.folds follows them
};

/// At most 12 folds: sessions, neighbouring ones together when there are more; five stretches when
/// there is one session, too short to be cut in stretches (stretches.h).
[[nodiscard]] std::vector<std::pair<Eigen::Index, Eigen::Index>> folds_of(
    const Recording& recording);

/// The base and `causes` fitted, nothing else. `motion` as estimate_motion gives it. `fixed_n`:
/// forces of a loaded model, [rows]; nullptr = none.
[[nodiscard]] View make_view(const Recording& recording, const Shared<Motion>& motion,
                             const std::vector<Term>& causes, const Series* fixed_n = nullptr);
/// Looks for lines in what is left: candidates of the grid.
void find_lines(View& view);
/// The grid, the curves and their products; after the lines.
void add_products(View& view);

/// The view with contact lost where base and `causes` together would pull, as they fit now; weights
/// and noise stay, so that chi² can be compared.
[[nodiscard]] View without_pulling(const View& view, const std::vector<Term>& causes);
/// k and c of the fit. A damper that pushes is an offset in disguise (no contact is lost by it): c
/// is 0 then.
[[nodiscard]] inline Base base_of(const View& v) {
  return {std::max(1e-9, v.base_fit.value[0]), std::max(0.0, v.base_fit.value[1])};
}
/// Whitening as the view's products were made with.
[[nodiscard]] Whitening whitening_of(const View& view);
/// Force of causes at given values (in the order of FitResult), on any scene.
[[nodiscard]] Series force_of(const Scene& scene, const std::vector<Term>& causes,
                              const Eigen::VectorXd& value);
/// Numerical derivatives of a term's force by its fitted shapes, in the order of the shapes; k, c
/// and own coefficients given.
[[nodiscard]] std::vector<Series> tangents_of(const Scene& scene, const Term& term,
                                              const std::vector<double>& own, Base base);
/// Pointers to the causes of a view, as `fit` takes them; good as long as the view.
[[nodiscard]] inline std::vector<const Hypothesis*> known_of(const View& v) {
  std::vector<const Hypothesis*> out;
  for (const auto& h : v.known) out.push_back(&h);
  return out;
}

}  // namespace cavum::explain
