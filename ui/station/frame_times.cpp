// How long a picture of the tooth takes on this computer.
#include <epoxy/gl.h>

#include <algorithm>
#include <chrono>
#include <cstdio>
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

double seconds_since(Clock::time_point t) { return std::chrono::duration<double>(Clock::now() - t).count(); }

}  // namespace

void print_frame_times(const StationOptions& options, int frames) {
  scenarios::ExamOptions exam;
  exam.candidate = "bench";
  exam.tooth_file = options.sitting.tooth;
  const auto setup = scenarios::prepare_exam(options.sitting.scenario, exam);
  const Window window({"Cavum", options.width, options.height, options.monitor});
  const auto began = Clock::now();
  Scene scene(setup->tooth.octree, setup->tooth.tissues, setup->points, nullptr);
  const double made_s = seconds_since(began);
  SceneView view;
  view.point = 0;
  view.tool.tip_mm = {0, 0, 3};
  std::vector<double> times_ms;
  for (int i = 0; i < frames; ++i) {
    view.camera.orbit(3.0F, 0.0F);
    const auto start = Clock::now();
    static_cast<void>(scene.picture(view, options.width, options.height, window.software() ? 1 : 4));
    glFinish();
    times_ms.push_back(1e3 * seconds_since(start));
  }
  std::sort(times_ms.begin(), times_ms.end());
  std::printf("%s, %d x %d, %zu triangles: first mesh %.2f s; a picture takes %.1f ms (median of %d), 95 %% within %.1f ms\n",
              renderer_name().c_str(), options.width, options.height, scene.tooth().triangles(), made_s, quantile_of_sorted(times_ms, 0.5), frames,
              quantile_of_sorted(times_ms, 0.95));
}

}  // namespace cavum::station
