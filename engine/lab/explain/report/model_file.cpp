#include "engine/lab/explain/report/model_file.h"

#include <fmt/core.h>

#include <algorithm>
#include <nlohmann/json.hpp>
#include <sstream>

#include "engine/base/error.h"
#include "engine/base/text.h"

namespace cavum::explain {
namespace {

/// Name and parameters of the engine's force term that is this cause; empty name when it is none.
std::pair<std::string, TermParameters> live_term(const Cause& cause) {
  const Mechanism& m = mechanism_at(cause.term.mechanism);
  TermParameters known;
  if (m.term == nullptr || (m.shape_in_term && !m.shape_in_term(cause.term.shape, known)))
    return {};
  for (const auto& [parameter, interval] : cause.parameters)
    known.emplace_back(parameter, interval.value);
  TermParameters given;
  for (const auto& p : m.term->parameters) {
    const auto found =
        std::find_if(known.begin(), known.end(), [&](const auto& k) { return k.first == p.name; });
    if (found == known.end()) {
      if (!p.otherwise) return {};  // the same name for another formula
      continue;
    }
    const double value = p.name == std::string("phase_turns") && found->second < 0.0
                             ? found->second + 1.0
                             : found->second;
    if (value < p.low || value > p.high) return {};
    given.emplace_back(p.name, value);
  }
  return {m.name, given};
}

/// A string of TOML, whatever it holds; also a key. JSON's strings are TOML's, but for one
/// character that TOML wants escaped.
std::string quoted(const std::string& text) {
  return terminal_json(
      nlohmann::json(text).dump(-1, ' ', false, nlohmann::json::error_handler_t::replace));
}

std::string key_of(const std::string& name) {
  constexpr char k_bare[] = "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789_-";
  return name.empty() || name.find_first_not_of(k_bare) != std::string::npos ? quoted(name) : name;
}

void write(std::ostream& out, const char* key, const std::vector<double>& values) {
  out << key << " = [";
  for (std::size_t i = 0; i < values.size(); ++i)
    out << (i > 0 ? ", " : "") << std::showpoint << values[i] << std::noshowpoint;
  out << "]\n";
}

/// What stands under [cutting], and [handpiece] where there is one.
std::string cutting_toml(const ForceModel& model) {
  std::ostringstream out;
  out.precision(17);
  if (model.law == CuttingLaw::penetration) {
    out << "rpm_ref = " << model.rpm_ref << "\n";
    return out.str();
  }
  out << "law = \"pressure\"\nforce_ratio = " << model.force_ratio << "\n";
  if (model.drive.torque_n_mm > 0.0)
    out << "\n[handpiece]\ntorque_n_mm = " << model.drive.torque_n_mm
        << "\nslip_rpm = " << model.drive.slip_rpm << "\n";
  return out.str();
}

}  // namespace

std::string material_of(const ForceModel& model) {
  if (model.materials.contains("dentin")) return "dentin";
  for (const auto& [name, m] : model.materials)
    if (m.voigt.stiffness_n_per_mm > 0.0) return name;
  return model.materials.empty() ? "" : model.materials.begin()->first;
}

std::string extended_model_toml(const Explanation& e, const ForceModel& start) {
  std::size_t terms = start.term_values.size();
  for (const auto& cause : e.causes) terms += !live_term(cause).first.empty();
  if (terms > k_max_terms)
    throw Error(msg("force model '{}'", start.name),
                msg("would have {} terms, {} are the most", terms, k_max_terms),
                msg("leave out the smallest"));
  std::ostringstream out;
  out.precision(17);
  out << "# Written by `cavum explain`: verdict " << verdict_name(e.verdict) << ".\nname = "
      << quoted(start.name.ends_with("-extended") ? start.name : start.name + "-extended")
      << "\n\n[cutting]\n"
      << cutting_toml(start) << "\n[rendering]\nkvc_n_per_mm = " << start.rendering.kvc_n_per_mm
      << "\nfiltered_damping_n_s_per_mm = " << start.rendering.filtered_damping_n_s_per_mm
      << "\nspeed_filter_s = " << start.rendering.speed_filter_s
      << "\ndrag_n_per_mm = " << start.rendering.drag_n_per_mm << "\n";
  // What was measured is the one material; the others keep their ratio to it.
  const std::string measured = material_of(start);
  const Viscoelastic of_measured =
      start.materials.contains(measured) ? start.materials.at(measured).voigt : Viscoelastic{};
  const auto scaled = [](double value, double from, double to) {
    return from > 0.0 ? std::max(0.0, to) * (value / from) : value;
  };
  for (const auto& [name, m] : start.materials) {
    out << "\n[materials." << key_of(name) << "]\nk_n_per_mm = "
        << scaled(m.voigt.stiffness_n_per_mm, of_measured.stiffness_n_per_mm, e.base.k_n_per_mm)
        << "\nc_n_s_per_mm = "
        << scaled(m.voigt.damping_n_s_per_mm, of_measured.damping_n_s_per_mm, e.base.c_n_s_per_mm)
        << "\n";
    if (m.tau_s > 0.0) out << "tau_s = " << m.tau_s << "\n";
    if (m.wear_mm3_per_n_m > 0.0) out << "wear_mm3_per_n_m = " << m.wear_mm3_per_n_m << "\n";
  }
  const auto effect = [&](const MeasurementEffect& m, const std::string& why) {
    out << "\n# " << why << "\n[[measurement]]\nkind = " << quoted(m.kind) << "\n";
    write(out, "shape", m.shape);
    write(out, "values", m.values);
  };
  for (const auto& t : start.term_values)
    out << "\n# kept from the model that was given\n" << force_term_toml(t.kind, t.parameters);
  for (const auto& m : start.measurement) effect(m, "kept from the model that was given");
  Eigen::Index at = 2;
  for (const auto& cause : e.causes) {
    const Mechanism& m = mechanism_at(cause.term.mechanism);
    std::vector<double> own;
    const auto count =
        static_cast<Eigen::Index>(m.columns(*e.after->scene, cause.term.shape).own.size());
    for (Eigen::Index i = 0; i < count; ++i) own.push_back(e.after->base_fit.value[at++]);
    const auto [name, parameters] = live_term(cause);
    if (!name.empty())
      out << "\n# " << m.equation << ": felt in an exam too\n" << force_term_toml(name, parameters);
    const bool own_phases = m.by_session && own.size() > 2;
    if (own_phases)
      effect(
          {m.name, cause.term.shape, own},
          "the same in this recording, each session with its phase: explain goes by this, an exam by the term");
    if (name.empty())
      effect({m.name, cause.term.shape, own},
             fmt::format("{}: of this recording, not felt in an exam", m.equation));
  }
  return out.str();
}

}  // namespace cavum::explain
