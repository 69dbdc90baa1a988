#include "engine/session/verify.h"

#include <fmt/core.h>

#include <chrono>

#include "engine/base/message_from.h"
#include "engine/session/chain_check.h"
#include "engine/session/session_reader.h"
#include "engine/session/simulation.h"

namespace cavum {
namespace {

std::string scaled(std::int64_t value, double scale, const char* unit) {
  return fmt::format("{:.6f} {}", static_cast<double>(value) * scale, unit);
}

std::string leaf_text(const RemovedLeaf& l) {
  return fmt::format("({}, {}, {}) tissue {}", l.x, l.y, l.z, l.tissue);
}

/// First field in which two records differ, or nothing.
std::optional<Divergence> compare(std::int64_t tick, const TickRecord& was, const TickRecord& is) {
  const auto differ = [&](const char* what, std::int64_t a, std::int64_t b, double scale,
                          const char* unit) {
    return Divergence{tick, what, scaled(a, scale, unit), scaled(b, scale, unit)};
  };
  static constexpr const char* k_force[] = {"rendered_force_x", "rendered_force_y",
                                            "rendered_force_z"};
  static constexpr const char* k_proxy[] = {"proxy_x", "proxy_y", "proxy_z"};
  if (was == is) return std::nullopt;
  if (was.model_un != is.model_un)
    return differ("model_force", was.model_un, is.model_un, 1e-6, "N");
  if (was.penetration_nm != is.penetration_nm)
    return differ("penetration", was.penetration_nm, is.penetration_nm, 1e-6, "mm");
  for (std::size_t i = 0; i < 3; ++i)
    if (was.proxy_nm[i] != is.proxy_nm[i])
      return differ(k_proxy[i], was.proxy_nm[i], is.proxy_nm[i], 1e-6, "mm");
  for (std::size_t i = 0; i < 3; ++i)
    if (was.rendered_un[i] != is.rendered_un[i])
      return differ(k_force[i], was.rendered_un[i], is.rendered_un[i], 1e-6, "N");
  if (was.rpm != is.rpm) return differ("rpm", was.rpm, is.rpm, 1, "rpm");
  if (was.removed != is.removed)
    return Divergence{tick, "removed", fmt::format("{} leaves", was.removed),
                      fmt::format("{} leaves", is.removed)};
  return Divergence{tick, "notices", std::to_string(was.notices), std::to_string(is.notices)};
}

/// First leaf in which the removals of a tick differ.
std::optional<Divergence> compare(std::int64_t tick, std::span<const RemovedLeaf> was,
                                  std::span<const RemovedLeaf> is) {
  for (std::size_t i = 0; i < std::max(was.size(), is.size()); ++i) {
    if (i < was.size() && i < is.size() && was[i] == is[i]) continue;
    return Divergence{tick, "removed_leaf", i < was.size() ? leaf_text(was[i]) : "none",
                      i < is.size() ? leaf_text(is[i]) : "none"};
  }
  return std::nullopt;
}

void note(VerifyReport& report, const std::optional<Divergence>& divergence) {
  if (!divergence) return;
  ++report.ticks_different;
  if (!report.first_divergence) report.first_divergence = divergence;
}

/// Simulates every chunk that unpacks; ends early only when one does not, for then the state is
/// unknown.
void replay(const SessionReader& session, Simulation& simulation, const TickVisitor& visit,
            VerifyReport& report) {
  std::size_t leaves = 0;
  for (std::size_t i = 0; i < session.chunks().size(); ++i) {
    const ChunkRow& c = session.chunks()[i];
    ChunkMotion motion;
    try {
      motion = session.motion(i);
    } catch (const Error& e) {
      report.findings.push_back(damage<DamageKind::replay_stopped>(e.message()));
      return;
    }
    if ((leaves += motion.removed.leaves.size()) > k_max_removed_leaves) {
      report.findings.push_back(damage<DamageKind::too_much_removed>(k_max_removed_leaves));
      return;
    }
    std::span<const RemovedLeaf> listed = motion.removed.leaves;
    for (std::size_t t = 0; t < motion.inputs.size(); ++t) {
      const auto tick = c.first_tick + static_cast<std::int64_t>(t);
      const TickOutput output = step(simulation.model, simulation.state, motion.inputs[t]);
      const TickRecord record = make_tick_record(output);
      if (visit) visit(tick, motion.inputs[t], output, simulation.state);
      const auto removed = listed.first(motion.removed.counts[t]);
      listed = listed.subspan(removed.size());
      auto divergence = compare(tick, motion.records[t], record);
      if (!divergence) divergence = compare(tick, removed, simulation.state.removed);
      note(report, divergence);
    }
    report.ticks_replayed += c.ticks;
    const std::uint64_t expected = report.ticks_replayed == 0 ? 0 : state_hash(simulation.state);
    if (expected == c.state_hash) continue;
    const auto last = c.first_tick + c.ticks - 1;
    report.findings.push_back(damage<DamageKind::state_differs>(c.seq, last));
    if (!report.first_divergence)
      report.first_divergence =
          Divergence{last, "state_hash", std::to_string(c.state_hash), std::to_string(expected)};
  }
}

void compare_final_tooth(const SessionReader& session, const Simulation& simulation,
                         const VerifyTeeth& teeth, VerifyReport& report) {
  try {
    Tooth kept =
        load_tooth_like(session.final_tooth(), session.path() + ": final_tooth.cvt", teeth.like);
    if (tooth_hash(kept) != tooth_hash(drilled_tooth(simulation)))
      report.findings.push_back(damage<DamageKind::final_tooth_differs>());
    if (teeth.final_out != nullptr) *teeth.final_out = std::move(kept);
  } catch (const std::bad_alloc&) {
    throw;  // nothing is wrong with the recording
  } catch (const std::exception& e) {
    report.findings.push_back(damage<DamageKind::final_tooth_unreadable>(message_from(e)));
  }
}

void simulate_and_compare(const SessionReader& session, const TickVisitor& visit,
                          const VerifyTeeth& teeth, VerifyReport& report) {
  const auto recorded_physics = session.number("physics_version", 0);
  if (recorded_physics != k_physics_version) {
    report.findings.push_back(
        damage<DamageKind::other_physics>(recorded_physics, k_physics_version));
    return;
  }
  const auto start = std::chrono::steady_clock::now();
  double tick_s = 0;
  try {
    Simulation simulation = make_simulation(session.setup(), session.path(), teeth.start);
    tick_s = simulation.model.config.tick_s;
    replay(session, simulation, visit, report);
    if (report.closed && report.ticks_replayed == report.ticks)
      compare_final_tooth(session, simulation, teeth, report);
  } catch (const std::bad_alloc&) {
    throw;  // nothing is wrong with the recording
  } catch (const std::exception& e) {
    report.findings.push_back(damage<DamageKind::not_replayed>(message_from(e)));
  }
  const double seconds =
      std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  if (seconds > 0)
    report.speed_x_realtime = static_cast<double>(report.ticks_replayed) * tick_s / seconds;
  if (report.ticks_different == 0) return;
  const Divergence& d = *report.first_divergence;
  report.findings.push_back(damage<DamageKind::ticks_differ>(
      d.tick, d.what, d.recorded, d.replayed, report.ticks_different, report.ticks_replayed));
}

}  // namespace

VerifyReport verify_session(const std::string& path, const std::string& expected_station_key) {
  return verify_session(SessionReader(path), expected_station_key);
}

VerifyReport verify_session(const SessionReader& session, const std::string& expected_station_key,
                            const TickVisitor& visit, const VerifyTeeth& teeth) {
  VerifyReport report;
  report.file = session.path();
  report.closed = session.closed();
  report.ticks = session.ticks();
  report.findings = session.findings();
  if (session.meta().empty() &&
      session.chunks().empty()) {  // nothing could be read: the reader has said why
    if (report.findings.empty()) report.findings.push_back(damage<DamageKind::nothing_in_it>());
    return report;
  }
  for (auto& f : check_chain(session)) report.findings.push_back(std::move(f));
  if (session.seal()) report.station_key = to_hex(session.seal()->public_key);
  if (!expected_station_key.empty() && session.seal() && report.station_key != expected_station_key)
    report.findings.push_back(damage<DamageKind::seal_station>(report.station_key));
  simulate_and_compare(session, visit, teeth, report);
  report.intact = report.findings.empty() && !report.first_divergence;
  if (!report.closed) report.findings.push_back(damage<DamageKind::not_closed>(report.ticks));
  report.verified = report.intact && report.closed;
  return report;
}

}  // namespace cavum
