#include "grading/perforation/drill_frames.h"

#include <algorithm>
#include <cmath>

#include "engine/base/pose.h"
#include "grading/measures/motion.h"

namespace cavum::grading {
namespace {

constexpr double k_pedal_on = 0.05;
// A force scatters by noise all the time, and by chatter and steps of the encoder now and then: the
// noise is what the quieter frames of the last two seconds show.
constexpr std::size_t k_noise_frames = 200;
constexpr std::size_t k_quiet_share = 4;  // the frame at the lower quarter

}  // namespace

std::vector<DrillFrame> drill_frames(std::span<const TickInput> inputs,
                                     std::span<const TickRecord> records) {
  std::vector<DrillFrame> frames;
  frames.reserve(inputs.size() / k_frame_ticks);
  constexpr double share = 1.0 / k_frame_ticks;
  std::vector<double> quiet;  // scatter of the last frames, sorted
  for (std::size_t first = 0; first + k_frame_ticks <= inputs.size(); first += k_frame_ticks) {
    DrillFrame f;
    const auto force = [&](std::size_t i) {
      const auto& r = records[i].rendered_un;
      return Vec3{r[0] * 1e-6, r[1] * 1e-6, r[2] * 1e-6};
    };
    for (std::size_t i = first; i < first + k_frame_ticks; ++i) {
      const auto& in = inputs[i];
      f.tip_mm += Vec3{in.tip_nm[0] * 1e-6, in.tip_nm[1] * 1e-6, in.tip_nm[2] * 1e-6} * share;
      f.force_n += force(i) * share;
      const bool turns = records[i].rpm >= k_turning_rpm && (in.flags & k_pedal_fresh) != 0 &&
                         in.pedal() > k_pedal_on;
      if (!turns || (i > 0 && in.bur != inputs[i - 1].bur)) f.cutting_possible = false;
    }
    for (std::size_t i = first; i < first + k_frame_ticks; ++i) {
      const Vec3 off = force(i) - f.force_n;
      f.scatter_n2 += dot(off, off) / double{k_frame_ticks - 1};
    }
    f.handle = rotation(inputs[first].pose().rotation) * Vec3{0, 0, 1};
    quiet.insert(std::lower_bound(quiet.begin(), quiet.end(), f.scatter_n2), f.scatter_n2);
    if (quiet.size() > k_noise_frames) {
      const double oldest = frames[frames.size() - k_noise_frames].scatter_n2;
      quiet.erase(std::lower_bound(quiet.begin(), quiet.end(), oldest));
    }
    f.noise_n2 = quiet[quiet.size() / k_quiet_share];
    frames.push_back(f);
  }
  return frames;
}

Vec3 mean_force_n(std::span<const DrillFrame> frames, std::int64_t last,
                  std::int64_t count) noexcept {
  Vec3 sum;
  const std::int64_t first = std::max<std::int64_t>(0, last - count + 1);
  for (std::int64_t i = first; i <= last; ++i) sum += frames[static_cast<std::size_t>(i)].force_n;
  return sum / static_cast<double>(last - first + 1);
}

double force_size_n(std::span<const DrillFrame> frames, std::int64_t last,
                    std::int64_t count) noexcept {
  const Vec3 mean = mean_force_n(frames, last, count);
  const std::int64_t ticks = std::min(last + 1, count) * k_frame_ticks;
  return std::sqrt(std::max(0.0, dot(mean, mean) - frames[static_cast<std::size_t>(last)].noise_n2 /
                                                       static_cast<double>(ticks)));
}

}  // namespace cavum::grading
