// For authors of hands: what a hand does, as a table. try_hand NAME SEED > trace.csv; without
// arguments the names.
#include <cstdio>
#include <cstdlib>
#include <string>

#include "grading/perforation/drop.h"
#include "tests/hands/drill.h"

int main(int argc, char** argv) {
  using namespace cavum;
  if (argc != 3) {
    for (const auto& k : hands::all_hands()) std::printf("%s\n", k.name);
    return 0;
  }
  for (const auto& k : hands::all_hands()) {
    if (std::string(k.name) != argv[1]) continue;
    const hands::Drilled d = hands::drill(k, std::strtoull(argv[2], nullptr, 10));
    std::fprintf(
        stderr,
        "%s %s, %s, %s, means to %s, noise %.2f N, friction %.2f N, %.3f mm, tilt %.0f deg, %zu ticks, %zu leaves removed\n",
        d.hand.c_str(), d.style.c_str(), d.tooth.c_str(), d.bur.c_str(),
        d.meant_to_open ? "open the chamber" : "stop", d.noise_n, d.friction_n, d.quantum_mm,
        d.tilt_deg, d.inputs.size(), d.removed.size());
    const auto missing = grading::missing_force(
        d.filled_model, make_servo_state(d.filled_model, d.filled, d.first_tip_mm), d.inputs,
        d.true_records);
    std::printf(
        "t_s,tip_x_mm,tip_y_mm,tip_z_mm,force_x_n,force_y_n,force_z_n,pedal,rpm,removed,seen_x_mm,seen_y_mm,seen_z_mm,felt_n,filled_n\n");
    for (std::size_t i = 0; i < d.inputs.size(); i += 10) {
      const auto& in = d.inputs[i];
      const auto& r = d.records[i];
      std::printf("%.3f,%.4f,%.4f,%.4f,%.4f,%.4f,%.4f,%.2f,%d,%u,%.4f,%.4f,%.4f,%.4f,%.4f\n",
                  static_cast<double>(i) * 1e-3, in.tip_nm[0] * 1e-6, in.tip_nm[1] * 1e-6,
                  in.tip_nm[2] * 1e-6, r.rendered_un[0] * 1e-6, r.rendered_un[1] * 1e-6,
                  r.rendered_un[2] * 1e-6, in.pedal_q16 / 65535.0, r.rpm, r.removed,
                  r.proxy_nm[0] * 1e-6, r.proxy_nm[1] * 1e-6, r.proxy_nm[2] * 1e-6,
                  i / 10 < missing.felt_n.size() ? missing.felt_n[i / 10] : 0.0,
                  i / 10 < missing.filled_n.size() ? missing.filled_n[i / 10] : 0.0);
    }
    return 0;
  }
  std::fprintf(stderr, "no hand %s\n", argv[1]);
  return 1;
}
