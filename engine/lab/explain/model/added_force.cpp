#include "engine/lab/explain/model/added_force.h"

#include <fmt/core.h>

#include <algorithm>
#include <stdexcept>
#include <string_view>

#include "engine/base/error.h"
#include "engine/physics/force/term_laws.h"

namespace cavum::explain {
namespace {

/// A mechanism with all its numbers.
struct Found {
  int mechanism = -1;
  Numbers numbers;
};

Series force_n(const Scene& scene, const Found& f) {
  const Columns c = mechanism_at(f.mechanism).columns(scene, f.numbers.shape);
  Series out = Series::Zero(scene.force_n.size());
  for (std::size_t i = 0; i < c.own.size(); ++i) out += f.numbers.own[i] * c.own[i];
  if (c.spring.size() > 0) out += scene.base.k_n_per_mm * c.spring;
  if (c.damper.size() > 0) out += scene.base.c_n_s_per_mm * c.damper;
  return out;
}

/// A force term as the mechanism that explain knows; none when it has a form that explain does not
/// look for.
std::optional<Found> found_as(const TermValues& term, Base base) {
  const int at = known_mechanism(term.kind);
  const Mechanism& m = mechanism_at(at);
  if (!m.from_term) return std::nullopt;
  const auto value = [&](const char* name) {
    for (const auto& [given, v] : term.parameters)
      if (given == name) return v;
    for (const auto& p : m.term->parameters)
      if (std::string_view(name) == p.name) return p.otherwise.value_or(0.0);
    throw std::logic_error(fmt::format("{} has no parameter '{}'", term.kind, name));
  };
  auto numbers = m.from_term(value, base);
  if (!numbers) return std::nullopt;
  return Found{at, std::move(*numbers)};
}

/// The scene has what the mechanism needs, and as many coefficients are given as it takes there.
bool has_columns(const Scene& scene, const Found& f) {
  const Mechanism& m = mechanism_at(f.mechanism);
  const auto& [shape, own] = f.numbers;
  return !starts(m, scene).empty() && m.shape.size() == shape.size() &&
         m.columns(scene, shape).own.size() <= own.size();
}

/// A measurement effect of the same kind that fits this recording stands for the term: it knows the
/// phase of each session.
bool fits_here(const ForceModel& model, const std::string& kind, const Scene& scene) {
  return std::any_of(model.measurement.begin(), model.measurement.end(),
                     [&](const MeasurementEffect& e) {
                       const int at = find_mechanism(e.kind);
                       if (e.kind != kind || at < 0) return false;
                       const Mechanism& m = mechanism_at(at);
                       return m.shape.size() == e.shape.size() &&
                              m.columns(scene, e.shape).own.size() == e.values.size();
                     });
}

}  // namespace

Series terms_force_n(const ForceTerms& terms, Viscoelastic tissue, const Scene& scene) {
  const Recording& r = *scene.recording;
  const auto value = [&r](const char* name) { return r.column(name); };
  const Series *rpm = value("spindle_rpm"), *wet = value("wet"), *angle = value("approach_deg"),
               *warm = value("temperature_c");
  Series removed, removed_on;
  if (value("removed_mm3") != nullptr) {
    removed = removed_since_new_mm3(scene, false);
    removed_on = removed_since_new_mm3(scene, true);
  }
  Series out = Series::Zero(r.rows());
  std::vector<TermMemory> memory(terms.size());
  for (const auto& rows : r.sessions) {
    std::fill(memory.begin(), memory.end(), TermMemory{});
    for (Eigen::Index i = rows.begin; i < rows.end; ++i) {
      TermInput in;
      in.touching = scene.motion->x_mm[i] > 0.0;
      in.penetration_mm = std::max(0.0, scene.motion->x_mm[i]);
      in.approach_mm_s = scene.motion->v_mm_s[i];
      const Viscoelastic touched{
          tissue.stiffness_n_per_mm * (r.relative_k.size() > 0 ? r.relative_k[i] : 1.0),
          tissue.damping_n_s_per_mm * (r.relative_c.size() > 0 ? r.relative_c[i] : 1.0)};
      in.stiffness_n_per_mm = touched.stiffness_n_per_mm;
      in.damping_n_s_per_mm = touched.damping_n_s_per_mm;
      in.rpm = rpm != nullptr ? (*rpm)[i] : 1.0;
      in.tick = i - rows.begin;
      in.dt_s = i > rows.begin ? scene.dt_s[i - 1] : 0.0;
      in.time_s = r.t_s[i];
      in.wet = wet != nullptr ? (*wet)[i] : in.rpm > 0.0 ? 1.0 : 0.0;
      if (removed.size() > 0) in.removed_mm3 = removed[i], in.removed_on_mm3 = removed_on[i];
      if (angle != nullptr) in.approach = twice_angle((*angle)[i]);
      if (warm != nullptr) in.warmth_known = true, in.warmer_k = (*warm)[i] - (*warm)[0];
      out[i] = force_along_feed_n(terms, in, memory) -
               voigt_force_n(touched, in.penetration_mm, in.approach_mm_s);
    }
  }
  return out;
}

Series added_force_n(const ForceModel& model, const std::string& material, const Recording& r,
                     const std::string& where) {
  Series out = Series::Zero(r.rows());
  if (model.terms.empty() && model.measurement.empty()) return out;
  const auto owner = model.materials.find(material);
  if (owner == model.materials.end())
    throw Error(where, msg("has no material '{}'", material),
                msg("name one of its materials with --material"));
  const Viscoelastic tissue = owner->second.voigt;
  const Motion motion = estimate_motion(r);
  const Scene scene =
      make_scene(r, motion, {tissue.stiffness_n_per_mm, tissue.damping_n_s_per_mm}, 0.0, 0.0);
  const Base base{tissue.stiffness_n_per_mm, tissue.damping_n_s_per_mm};
  ForceTerms others;
  for (std::size_t i = 0; i < model.terms.size(); ++i) {
    const auto found =
        i < model.term_values.size() ? found_as(model.term_values[i], base) : std::nullopt;
    if (i < model.term_values.size() && fits_here(model, model.term_values[i].kind, scene))
      continue;
    if (found && has_columns(scene, *found))
      out += force_n(scene, *found);
    else
      others.push_back(model.terms[i]);
  }
  if (!others.empty()) out += terms_force_n(others, tissue, scene);
  for (const auto& effect : model.measurement) {
    const int at = find_mechanism(effect.kind);
    if (at < 0)
      throw Error(where, msg("measurement effect '{}' is unknown", effect.kind),
                  msg("remove it, or correct its kind"));
    const bool a_term = std::any_of(model.term_values.begin(), model.term_values.end(),
                                    [&](const TermValues& t) { return t.kind == effect.kind; });
    if (a_term && !fits_here(model, effect.kind, scene))
      continue;  // another recording: the term itself counts
    const Mechanism& m = mechanism_at(at);
    const bool lacks = starts(m, scene).empty() && !m.from_residual;
    if (lacks || m.shape.size() != effect.shape.size())
      throw Error(where, msg("measurement effect '{}' does not fit this recording", effect.kind),
                  msg("remove it, or add the column that it needs"));
    if (m.columns(scene, effect.shape).own.size() != effect.values.size())
      throw Error(where, msg("measurement effect '{}' has the wrong number of values", effect.kind),
                  msg("explain again with --model-out"));
    out += force_n(scene, {at, {effect.shape, effect.values}});
  }
  return out;
}

}  // namespace cavum::explain
