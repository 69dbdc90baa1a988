#include "engine/lab/explain/recording/session_recording.h"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>

#include "engine/base/error.h"
#include "engine/base/file.h"
#include "engine/session/session_reader.h"
#include "engine/session/simulation.h"

namespace cavum::explain {
namespace {

constexpr double k_row_s = 0.005;
constexpr double k_min_contact_s = 0.5;
constexpr double k_felt_n =
    1e-3;  // of a law without noise: no hand and no load cell of an exam tells less

/// A force over time, linear between its samples.
struct Force {
  std::vector<double> t_s, f_n;
  std::string source;
  /// Nothing outside the samples, and where two of them are further than 0.1 s apart.
  [[nodiscard]] std::optional<double> at(double t) const {
    const auto after = std::lower_bound(t_s.begin(), t_s.end(), t - 1e-9);
    if (after == t_s.end()) return std::nullopt;
    const auto i = static_cast<std::size_t>(after - t_s.begin());
    if (std::fabs(*after - t) < 1e-9) return f_n[i];
    if (i == 0 || t_s[i] - t_s[i - 1] > 0.1) return std::nullopt;
    return f_n[i - 1] + (t - t_s[i - 1]) / (t_s[i] - t_s[i - 1]) * (f_n[i] - f_n[i - 1]);
  }
};

Force force_of_csv(const std::string& path) {
  const Recording r = parse_recording(read_text_file(path, k_largest_table), path, {}, false);
  Force out{{r.t_s.data(), r.t_s.data() + r.rows()},
            {r.f_n.data(), r.f_n.data() + r.rows()},
            "measured, " + path};
  if (!std::is_sorted(out.t_s.begin(), out.t_s.end()))
    throw Error(path, msg("its times do not grow"), msg("sort the rows by t_s"));
  return out;
}

Force force_of_events(const SessionReader& session, double tick_s) {
  Force out;
  out.source = "measured, in the session";
  for (const auto& e : session.event_rows()) {
    const auto* measured = e.as<MeasuredForce>();
    if (measured == nullptr) continue;
    double at = static_cast<double>(e.tick);
    for (const double f_n : measured->f_n) {
      if (!out.t_s.empty() && !(at * tick_s > out.t_s.back()))
        throw Error(msg("{}: force measured at tick {}", session.path(), e.tick),
                    msg("overlaps the one before"), msg("record each tick once"));
      out.t_s.push_back(at * tick_s);
      out.f_n.push_back(f_n);
      at += std::max(1, measured->every_ticks);
    }
  }
  return out;
}

/// One row, as the replay gives it.
struct Row {
  double t_s, x_mm, v_mm_s, f_n, k, c, rpm, removed_mm3, bur, approach_deg, slide_mm_s, tilt_deg;
};

double degrees(double rad) { return rad * 57.29577951308232; }

/// Material with the greatest stiffness: what k and c are measured by.
Viscoelastic stiffest(const ForceModel& model) {
  Viscoelastic out;
  for (const auto& [name, m] : model.materials)
    if (m.voigt.stiffness_n_per_mm > out.stiffness_n_per_mm) out = m.voigt;
  return out;
}

/// How far two forces are apart.
struct Apart {
  double square_sum = 0, rows = 0;
  [[nodiscard]] double rms_n() const { return rows > 0 ? std::sqrt(square_sum / rows) : 0.0; }
};

/// Stretches of contact in which the force is known, replayed tick by tick. `measured` without
/// rows: the force of the session's own law. `rendering`: the rendered force against it, along the
/// normal.
std::vector<std::vector<Row>> contacts_of(const SessionReader& session, Simulation& simulation,
                                          const Force& measured, std::int64_t every,
                                          const std::string& path, Apart& rendering) {
  const double tick_s = simulation.model.config.tick_s;
  std::vector<std::vector<Row>> contacts(1);
  const auto ends = [&contacts] {
    if (!contacts.back().empty()) contacts.emplace_back();
  };
  std::map<int, double> removed;
  std::int64_t tick = 0;
  Vec3 last_tip = simulation.state.estimate.tip_mm, velocity_mm_s;
  for (std::size_t chunk = 0; chunk < session.chunks().size(); ++chunk) {
    const ChunkMotion motion = session.motion(chunk);
    for (std::size_t i = 0; i < motion.inputs.size(); ++i, ++tick) {
      const TickInput& input = motion.inputs[i];
      const TickOutput out = step(simulation.model, simulation.state, input);
      if (!(make_tick_record(out) == motion.records[i]))
        throw Error(path, msg("its replay differs from the record at tick {}", tick),
                    msg("see what `cavum replay --verify` says of it"));
      double& worn = removed[input.bur];
      worn += out.removed_count * simulation.state.tooth.leaf_volume_mm3();
      const Vec3 moved = simulation.state.estimate.tip_mm - last_tip;
      last_tip = simulation.state.estimate.tip_mm;
      velocity_mm_s +=
          (moved / tick_s - velocity_mm_s) *
          (tick_s / (simulation.model.force.rendering.speed_filter_s + tick_s));  // as V is seen
      if (!out.contact) {
        ends();
        continue;
      }
      if (tick % every != 0) continue;
      const double t = static_cast<double>(tick) * tick_s;
      const std::optional<double> force =
          measured.t_s.empty() ? std::optional(out.model_force_n) : measured.at(t);
      if (!force) {
        ends();
        continue;
      }
      const double apart_n = dot(out.rendered_force_n, out.normal) - out.model_force_n;
      rendering.square_sum += apart_n * apart_n;
      rendering.rows += 1.0;
      const auto& touched = simulation.state.touched.means.of;
      const Vec3 axis = simulation.state.contact.rotation * Vec3{0, 0, 1};
      contacts.back().push_back(
          {t, out.penetration_mm, out.approach_mm_s, *force, touched.stiffness_n_per_mm,
           touched.damping_n_s_per_mm, out.rpm, worn, static_cast<double>(input.bur),
           degrees(std::atan2(out.normal.x, out.normal.z)),
           length(velocity_mm_s - out.normal * dot(velocity_mm_s, out.normal)),
           degrees(std::acos(std::clamp(dot(axis, out.normal), -1.0, 1.0)))});
    }
  }
  return contacts;
}

/// Those of at least so many rows, each as a session; k and c by those of `reference`.
Recording joined(const std::vector<std::vector<Row>>& contacts, std::size_t least,
                 Viscoelastic reference) {
  std::vector<const Row*> rows;
  Recording r;
  for (const auto& contact : contacts) {
    if (contact.size() < least) continue;
    const auto begin = static_cast<Eigen::Index>(rows.size());
    for (const auto& row : contact) rows.push_back(&row);
    r.sessions.push_back({fmt::format("contact {}", r.sessions.size() + 1), begin,
                          static_cast<Eigen::Index>(rows.size())});
  }
  const auto series = [&rows](double Row::*field) {
    Series out(static_cast<Eigen::Index>(rows.size()));
    for (Eigen::Index i = 0; i < out.size(); ++i)
      out[i] = rows[static_cast<std::size_t>(i)]->*field;
    return out;
  };
  r.t_s = series(&Row::t_s);
  r.x_mm = series(&Row::x_mm);
  r.v_mm_s = series(&Row::v_mm_s);
  r.f_n = series(&Row::f_n);
  r.relative_k = series(&Row::k) / reference.stiffness_n_per_mm;
  r.relative_c = series(&Row::c) / std::max(1e-12, reference.damping_n_s_per_mm);
  r.exact_motion = true;
  r.columns = {{"spindle_rpm", series(&Row::rpm)},
               {"removed_mm3", series(&Row::removed_mm3)},
               {"bur_id", series(&Row::bur)},
               {"approach_deg", series(&Row::approach_deg)},
               {"slide_mm_s", series(&Row::slide_mm_s)},
               {"tilt_deg", series(&Row::tilt_deg)}};
  r.rig.k_n_per_mm = reference.stiffness_n_per_mm;
  if (reference.damping_n_s_per_mm > 0.0) r.rig.c_n_s_per_mm = reference.damping_n_s_per_mm;
  return r;
}

}  // namespace

Recording read_session_recording(const std::string& path, const std::string& force_csv) {
  const SessionReader session(path);
  session.require_readable();
  Simulation simulation = make_simulation(session.setup(), path);
  const double tick_s = simulation.model.config.tick_s;
  const Force measured =
      force_csv.empty() ? force_of_events(session, tick_s) : force_of_csv(force_csv);
  const bool own_law = measured.t_s.empty();
  const Viscoelastic reference = stiffest(simulation.model.force);
  if (!(reference.stiffness_n_per_mm > 0.0))
    throw Error(path, msg("no material of its force model resists"),
                msg("explain a session in which something does"));

  const auto every = std::max<std::int64_t>(1, std::llround(k_row_s / tick_s));
  const auto least =
      static_cast<std::size_t>(k_min_contact_s / (tick_s * static_cast<double>(every)));
  Apart rendering;
  Recording r =
      joined(contacts_of(session, simulation, measured, every, path, rendering), least, reference);
  if (r.sessions.empty())
    throw Error(path,
                own_law ? msg("no contact lasts for half a second")
                        : msg("no contact lasts for half a second with a measured force beside it"),
                msg("explain a session in which the tooth was touched for longer"));
  r.friction_by_path = own_law;
  r.rig.force_quantum_n = own_law ? k_felt_n : 0.0;
  r.notes.push_back(
      own_law
          ? Fact(
                "force_of_own_law", {"difference"},
                msg("force: the session's own law, for it holds no measured one. What is found is what its force terms add to k X + c V; it "
                    "says nothing about real tissue. Rendering and safety made {} rms of difference to it",
                    as_n(rendering.rms_n(), k_as_needed)))
          : Fact("force_measured", {"source"},
                 msg("force: {}. X and V are the simulation's", measured.source)));
  r.notes.emplace_back(
      "contacts_as_sessions", std::vector{"contacts"},
      msg("{} contacts of half a second or more count as sessions; time in air is left out",
          r.sessions.size()));
  return r;
}

}  // namespace cavum::explain
