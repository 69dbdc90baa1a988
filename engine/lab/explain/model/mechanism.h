// The mechanisms that a simulation may lack, one unit each: what force it adds, on which shape
// parameters that force depends, and what its coefficients mean. All are linear but for the few
// shape parameters, so they are fitted together with k and c (variable projection, Golub and
// Pereyra 1973) and never to a frozen residual. Formulae and sources: docs/laws.md.
#pragma once

#include <functional>
#include <limits>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "engine/lab/explain/model/scene.h"
#include "engine/physics/force/term_kinds.h"

namespace cavum::explain {

/// What a mechanism puts into the fit, each of shape [rows].
struct Columns {
  std::vector<Series> own;  ///< each with a coefficient of its own
  Series spring, damper;  ///< added to the columns of k and of c, when it changes what they act on;
                          ///< empty = nothing
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

/// A mechanism's shape parameters and own coefficients, in order.
struct Numbers {
  std::vector<double> shape, own;
};

/// Parameters of a force term by name.
using TermParameters = std::vector<std::pair<std::string, double>>;
/// The same to read from: one that was not given has its default.
using TermReader = std::function<double(const char* name)>;

/// What is left of a mechanism's mark when the motion goes in one direction only (in one direction
/// friction is an offset, and so is an edge force).
enum class OneWay {
  told,               ///< it is told apart all the same
  needs_reversal,     ///< it is not, and is named as the offset that fits best
  looks_like_offset,  ///< it is a constant offset there
  is_offset  ///< it is the constant offset itself: tried there although c can take its place, lest
             ///< another be named for want of it
};

/// Range of every own coefficient, exclusive. A fit that needs another value is another mechanism
/// in disguise.
struct OwnRange {
  double low = -std::numeric_limits<double>::infinity(),
         high = std::numeric_limits<double>::infinity();
};
/// Friction resists, mass is positive, static friction exceeds sliding.
inline constexpr OwnRange k_positive{0.0, std::numeric_limits<double>::infinity()};

/// One record for each law: all that the force model, the exam, the rigs, `explain` and its manual
/// know of it. A new one is a record in a family's file; docs/laws.md is made of them. What is left
/// out does not apply.
struct Mechanism {
  const char* name = nullptr;
  const char* equation = nullptr;  ///< of the force it adds
  const char* words =
      nullptr;  ///< what it means, for a person: completes "the simulation lacks ..."
  const char* separate = nullptr;  ///< the experiment that shows it best
  /// What its picture shows it over: a column of the recording, x_mm, v_mm_s, t_s, a_mm_s2 or
  /// simulated_n (the base force); null: its own force.
  const char* seen_over = nullptr;
  const TermKind* term = nullptr;  ///< acts in a live exam too, as the force term of its name
                                   ///< (term_laws.h); null: only in the measurement

  // What it takes to show it
  std::vector<const char*> needs{};  ///< columns of the recording of which one must be there
  std::vector<ShapeRange> shape{};
  /// Ends of the first shape's range that these data set; none: the range's own.
  std::function<std::pair<double, double>(const Scene&)> ends{};
  /// Points of the shape to start from, each of the size of `shape`; called when `needs` are there.
  /// Empty: these data cannot show it. Left out: a law without shape can always be shown.
  std::function<std::vector<std::vector<double>>(const Scene&)> grid{};
  std::function<Columns(const Scene&, const std::vector<double>& shape)> columns{};
  std::vector<const char*>
      coefficients{};  ///< names of the own coefficients, where those are parameters as they are
  /// Parameters in the names of the formula, from shape and own coefficients; left out:
  /// `coefficients`, and the fitted numbers of the shape.
  std::function<std::vector<NamedValue>(const std::vector<double>& shape,
                                        const std::vector<double>& own, Base base)>
      parameters{};

  /// Standard deviation of its parameters that is left open by rows being apart, whatever the
  /// noise; none: nothing.
  std::function<double(const Scene&)> open{};

  // To and from a force term
  /// The inverse of `parameters`, from the force term; none when the term has a form that no shape
  /// is. Left out: as `parameters` left out.
  std::function<std::optional<Numbers>(const TermReader& value, Base base)> from_term{};
  /// Adds the term's parameters that stand in the shape and not in `parameters`. False: no force
  /// term is that shape.
  std::function<bool(const std::vector<double>& shape, TermParameters& out)> shape_in_term{};

