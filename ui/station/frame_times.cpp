// How long a picture of the tooth takes on this computer.
#include <fmt/core.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <ctime>
#include <span>
#include <string>
#include <vector>

#include "engine/base/order.h"
#include "engine/tooth/octree_edit.h"
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
constexpr std::array<Beside, 3> k_beside{
    {{"neither", false, false}, {"ring", true, false}, {"ring, spray", true, true}}};

/// What pictures of one kind took.
struct Took {
  std::vector<double> ms, processor_ms;
  DrawCount most;
};

/// A tooth whose target's box is cut away, and that is cut on at its walls, a twentieth of a cubic
/// millimetre a picture.
class Opened {
 public:
  Opened(const Octree& tooth, const scenarios::ZoneMap& zones)
      : tooth_(tooth),
        middle_((zones.target_low_mm() + zones.target_high_mm()) * 0.5),
        half_((zones.target_high_mm() - zones.target_low_mm()) * 0.5) {
    tooth_.reserve_edits(200'000);
    removed_.reserve(1U << 21);
    cut(middle_, half_ + Vec3{0.5, 0.5, 0.5}, [this](Vec3 mm) {
      const Vec3 d = mm - middle_;
      return std::max({std::abs(d.x) - half_.x, std::abs(d.y) - half_.y, std::abs(d.z) - half_.z});
    });
  }
  [[nodiscard]] const Octree& tooth() const noexcept { return tooth_; }
  void cut_on() {
    constexpr double k_head_mm = 0.5, k_turn_rad = 0.07, k_outwards_mm = 0.0005, k_down_mm = 0.004;
    ++steps_;
    const double turn = k_turn_rad * steps_, wider = k_outwards_mm * steps_;
    const double down = std::fmod(k_down_mm * steps_, half_.z);
    const Vec3 at = middle_ + Vec3{(half_.x + wider) * std::cos(turn),
                                   (half_.y + wider) * std::sin(turn), -down};
    cut(at, {k_head_mm + 0.2, k_head_mm + 0.2, k_head_mm + 0.2},
        [at](Vec3 mm) { return length(mm - at) - k_head_mm; });
  }

 private:
  void cut(Vec3 middle, Vec3 reach, const auto& shape) {
    removed_.clear();
    static_cast<void>(tooth_.carve(middle - reach, middle + reach, shape, removed_));
  }
  Octree tooth_;
  Vec3 middle_, half_;
  std::vector<RemovedLeaf> removed_;
  int steps_ = 0;
};

/// Draws rows of the table.
class Bench {
 public:
  Bench(Scene& scene, int width, int height, int frames)
      : scene_(scene), width_(width), height_(height), frames_(frames) {
    view_.bur = 0;
    view_.tool.tip_mm = {0, 0, 3};
  }
  /// What is compared is drawn by turns: other programs hold up all of it alike. `cut` comes before
  /// each picture.
  void draw(const std::string& level, const char* name, bool turning,
            std::span<const Beside> besides, const auto& cut) {
    std::vector<Took> took(besides.size());
    for (int i = 0; i < frames_; ++i)
      for (std::size_t b = 0; b < besides.size(); ++b) {
        if (turning)  // so that the shadow is made anew each time
          view_.camera.orbit(3.0F, 0.0F);
        else
          view_.tool.tip_mm.x = 0.003 * ((3 * i + static_cast<int>(b)) % 160);
        view_.foot = besides[b].ring;
        view_.drops = besides[b].spray;
        view_.spray = {0.05 * i, 1.0F, 1.0F, {0.9F, 0.9F, 0.8F}};
        cut();
        picture(took[b]);
      }
    for (std::size_t b = 0; b < besides.size(); ++b) {
      auto& [ms, processor_ms, most] = took[b];
      std::sort(ms.begin(), ms.end());
      std::sort(processor_ms.begin(), processor_ms.end());
      std::printf("%-9s %-14s %-12s %8.1f %6.1f %6.1f %17.1f %6d %10d\n", level.c_str(), name,
                  besides[b].name, quantile_of_sorted(ms, 0.5), ms.front(),
                  quantile_of_sorted(ms, 0.95), quantile_of_sorted(processor_ms, 0.5), most.draws,
                  most.triangles);
      std::fflush(stdout);
    }
  }

 private:
  void picture(Took& took) {
    const double before_s = processor_s();
    const auto began = Clock::now();
    scene_.tooth().update();
    static_cast<void>(scene_.picture(view_, width_, height_));
    took.ms.push_back(1e3 * seconds_since(began));
    took.processor_ms.push_back(1e3 * (processor_s() - before_s));
    took.most.draws = std::max(took.most.draws, scene_.counted().draws);
    took.most.triangles = std::max(took.most.triangles, scene_.counted().triangles);
  }

  Scene& scene_;
  SceneView view_;
  int width_, height_, frames_;
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
  Scene scene(setup->tooth.octree, setup->tooth.tissues, setup->burs, nullptr);
  const double made_s = seconds_since(began), made_processor_s = processor_s() - processor_before_s;
  std::printf(
      "%s, %d x %d: %zu triangles, %zu of them kept for drawing; first mesh %.2f s (processor %.2f s)\n",
      renderer_name().c_str(), options.width, options.height, scene.tooth().triangles(),
      scene.tooth().triangles_kept(), made_s, made_processor_s);
  std::printf("load of the computer: %s\n", load_text().c_str());
  std::printf(
      "effects   picture        beside     ms: median  least   95 %%  of the processor  draws  triangles\n");
  Bench bench{scene, options.width, options.height, frames};
  const auto at_each_level = [&](const auto& rows) {
    for (std::size_t level = 0; level < k_effects.size(); ++level) {
      scene.fix_effects(level);
      rows(std::to_string(level));
    }
    scene.fix_effects(std::nullopt);
    rows("by itself");
  };
  at_each_level([&](const std::string& level) {
    bench.draw(level, "view turns", true, k_beside, [] {});
    bench.draw(level, "bur moves", false, k_beside, [] {});
  });

  Opened opened(setup->tooth.octree, setup->zones);
  scene.tooth().take(opened.tooth());
  scene.tooth().update();
  std::printf("the target's box cut away: %zu triangles kept for drawing\n",
              scene.tooth().triangles_kept());
  const auto ring_and_spray = std::span(k_beside).last(1);
  at_each_level([&](const std::string& level) {
    bench.draw(level, "opened, turns", true, ring_and_spray, [] {});
    bench.draw(level, "cuts on", false, ring_and_spray, [&] {
      opened.cut_on();
      scene.tooth().take(opened.tooth());
    });
  });
  std::printf("it settled at effects %zu; load of the computer: %s\n", scene.effects_level(),
              load_text().c_str());
}

}  // namespace cavum::station
