#include "engine/explain/model_file.h"

#include <algorithm>
#include <sstream>

#include "engine/base/error.h"
#include "engine/force/term_laws.h"

namespace cavum::explain {
namespace {

using Parameters = std::vector<std::pair<std::string, double>>;

/// Numbers of a cause that stand in its shape and not among its parameters. False: no force term is that shape of it.
bool add_shape(const std::string& name, const std::vector<double>& shape, Parameters& out) {
  if (name == "stribeck_friction") out.emplace_back("v0_mm_s", k_stribeck_v0 * shape[0]);
  if (name == "relaxation") out.emplace_back("exponent", shape[2]);
  if (name == "run_out") out.emplace_back("by_clock", shape[0] < 0.5 ? 1.0 : 0.0);
  if (name == "wear") out.emplace_back("carried", shape[0] < 0.5 ? 0.0 : 1.0);
  if (name == "hysteresis") {
    if (shape[0] > 1.5) return false;  // in air too: a friction whose direction an exam's tip does not have
    out.emplace_back("gamma", shape[0] < 0.5 ? 0.5 : 0.0);
  }
  if (name == "backlash") {
    if (shape[0] < 0.5) return false;  // a play that keeps its place in air
    if (shape[0] > 1.5) out.emplace_back("ahead_mm", 0.0);
  }
  return true;
}

/// Name and parameters of the engine's force term that is this cause; empty name when it is none.
std::pair<std::string, Parameters> live_term(const Cause& cause) {
  const Mechanism& m = mechanisms()[static_cast<std::size_t>(cause.term.mechanism)];
  const std::string name = m.name;
  const TermKind* kind = find_term_kind(name);
  Parameters known;
  if (!m.live || kind == nullptr || !add_shape(name, cause.term.shape, known)) return {};
  for (const auto& [parameter, interval] : cause.parameters) known.emplace_back(parameter, interval.value);
  Parameters given;
  for (const auto& p : kind->parameters) {
    const auto found = std::find_if(known.begin(), known.end(), [&](const auto& k) { return k.first == p.name; });
    if (found == known.end()) {
      if (!p.otherwise) return {};  // the same name for another formula
      continue;
    }
    const double value = p.name == std::string("phase_turns") && found->second < 0.0 ? found->second + 1.0 : found->second;
    if (value < p.low || value > p.high) return {};
    given.emplace_back(p.name, value);
  }
  return {name, given};
}

void write(std::ostream& out, const char* key, const std::vector<double>& values) {
  out << key << " = [";
  for (std::size_t i = 0; i < values.size(); ++i) out << (i > 0 ? ", " : "") << std::showpoint << values[i] << std::noshowpoint;
  out << "]\n";
}

}  // namespace

Series terms_force_n(const ForceTerms& terms, Viscoelastic tissue, const Scene& scene) {
  const Recording& r = *scene.recording;
  const auto value = [&r](const char* name) { return r.column(name); };
  const Series *rpm = value("spindle_rpm"), *wet = value("wet"), *angle = value("approach_deg"), *warm = value("temperature_c");
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
      in.touching = scene.motion.x_mm[i] > 0.0;
      in.penetration_mm = std::max(0.0, scene.motion.x_mm[i]);
      in.approach_mm_s = scene.motion.v_mm_s[i];
      const Viscoelastic touched{tissue.stiffness_n_per_mm * (r.relative_k.size() > 0 ? r.relative_k[i] : 1.0),
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
      out[i] = force_along_feed_n(terms, in, memory) - voigt_force_n(touched, in.penetration_mm, in.approach_mm_s);
    }
  }
  return out;
}

std::string material_of(const ForceModel& model) {
  if (model.materials.contains("dentin")) return "dentin";
  for (const auto& [name, m] : model.materials)
    if (m.voigt.stiffness_n_per_mm > 0.0) return name;
  return model.materials.empty() ? "" : model.materials.begin()->first;
}

