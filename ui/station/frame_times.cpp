// How long a picture of the tooth takes on this computer.
#include <fmt/core.h>

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <ctime>
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
  // the view turns, so that the shadow is made anew each time; or it stands still and the point moves
  const auto draw = [&](const std::string& what, bool turning) {
    std::vector<double> times_ms, processor_ms;
    DrawCount most;
    for (int i = 0; i < frames; ++i) {
      if (turning)
        view.camera.orbit(3.0F, 0.0F);
      else
        view.tool.tip_mm.x = 0.01 * (i % 50);
      const double before_s = processor_s();
      static_cast<void>(scene.picture(view, options.width, options.height));
      processor_ms.push_back(1e3 * (processor_s() - before_s));
      times_ms.push_back(scene.last_ms());
      most.draws = std::max(most.draws, scene.counted().draws);
      most.triangles = std::max(most.triangles, scene.counted().triangles);
    }
    std::sort(times_ms.begin(), times_ms.end());
    std::sort(processor_ms.begin(), processor_ms.end());
    std::printf("%s, %s: %.1f ms (median of %d), the quickest %.1f, 95 %% within %.1f; processor %.1f ms; at most %d draws, %d triangles\n",
                what.c_str(), turning ? "view turns" : "point moves", quantile_of_sorted(times_ms, 0.5), frames, times_ms.front(),
                quantile_of_sorted(times_ms, 0.95), quantile_of_sorted(processor_ms, 0.5), most.draws, most.triangles);
  };
  for (std::size_t level = 0; level < k_effects.size(); ++level) {
    if (k_effects[level].samples > 1 && window.software()) continue;  // nobody waits for that
    scene.fix_effects(level);
    for (const bool turning : {true, false}) draw(fmt::format("effects {}", level), turning);
  }
  scene.fix_effects(std::nullopt);
  draw("by itself", false);
  std::printf("it settled at effects %zu\n", scene.effects_level());
}

}  // namespace cavum::station
