// What a tick costs in a hand: the servo rig's minute (`cavum rig servo`) without its clock, every
// step timed by the processor's time it had, so that slow stretches show on any machine, however
// busy, and again in the same place.
//   hand_bench [SECONDS [TICK_MS]]              60 s at 1 and at 0.25 ms
//   hand_bench SECONDS TICK_MS FROM_S TO_S      also a line for every tick from FROM_S to TO_S
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>

#include "engine/lab/rig/servo_rig.h"
#include "engine/session/simulation.h"
#include "tests/bench/thread_clock.h"
#include "tests/engine/support/engine_testing.h"

namespace cavum {
namespace {

using namespace testing_engine;

void print_tick(double t_s, double us, const TickOutput& out, const ServoState& state,
                double hop_mm) {
  const ContactState& c = state.contact;
  std::printf(
      "%9.5f s %6.1f us; looked up %4d, half spaces %3zu, proxy moved %.4f mm; X %.4f, owed %.4f mm; F %.3f N; normal %+.2f %+.2f %+.2f; removed "
      "%u%s\n",
      t_s, us, state.scratch.looked_up, c.gathered.half_spaces.size(), hop_mm, out.penetration_mm,
      state.recession.pending_mm, length(out.rendered_force_n), out.normal.x, out.normal.y,
      out.normal.z, out.removed_count, state.carving.under_way() ? ", carving" : "");
}

void drill(double seconds, double tick_s, double from_s, double to_s) {
  const SessionSetup setup = servo_rig_setup(
      bur_text("round-1.0"), read_text_file(data_path("materials/consistent.toml")), tick_s);
  Simulation simulation = make_simulation(setup, "hand_bench");
  ServoState& state = simulation.state;
  SimulatedStylus stylus({}, {}, tick_s, drilling_hand);
  TickInput input = make_tick_input({setup.first_tip_mm(), {}}, 0, k_stylus_fresh, 0, {});
  const auto ticks = static_cast<std::size_t>(seconds / tick_s + 0.5),
             window = static_cast<std::size_t>(0.1 / tick_s + 0.5);
  std::vector<double> us;
  us.reserve(ticks);
  double in_window = 0.0, slowest = 0.0, slowest_at_s = 0.0, sum = 0.0, steepest_n = 0.0,
         last_n = 0.0;
  Vec3 last_proxy;
  bool was_touching = false;
  std::size_t removed = 0, over_50 = 0;
  for (std::size_t i = 0; i < ticks; ++i) {
    const double t_s = static_cast<double>(i) * tick_s;
    const DeviceReading r = stylus.read(tick_s);
    input = make_tick_input(r.pose, r.pedal, r.flags, r.bur, input);
    const double begin = thread_us();
    const TickOutput out = step(simulation.model, state, input);
    us.push_back(thread_us() - begin);
    stylus.send_force(out.rendered_force_n);
    sum += us.back();
    over_50 += us.back() > 50.0;
    in_window += us.back() - (i >= window ? us[i - window] : 0.0);
    if (in_window > slowest) slowest = in_window, slowest_at_s = t_s;
    const double force_n = length(out.rendered_force_n);
    if (out.contact && was_touching) steepest_n = std::max(steepest_n, std::fabs(force_n - last_n));
    last_n = force_n;
    was_touching = out.contact;
    removed += out.removed_count;
    if (t_s >= from_s && t_s < to_s)
      print_tick(t_s, us.back(), out, state, length(out.proxy_mm - last_proxy));
    last_proxy = out.proxy_mm;
  }
  std::sort(us.begin(), us.end());
  const auto at = [&](double q) {
    return us[std::min(us.size() - 1,
                       static_cast<std::size_t>(q * static_cast<double>(us.size())))];
  };
  std::printf("%zu ticks of %g ms, %zu leaves removed\n", ticks, tick_s * 1e3, removed);
  std::printf(
      "  median %.2f  p99 %.1f  p99.9 %.1f  worst %.1f  mean %.2f us; more than 50 us: %zu\n",
      at(0.5), at(0.99), at(0.999), us.back(), sum / static_cast<double>(us.size()), over_50);
  std::printf(
      "  slowest tenth of a second: mean %.1f us, until %.2f s; force at most %.3f N a tick\n",
      slowest / static_cast<double>(window), slowest_at_s, steepest_n);
}

}  // namespace
}  // namespace cavum

int main(int argc, char** argv) {
  const auto number = [&](int i, double otherwise) {
    return argc > i ? std::atof(argv[i]) : otherwise;
  };
  const double seconds = number(1, 60.0), tick_ms = number(2, 0.0);
  if (!(seconds >= 0.1 && seconds <= 3600.0) ||
      !(tick_ms == 0.0 || (tick_ms >= 0.1 && tick_ms <= 10.0))) {
    std::fprintf(stderr, "hand_bench: SECONDS must be 0.1 to 3600, TICK_MS 0.1 to 10\n");
    return 2;
  }
  if (tick_ms > 0.0) cavum::drill(seconds, tick_ms * 1e-3, number(3, 0.0), number(4, 0.0));
  if (tick_ms > 0.0) return 0;
  cavum::drill(seconds, 1e-3, 0.0, 0.0);
  cavum::drill(seconds, 0.25e-3, 0.0, 0.0);
}
