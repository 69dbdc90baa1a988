// How long a picture of the tooth takes on this computer.
#include <fmt/core.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <ctime>
#include <string>
#include <vector>

#include "engine/statistics/order.h"
#include "scenarios/exam/exam.h"
#include "ui/station/gpu.h"
#include "ui/station/scene.h"
#include "ui/station/station.h"
#include "ui/station/window.h"

namespace cavum::station {
namespace {

using Clock = std::chrono::steady_clock;

/// Of all threads of the program.
double processor_s() {
  timespec t{};
  ::clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &t);
  return static_cast<double>(t.tv_sec) + 1e-9 * static_cast<double>(t.tv_nsec);
}
double seconds_since(Clock::time_point t) { return std::chrono::duration<double>(Clock::now() - t).count(); }

/// Of the whole computer, mean of the last minute: who waits for a core beside this program.
std::string load_text() {
  double load = 0;
  return ::getloadavg(&load, 1) == 1 ? fmt::format("{:.1f}", load) : "unknown";
}

/// What a picture may have beside tooth and instrument.
struct Beside {
  const char* name;
  bool ring, spray;
};
constexpr std::array<Beside, 3> k_beside{{{"neither", false, false}, {"ring", true, false}, {"ring, spray", true, true}}};

/// What pictures of one kind took.
struct Took {
  std::vector<double> ms, processor_ms;
  DrawCount most;
};

}  // namespace

void print_frame_times(const StationOptions& options, int frames) {
  scenarios::ExamOptions exam;
  exam.candidate = "bench";
  exam.tooth_file = options.sitting.tooth;
  const auto setup = scenarios::prepare_exam(options.sitting.scenario, exam);
  const Window window({"Cavum", options.width, options.height, options.monitor});
  const auto began = Clock::now();
  const double processor_before_s = processor_s();
  Scene scene(setup->tooth.octree, setup->tooth.tissues, setup->points, nullptr);
  const double made_s = seconds_since(began), made_processor_s = processor_s() - processor_before_s;
  SceneView view;
  view.point = 0;
  view.tool.tip_mm = {0, 0, 3};
  std::printf("%s, %d x %d: %zu triangles, %zu of them kept for drawing; first mesh %.2f s (processor %.2f s)\n", renderer_name().c_str(),
              options.width, options.height, scene.tooth().triangles(), scene.tooth().triangles_kept(), made_s, made_processor_s);
  std::printf("load of the computer: %s\n", load_text().c_str());
  std::printf("effects  picture      beside       ms: median  least  95 %%   of the processor  draws  triangles\n");
  // the view turns, so that the shadow is made anew each time; or it stands still and the point moves. What is compared is drawn by turns: other
  // programs hold up all of it alike
  const auto draw = [&](const std::string& level, bool turning) {
    std::array<Took, k_beside.size()> took;
    for (int i = 0; i < frames; ++i)
      for (std::size_t b = 0; b < k_beside.size(); ++b) {
        if (turning)
          view.camera.orbit(3.0F, 0.0F);
        else
          view.tool.tip_mm.x = 0.003 * ((3 * i + static_cast<int>(b)) % 160);
        view.foot = k_beside[b].ring;
        view.drops = k_beside[b].spray;
        view.spray = {0.05 * i, 1.0F, 1.0F, {0.9F, 0.9F, 0.8F}};
        const double before_s = processor_s();
        static_cast<void>(scene.picture(view, options.width, options.height));
        took[b].processor_ms.push_back(1e3 * (processor_s() - before_s));
        took[b].ms.push_back(scene.last_ms());
        took[b].most.draws = std::max(took[b].most.draws, scene.counted().draws);
        took[b].most.triangles = std::max(took[b].most.triangles, scene.counted().triangles);
      }
    for (std::size_t b = 0; b < k_beside.size(); ++b) {
      std::sort(took[b].ms.begin(), took[b].ms.end());
      std::sort(took[b].processor_ms.begin(), took[b].processor_ms.end());
      std::printf("%-8s %-12s %-12s %10.1f %6.1f %6.1f %17.1f %6d %10d\n", level.c_str(), turning ? "view turns" : "point moves", k_beside[b].name,
                  quantile_of_sorted(took[b].ms, 0.5), took[b].ms.front(), quantile_of_sorted(took[b].ms, 0.95),
                  quantile_of_sorted(took[b].processor_ms, 0.5), took[b].most.draws, took[b].most.triangles);
      std::fflush(stdout);
    }
  };
  for (std::size_t level = 0; level < k_effects.size(); ++level) {
    scene.fix_effects(level);
    for (const bool turning : {true, false}) draw(std::to_string(level), turning);
  }
  scene.fix_effects(std::nullopt);
  for (const bool turning : {true, false}) draw("by itself", turning);
  std::printf("it settled at effects %zu; load of the computer: %s\n", scene.effects_level(), load_text().c_str());
}

}  // namespace cavum::station
