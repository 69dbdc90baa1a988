#include "engine/explain/model_file.h"

#include <algorithm>
#include <sstream>

#include "engine/base/error.h"

namespace cavum::explain {
namespace {

/// Name and parameters of the engine's force term that is this cause; empty name when it is none.
std::pair<std::string, std::vector<std::pair<std::string, double>>> live_term(const Cause& cause) {
  const Mechanism& m = mechanisms()[static_cast<std::size_t>(cause.term.mechanism)];
  const std::string name = m.name;
  const TermKind* kind = find_term_kind(name);
  if (!m.live || kind == nullptr) return {};
  if (name == "run_out" && cause.term.shape[0] < 0.5) return {};      // phase by the clock, not by the spindle's turns
  if (name == "relaxation" && cause.term.shape[2] != 1.0) return {};  // the engine's relaxes in proportion to X
  std::vector<std::pair<std::string, double>> parameters;
  for (const auto& p : kind->parameters) {
    const auto found = std::find_if(cause.parameters.begin(), cause.parameters.end(), [&](const auto& c) { return c.first == p.name; });
    if (found == cause.parameters.end()) {
      if (!p.otherwise) return {};  // the same name for another formula
      continue;
    }
    double value = found->second.value;
    if (name == "run_out" && p.name == std::string("phase_turns") && value < 0.0) value += 1.0;
    if (value < p.low || value > p.high) return {};
    parameters.emplace_back(p.name, value);
  }
  return {name, parameters};
}

void write(std::ostream& out, const char* key, const std::vector<double>& values) {
  out << key << " = [";
  for (std::size_t i = 0; i < values.size(); ++i) out << (i > 0 ? ", " : "") << std::showpoint << values[i] << std::noshowpoint;
  out << "]\n";
}

}  // namespace

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
  const Series* rpm = r.column("spindle_rpm");
  std::vector<TermMemory> memory(model.terms.size());
  for (const auto& rows : r.sessions) {
    std::fill(memory.begin(), memory.end(), TermMemory{});
    for (Eigen::Index i = rows.begin; i < rows.end && !model.terms.empty(); ++i) {
      TermInput in;
      in.touching = motion.x_mm[i] > 0.0;
      in.penetration_mm = std::max(0.0, motion.x_mm[i]);
      in.approach_mm_s = motion.v_mm_s[i];
      in.stiffness_n_per_mm = tissue.stiffness_n_per_mm;
      in.damping_n_s_per_mm = tissue.damping_n_s_per_mm;
      in.rpm = rpm != nullptr ? (*rpm)[i] : 1.0;  // without that column the tool is taken to spin
      in.tick = i - rows.begin;
      in.dt_s = i > rows.begin ? scene.dt_s[i - 1] : 0.0;
      out[i] += force_along_feed_n(model.terms, in, memory) - voigt_force_n(tissue, in.penetration_mm, in.approach_mm_s);
    }
  }
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