  // What tells it from others
  OwnRange own{};
  const char* variant_of =
      nullptr;  ///< the law whose variant it is: a model holds one of them at most
  /// A law with fewer numbers that it becomes at an end of its range: the one to name when the data
  /// do not tell more.
  const char* plainer = nullptr;
  /// Two parameters of which the first must lie above the second for sure, or nothing is there
  /// beyond the plainer law.
  std::pair<const char*, const char*> must_exceed{};
  /// Its own coefficients are several of one kind (channels, sessions): one that is there is
  /// enough.
  bool several = false;
  OneWay one_way = OneWay::told;
  const char* like_when_short = nullptr;  ///< a lag in tau_s: the one that cannot be told from it
                                          ///< when both are shorter than the data resolve
  const char* way = nullptr;  ///< its parameter that is a way, mm: one shorter than the positions
                              ///< resolve is not told from a dry friction
  /// A shape that goes by another law's name as well; nullptr: it does not.
  std::function<const char*(const std::vector<double>& shape)> same_as{};
  bool in_recordings = true;  ///< false: no recording of k and c can show it, whatever the motion
  bool from_residual =
      false;  ///< its grid is what this recording's residual shows: given as known, it needs none
  /// A shape with fewer numbers to start from as well; empty: none.
  std::function<std::vector<double>(const std::vector<double>& shape)> simpler{};

  /// The columns come session after session, the same number for each: what they share is no
  /// coefficient (a phase differs from session to session).
  bool by_session = false;
  /// Acts inside max(0, ...) of the contact, which never pulls; otherwise it is added to it.
  bool inside = false;
};

/// All of them, in fixed order. Throws std::logic_error when a record lacks what all must have, two
/// have one name, a name that one gives another is nobody's, or the force terms that they name are
/// not all that there are.
[[nodiscard]] const std::vector<Mechanism>& mechanisms();
[[nodiscard]] inline const Mechanism& mechanism_at(int at) {
  return mechanisms()[static_cast<std::size_t>(at)];
}
/// Position in `mechanisms()`; -1 when there is none of that name.
[[nodiscard]] int find_mechanism(const std::string& name);
/// Position of one that must be there. Throws std::logic_error when it is not.
[[nodiscard]] int known_mechanism(const std::string& name);

/// Points of the shape to start from; empty: these data lack what it needs.
[[nodiscard]] std::vector<std::vector<double>> starts(const Mechanism& mechanism,
                                                      const Scene& scene);
/// Ranges of the shape in which these data are searched.
[[nodiscard]] std::vector<ShapeRange> ranges_of(const Mechanism& mechanism, const Scene& scene);
/// Sessions that have coefficients of their own in a mechanism with `by_session`: all, when there
/// are 2 to 12 of them; else 1, for all rows together.
[[nodiscard]] std::size_t session_groups(const Recording& recording);
/// True when own coefficients are within the mechanism's range.
[[nodiscard]] bool makes_sense(const Mechanism& mechanism, const double* own, std::size_t count);
/// Mechanisms that are variants of one law, of which a model holds one at most; the same number =
/// the same law, else unique.
[[nodiscard]] int law_of(int mechanism);
/// A constant offset when the motion goes one way.
[[nodiscard]] inline bool is_offset(const Mechanism& m) {
  return m.one_way == OneWay::looks_like_offset || m.one_way == OneWay::is_offset;
}
/// Known only where the motion turns back.
[[nodiscard]] inline bool needs_reversal(const Mechanism& m) { return m.one_way != OneWay::told; }

/// Volume that the bur had removed since it was new, mm³, shape [rows], from the columns
/// removed_mm3 (which must be there) and bur_id. `carried`: it goes on where a session begins to
/// count anew with the same bur.
[[nodiscard]] Series removed_since_new_mm3(const Scene& scene, bool carried);

// Families, one file each; together they are `mechanisms()`, in this order (docs/laws.md).
[[nodiscard]] std::vector<Mechanism> offset_mechanisms();
[[nodiscard]] std::vector<Mechanism> friction_mechanisms();
[[nodiscard]] std::vector<Mechanism> sensor_mechanisms();
[[nodiscard]] std::vector<Mechanism> play_mechanisms();
[[nodiscard]] std::vector<Mechanism> tissue_mechanisms();
[[nodiscard]] std::vector<Mechanism> cutting_mechanisms();

}  // namespace cavum::explain