std::string extended_model_toml(const Explanation& e, const ForceModel& start) {
  std::ostringstream out;
  out.precision(17);
  out << "# Written by `cavum explain`: verdict " << e.verdict << ".\nname = \""
      << (start.name.ends_with("-extended") ? start.name : start.name + "-extended") << "\"\n\n[cutting]\nrpm_ref = " << start.rpm_ref
      << "\n\n[rendering]\nkvc_n_per_mm = " << start.rendering.kvc_n_per_mm
      << "\nfiltered_damping_n_s_per_mm = " << start.rendering.filtered_damping_n_s_per_mm << "\nspeed_filter_s = " << start.rendering.speed_filter_s
      << "\ndrag_n_per_mm = " << start.rendering.drag_n_per_mm << "\n";
  for (const auto& [name, m] : start.materials) {
    const bool resists = m.voigt.stiffness_n_per_mm > 0.0;
    out << "\n[materials." << name << "]\nk_n_per_mm = " << (resists ? std::max(0.0, e.base.k_n_per_mm) : 0.0)
        << "\nc_n_s_per_mm = " << (resists ? std::max(0.0, e.base.c_n_s_per_mm) : 0.0) << "\n";
    if (m.tau_s > 0.0) out << "tau_s = " << m.tau_s << "\n";
  }
  const auto effect = [&](const MeasurementEffect& m, const std::string& why) {
    out << "\n# " << why << "\n[[measurement]]\nkind = \"" << m.kind << "\"\n";
    write(out, "shape", m.shape);
    write(out, "values", m.values);
  };
  for (const auto& t : start.term_values) out << "\n# kept from the model that was given\n" << force_term_toml(t.kind, t.parameters);
  for (const auto& m : start.measurement) effect(m, "kept from the model that was given");
  Eigen::Index at = 2;
  for (const auto& cause : e.causes) {
    const Mechanism& m = mechanisms()[static_cast<std::size_t>(cause.term.mechanism)];
    std::vector<double> own;
    const auto count = static_cast<Eigen::Index>(m.columns(e.after->scene, cause.term.shape).own.size());
    for (Eigen::Index i = 0; i < count; ++i) own.push_back(e.after->base_fit.value[at++]);
    if (const auto [name, parameters] = live_term(cause); !name.empty())
      out << "\n# " << m.equation << ": felt in an exam too\n" << force_term_toml(name, parameters);
    else
      effect({m.name, cause.term.shape, own}, std::string(m.equation) + ": of this recording, not felt in an exam");
  }
  return out.str();
}

Series added_force_n(const ForceModel& model, const std::string& material, const Recording& r, const std::string& where) {
  Series out = Series::Zero(r.rows());
  if (model.terms.empty() && model.measurement.empty()) return out;
  const auto found = model.materials.find(material);
  if (found == model.materials.end()) throw Error(where, "has no material '" + material + "'", "name one of its materials with --material");
  const Viscoelastic tissue = found->second.voigt;
  const Motion motion = estimate_motion(r);
  const Scene scene = make_scene(r, motion, {tissue.stiffness_n_per_mm, tissue.damping_n_s_per_mm}, 0.0, 0.0);
  if (!model.terms.empty()) out += terms_force_n(model.terms, tissue, scene);
  for (const auto& effect : model.measurement) {
    const int at = find_mechanism(effect.kind);
    if (at < 0) throw Error(where, "measurement effect '" + effect.kind + "' is unknown", "remove it, or correct its kind");
    const Mechanism& m = mechanisms()[static_cast<std::size_t>(at)];
    const bool lacks = m.grid(scene).empty() && effect.kind != "chatter";
    if (lacks || m.shape.size() != effect.shape.size())
      throw Error(where, "measurement effect '" + effect.kind + "' does not fit this recording", "remove it, or add the column that it needs");
    const Columns c = m.columns(scene, effect.shape);
    if (c.own.size() != effect.values.size())
      throw Error(where, "measurement effect '" + effect.kind + "' has the wrong number of values", "explain again with --model-out");
    for (std::size_t i = 0; i < c.own.size(); ++i) out += effect.values[i] * c.own[i];
    if (c.spring.size() > 0) out += tissue.stiffness_n_per_mm * c.spring;
    if (c.damper.size() > 0) out += tissue.damping_n_s_per_mm * c.damper;
  }
  return out;
}

}  // namespace cavum::explain
