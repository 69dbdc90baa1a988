#include "engine/device/hardware/stylus_probe.h"

#include <algorithm>
#include <cmath>

#include "engine/device/device_error.h"
#include "engine/physics/servo/scheduling.h"

namespace cavum {
namespace {

constexpr double k_tick_of_probe_s = 1e-3;

/// Gives it a force each millisecond, and keeps where it is.
class Hold {
 public:
  Hold(Stylus& stylus, bool real_time)
      : stylus_(stylus), real_time_(real_time), due_ns_(monotonic_ns()) {}
  ~Hold() { stylus_.cut_force(); }
  Hold(const Hold&) = delete;
  Hold& operator=(const Hold&) = delete;

  Vec3 tick(Vec3 force_n) {
    constexpr std::int64_t k_tick_ns = 1'000'000;
    constexpr int k_max_silent = 500;
    due_ns_ += k_tick_ns;
    if (real_time_) sleep_until(due_ns_);
    const DeviceReading r = stylus_.read(k_tick_of_probe_s);
    stylus_.send_force(force_n);
    if ((r.flags & k_stylus_fresh) == 0) {
      if (++silent_ > k_max_silent)
        throw stylus_error(stylus_.facts().id, DeviceError::silent,
                           msg("fell silent while it was tried"),
                           msg("see `cavum devices`, and begin again"));
      return at_;
    }
    silent_ = 0;
    if (known_)
      if (const double way = length(r.pose.tip_mm - at_);
          way > k_no_path_mm && (quantum_mm_ == 0.0 || way < quantum_mm_))
        quantum_mm_ = way;
    known_ = true;
    return at_ = r.pose.tip_mm;
  }
  Vec3 rest(double seconds) {
    for (double t = 0.0; t < seconds; t += k_tick_of_probe_s) tick({});
    return at_;
  }
  [[nodiscard]] double quantum_mm() const noexcept { return quantum_mm_; }

 private:
  static constexpr double k_no_path_mm = 1e-6;  // rounding of a place that was computed anew
  Stylus& stylus_;
  bool real_time_, known_ = false;
  std::int64_t due_ns_;
  int silent_ = 0;
  Vec3 at_;
  double quantum_mm_ = 0.0;
};

/// The push along `way`, unit, at which it moved; 0 with `problem` when there is none.
double breakaway_n(Hold& hold, Vec3 way, double moved_mm, const StylusProbeOptions& o,
                   std::optional<Error>& problem) {
  constexpr double k_settle_s = 0.4, k_watch_s = 0.3;
  hold.rest(k_settle_s);
  const Vec3 before = hold.tick({}), from = hold.rest(k_watch_s);
  if (length(from - before) > moved_mm) {
    problem = Error(DeviceError::moves_unpushed, msg("friction in air"),
                    msg("not found, for the stylus moves without being pushed"),
                    msg("balance it, let go of it, and try again"));
    return 0.0;
  }
  for (double push_n = 0.0; push_n <= o.most_n; push_n += o.ramp_n_per_s * k_tick_of_probe_s)
    if (dot(hold.tick(way * push_n) - from, way) > moved_mm) return push_n;
  problem = Error(DeviceError::stuck, msg("friction in air"),
                  msg("not found, for the stylus did not move"),
                  msg("let it stand free, not in its inkwell or at the end of its way"));
  return 0.0;
}

}  // namespace

StylusProbe probe_stylus(Stylus& stylus, const StylusProbeOptions& o) {
  const StylusHealth before = stylus.health();
  if (before.problem) throw Error(*before.problem);
  StylusProbe probe;
  Hold hold(stylus, o.real_time);
  const std::int64_t begin_ns = monotonic_ns();
  hold.rest(o.listen_s);
  const double listened_s =
      o.real_time ? static_cast<double>(monotonic_ns() - begin_ns) * 1e-9 : o.listen_s;
  const StylusHealth heard = stylus.health();
  probe.readings = heard.readings - before.readings;
  probe.rate_hz = listened_s > 0 ? static_cast<double>(probe.readings) / listened_s : 0.0;
  probe.jitter_s = heard.jitter_s;
  probe.longest_gap_s = heard.longest_gap_s;
  if (o.friction) {
    const double moved_mm = std::max(o.moved_mm, 2.0 * stylus.facts().position_quantum_mm);
    double sum_n = 0.0;
    for (std::size_t axis = 0; axis < 3 && !probe.friction_problem; ++axis) {
      const Vec3 way{axis == 0 ? 1.0 : 0.0, axis == 1 ? 1.0 : 0.0, axis == 2 ? 1.0 : 0.0};
      probe.axes[axis].forwards_n = breakaway_n(hold, way, moved_mm, o, probe.friction_problem);
      if (!probe.friction_problem)
        probe.axes[axis].backwards_n = breakaway_n(hold, -way, moved_mm, o, probe.friction_problem);
      sum_n += probe.axes[axis].friction_n();
    }
    if (!probe.friction_problem) probe.friction_n = sum_n / 3.0;
  }
  probe.quantum_mm = hold.quantum_mm();
  return probe;
}

}  // namespace cavum
