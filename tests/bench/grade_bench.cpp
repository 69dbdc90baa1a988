// What grading costs: time beyond loading, and memory, for one recorded session. Also writes a
// motion of ten minutes to record one with.
//   grade_bench --motion F.csv        strokes over the molar's crown for 600 s, layer by layer down
//   to 3.5 mm grade_bench SESSION.cavum [RUNS]  5 runs, the best one counts
#include <sys/resource.h>

#include <chrono>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <ctime>
#include <fstream>

#include "engine/base/error.h"
#include "grading/marking/session_input.h"

namespace {

double seconds() {
  return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
}
/// Time that this program had of the processor: waiting for other programs does not count.
double cpu_seconds() { return static_cast<double>(std::clock()) / CLOCKS_PER_SEC; }
double peak_mb() {
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  return static_cast<double>(usage.ru_maxrss) / 1024;
}

void write_motion(const char* path) {
  std::ofstream out(path);
  out << "t_s,x_mm,y_mm,z_mm,qw,qx,qy,qz,pedal\n";
  char line[160];
  for (int i = 0; i <= 60000; ++i) {
    const double t = i * 0.01, layer = 3.3 - 5.3 * t / 600;
    const double x = 1.8 * std::sin(2.1 * t), y = 1.4 * std::sin(0.37 * t);
    std::snprintf(line, sizeof line, "%.3f,%.4f,%.4f,%.4f,1,0,0,0,%d\n", t, x, y, layer,
                  t > 0.5 && t < 599.5 ? 1 : 0);
    out << line;
  }
}

}  // namespace

int main(int argc, char** argv) {
  try {
    if (argc == 3 && std::strcmp(argv[1], "--motion") == 0) {
      write_motion(argv[2]);
      return 0;
    }
    if (argc != 2 && argc != 3) {
      std::fprintf(stderr, "usage: grade_bench SESSION.cavum [RUNS] | --motion F.csv\n");
      return 2;
    }
    const double start = seconds();
    const auto session = cavum::grading::load_for_grading(argv[1]);
    const double loaded = seconds(), loaded_mb = peak_mb();
    const int runs = argc > 2 ? std::atoi(argv[2]) : 5;
    double best = 1e9, best_cpu = 1e9;
    cavum::grading::Result result;
    for (int i = 0; i < runs; ++i) {
      const double from = seconds(), cpu = cpu_seconds();
      cavum::grading::GradeInput input = session->input();
      input.known = nullptr;  // what the run before found out of the tooth is found out again
      result = cavum::grading::grade(input, session->rubric);
      best = std::min(best, seconds() - from);
      best_cpu = std::min(best_cpu, cpu_seconds() - cpu);
    }
    std::printf("%.1f s of exam, leaf %.3f mm, %zu leaves removed (%.2f mm3)\n",
                static_cast<double>(session->inputs.size()) * 0.001, result.leaf_mm,
                session->removed.size(), result.volumes.removed.mm3);
    std::printf(
        "load  %.2f s, peak %.0f MB\ngrade %.3f s, of it %.3f s on the processor (best run), peak %.0f MB\n",
        loaded - start, loaded_mb, best, best_cpu, peak_mb());
    const bool ok = best_cpu <= 1.0 && peak_mb() <= 500;
    std::printf("limits: grade <= 1 s beyond loading, memory <= 500 MB: %s\n",
                ok ? "kept" : "NOT KEPT");
    return ok ? 0 : 1;
  } catch (const cavum::Error& e) {
    std::fprintf(stderr, "%s\n", e.what());
    return 2;
  }
}
