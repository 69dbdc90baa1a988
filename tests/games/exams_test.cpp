// Whole exams of the slot by motion files, with all of the physics: none that holds, pecks,
// circles, pulses the pedal, leans or cuts with the shank is marked better than the expert, and
// none of them passes.
#include <gtest/gtest.h>

#include <cmath>
#include <fstream>
#include <numbers>

#include "tests/ui/program.h"

namespace cavum::games {
namespace {

/// A motion, made of straight ways at a given speed. mm, s; the slot is 6.0 x 1.5 x 1.5 mm, its
/// surface at z = 0.
class Way {
 public:
  double x = 0, y = 0, z = 1, tilt_deg = 0, pulse_s = 0;
  void to(double to_x, double to_y, double to_z, double mm_s) {
    const double way = std::hypot(to_x - x, to_y - y, to_z - z), from_x = x, from_y = y, from_z = z;
    const int steps = std::max(1, static_cast<int>(way / mm_s / k_step_s));
    for (int i = 1; i <= steps; ++i) {
      const double s = static_cast<double>(i) / steps;
      x = from_x + s * (to_x - from_x);
      y = from_y + s * (to_y - from_y);
      z = from_z + s * (to_z - from_z);
      row(1);
    }
  }
  void stay(double seconds) {
    for (int i = 0; i < seconds / k_step_s; ++i) row(1);
  }
  /// Straight out, the pedal released.
  void done() {
    to(x, y, 2, 2);
    for (int i = 0; i < 50; ++i) row(0);
  }
  void save(const std::string& path) const {
    std::ofstream file(path);
    file << "# bur = cylinder-flat-1.0\nt_s,x_mm,y_mm,z_mm,qw,qx,qy,qz,pedal\n" << rows_;
  }

 private:
  static constexpr double k_step_s = 0.02;
  void row(int pedal) {
    const double half = tilt_deg * std::numbers::pi / 360;
    if (pulse_s > 0 && std::fmod(t_, 2 * pulse_s) > pulse_s) pedal = 0;
    char line[160];
    std::snprintf(line, sizeof line, "%.3f,%.4f,%.4f,%.4f,%.6f,0,%.6f,0,%d\n", t_, x, y, z,
                  std::cos(half), std::sin(half), pedal);
    rows_ += line;
    t_ += k_step_s;
  }
  double t_ = 0;
  std::string rows_;
};

/// To and fro along both long walls, layer by layer.
void to_and_fro(Way& w, double deepest, double layer) {
  w.to(0, 0, 0.1, 2);
  for (double z = -layer; z > deepest - 1e-6; z -= layer) {
    w.to(0, 0, z, 0.3);
    for (const auto& [x, y] : {std::pair{-2.25, 0.25},
                               {2.25, 0.25},
                               {2.45, 0.0},
                               {2.25, -0.25},
                               {-2.25, -0.25},
                               {-2.45, 0.0},
                               {0.0, 0.0}})
      w.to(x, y, z, 1.2);
  }
}

class Exams : public testing_ui::Program {
 protected:
  nlohmann::json marked(const std::string& name, const Way& way) {
    way.save(path(name + ".csv"));
    return sat(name, "--motion " + path(name + ".csv"));
  }
  nlohmann::json sat(const std::string& name, const std::string& by) {
    const auto j = run_json("exam " + testing_ui::k_data + "/scenarios/slot.toml --candidate " +
                            name + " " + by + " --out " + path(name + ".cavum"));
    std::printf("%-10s %s %.3f, %.1f %% of the target, %.1f s\n", name.c_str(),
                j["verdict"].get<std::string>().c_str(), j["score"]["points"].get<double>(),
                j["volumes"]["target_removed_percent"].get<double>(), j["time_s"].get<double>());
    return j;
  }
};

TEST_F(Exams, GamesByHandAreMarkedBelowHonestWorkAndDoNotPass) {
  const auto best = sat("honest", "--operator expert");
  EXPECT_EQ(best["verdict"], "pass") << best["criteria"].dump();
  std::vector<std::pair<std::string, Way>> games(5);
  auto* at = games.data();
  const auto next = [&](const char* name) -> Way& {
    at->first = name;
    return (at++)->second;
  };
  Way& hold = next("hold");
  hold.to(0, 0, -1.8, 0.2);
  hold.stay(10);
  hold.done();
  Way& peck = next("peck");
  for (double x = -2; x < 2.5; x += 1) {
    peck.to(x, 0, 0.3, 3);
    peck.to(x, 0, -1.6, 0.6);
    peck.to(x, 0, 0.3, 3);
  }
  peck.done();
  Way& circle = next("circle");
  for (int i = 0; i < 20 * 30; ++i) {
    const double a = i * std::numbers::pi / 15;
    circle.to(0.25 * std::cos(a), 0.25 * std::sin(a), -1.6 * i / 600, 1.5);
  }
  circle.done();
  Way& pulse = next("pulse");
  pulse.pulse_s = 0.25;
  to_and_fro(pulse, -1.5, 0.75);
  pulse.done();
  Way& lean = next("lean");
  lean.tilt_deg = 30;
  to_and_fro(lean, -1.5, 0.5);
  lean.done();
  for (const auto& [name, way] : games) {
    const auto j = marked(name, way);
    EXPECT_LE(j["score"]["points"].get<double>(), best["score"]["points"].get<double>())
        << name << j["criteria"].dump();
    EXPECT_NE(j["verdict"], "pass") << name << j["criteria"].dump();
  }
}

}  // namespace
}  // namespace cavum::games
