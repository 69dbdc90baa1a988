#include "grading/breakthrough.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <deque>
#include <map>

#include "engine/base/pose.h"
#include "engine/base/vec.h"
#include "grading/motion.h"

namespace cavum {
namespace {

constexpr std::int64_t k_frame_ticks = 10;  // the detector's own step
constexpr double k_frame_s = 0.01;
constexpr double k_onset = 0.9;     // of the level: from there on the tip's way counts
constexpr double k_before_s = 0.3;  // before a fall opens: whence the tip came

/// Means over ten ticks.
struct Frame {
  Vec3 tip_mm, force_n, handle;  // handle: unit, along the tool towards the hand
  double noise_n2 = 0;           // variance of that mean force, all axes, as its ticks scatter
  bool cutting_possible = true;  // handpiece and pedal on, same point
};

std::vector<Frame> frames_of(std::span<const TickInput> inputs, std::span<const TickRecord> records) {
  std::vector<Frame> frames;
  for (std::size_t first = 0; first + k_frame_ticks <= inputs.size(); first += k_frame_ticks) {
    Frame f;
    for (std::size_t i = first; i < first + k_frame_ticks; ++i) {
      const auto& in = inputs[i];
      const auto& r = records[i];
      f.tip_mm += Vec3{in.tip_nm[0] * 1e-6, in.tip_nm[1] * 1e-6, in.tip_nm[2] * 1e-6} / double{k_frame_ticks};
      f.force_n += Vec3{r.rendered_un[0] * 1e-6, r.rendered_un[1] * 1e-6, r.rendered_un[2] * 1e-6} / double{k_frame_ticks};
      const bool turns = r.rpm >= k_turning_rpm && (in.flags & k_pedal_fresh) != 0 && in.pedal() > 0.05;
      if (!turns || (i > 0 && in.point != inputs[i - 1].point)) f.cutting_possible = false;
    }
    for (std::size_t i = first; i < first + k_frame_ticks; ++i) {
      const auto& r = records[i].rendered_un;
      const Vec3 off = Vec3{r[0] * 1e-6, r[1] * 1e-6, r[2] * 1e-6} - f.force_n;
      f.noise_n2 += dot(off, off) / double{k_frame_ticks * (k_frame_ticks - 1)};
    }
    f.handle = rotation(inputs[first].pose().rotation) * Vec3{0, 0, 1};
    frames.push_back(f);
  }
  return frames;
}

/// Median of the last `n` values: a sorted window.
class RunningMedian {
 public:
  explicit RunningMedian(std::size_t n) : window_(n) { sorted_.reserve(n); }
  void add(double v) {
    if (count_ >= window_.size()) sorted_.erase(std::lower_bound(sorted_.begin(), sorted_.end(), window_[count_ % window_.size()]));
    sorted_.insert(std::lower_bound(sorted_.begin(), sorted_.end(), v), v);
    window_[count_++ % window_.size()] = v;
  }
  void clear() {
    sorted_.clear();
    count_ = 0;
  }
  [[nodiscard]] bool ready() const { return 2 * sorted_.size() >= window_.size(); }
  [[nodiscard]] double value() const { return sorted_[sorted_.size() / 2]; }

 private:
  std::vector<double> window_, sorted_;
  std::size_t count_ = 0;
};

/// Places where the tip moved freely, in cells of 0.15 mm, with the frame when it first did.
class FreePlaces {
 public:
  void note(Vec3 p, std::int64_t frame) { first_.emplace(cell(p), frame); }
  /// Whether a place within `near_mm` of the line from `from` to `to`, ahead of `from`, was free before `frame`.
  [[nodiscard]] bool ahead(Vec3 from, Vec3 to, double near_mm, std::int64_t frame) const {
    const Vec3 way = to - from;
    const double long_mm = length(way);
    const Vec3 along = long_mm > 1e-6 ? way / long_mm : Vec3{0, 0, -1};
    const Vec3 low{std::min(from.x, to.x) - near_mm, std::min(from.y, to.y) - near_mm, std::min(from.z, to.z) - near_mm};
    const Vec3 high{std::max(from.x, to.x) + near_mm, std::max(from.y, to.y) + near_mm, std::max(from.z, to.z) + near_mm};
    const IVec3 a = cell(low), b = cell(high);
    for (int z = a.z; z <= b.z; ++z)
      for (int y = a.y; y <= b.y; ++y)
        for (int x = a.x; x <= b.x; ++x) {
          const auto found = first_.find({x, y, z});
          if (found == first_.end() || found->second >= frame) continue;
          const Vec3 at = Vec3{x + 0.5, y + 0.5, z + 0.5} * k_edge_mm - from;
          const double ahead_mm = dot(at, along);
          const Vec3 aside = at - along * ahead_mm;
          if (ahead_mm > 0.05 && ahead_mm < long_mm + near_mm && dot(aside, aside) < near_mm * near_mm) return true;
        }
    return false;
  }

 private:
  static constexpr double k_edge_mm = 0.15;
  [[nodiscard]] static IVec3 cell(Vec3 p) {
    return {static_cast<int>(std::floor(p.x / k_edge_mm)), static_cast<int>(std::floor(p.y / k_edge_mm)),
            static_cast<int>(std::floor(p.z / k_edge_mm))};
  }
  std::map<IVec3, std::int64_t> first_;
};

/// Size of the mean force of the last `n` frames, without what noise adds to it.
double size_n(const std::vector<Frame>& frames, std::int64_t last, std::int64_t n) {
  Vec3 sum;
  double noise = 0;
  const std::int64_t first = std::max<std::int64_t>(0, last - n + 1), count = last - first + 1;
  for (std::int64_t i = first; i <= last; ++i) {
    sum += frames[static_cast<std::size_t>(i)].force_n;
    noise += frames[static_cast<std::size_t>(i)].noise_n2;
  }
  const double c = static_cast<double>(count);
  return std::sqrt(std::max(0.0, (dot(sum, sum) - noise) / (c * c)));
}

std::size_t at(std::int64_t i) { return static_cast<std::size_t>(i); }

}  // namespace

std::vector<Breakthrough> find_breakthroughs(std::span<const TickInput> inputs, std::span<const TickRecord> records, const BreakthroughSettings& s) {
  std::vector<Breakthrough> found;
  const std::vector<Frame> frames = frames_of(inputs, records);
  const auto n = static_cast<std::int64_t>(frames.size());
  const auto count = [](double seconds) { return static_cast<std::int64_t>(seconds / k_frame_s + 0.5); };
  const std::int64_t memory = count(s.level_memory_s), gap = count(s.level_gap_s), longest = count(s.longest_s);
  RunningMedian median(at(count(s.level_s)));
  std::deque<std::pair<std::int64_t, double>> levels;  // recent medians that no later one exceeds, falling
  FreePlaces free_places;
  std::vector<double> push(at(n));  // force along the push
  Vec3 direction{0, 0, 1};          // of the force, out of the tooth, while the level held
  std::int64_t turning_since = 0;

  // the fall that is being watched
  std::int64_t opened = -1, onset = 0;
  double level = 0, least = 0;
  Breakthrough fall;
  Vec3 before_mm;
  bool spoilt = false, told = false;
  std::int64_t told_at = 0;
  const auto close = [&] {
    if (opened >= 0 && !spoilt && fall.sureness >= s.sure_from && fall.advance_mm >= s.least_advance_mm) found.push_back(fall);
    opened = -1;
  };
  for (std::int64_t i = 0; i < n; ++i) {
    const Frame& f = frames[at(i)];
    // two frames make a mean
    const Vec3 force = i > 0 ? (f.force_n + frames[at(i - 1)].force_n) * 0.5 : f.force_n;
    const double size = length(force);
    if (size < s.air_n + 0.02 && length(f.force_n) < s.air_n + 0.03) free_places.note(f.tip_mm, i);
    if (!f.cutting_possible) {
      close();
      median.clear();
      levels.clear();
      turning_since = i + 1;
      continue;
    }
    if (opened < 0) {
      // the direction of the push follows the force while it is there
      if (size > 0.6 * level && size > s.least_level_n) direction = normalized(direction * 0.9 + force * (0.1 / size), direction);
      push[at(i)] = size_n(frames, i, 2);
      if (i - gap >= turning_since) median.add(push[at(i - gap)]);
      if (!median.ready()) continue;
      const double now = median.value();
      while (!levels.empty() && levels.back().second <= now) levels.pop_back();
      levels.emplace_back(i, now);
      while (levels.front().first < i - memory) levels.pop_front();
      level = levels.front().second;
      if (level < s.least_level_n || push[at(i)] >= s.opens_at * level) continue;
      // a fall opens: back to where the force still was at its level
      opened = i;
      onset = i;
      while (onset > turning_since && i - onset < memory && push[at(onset)] < k_onset * level) --onset;
      std::int64_t dated = i;
      while (dated > onset && push[at(dated)] < s.dated_at * level) --dated;
      least = push[at(i)];
      before_mm = frames[at(std::max<std::int64_t>(turning_since, i - count(k_before_s)))].tip_mm;
      fall = {};
      fall.tick = dated * k_frame_ticks;
      fall.force_before_n = level;
      spoilt = told = false;
      std::int64_t dwell = 0;
      for (std::int64_t k = onset; k >= 0 && onset - k < count(10.0); --k)
        if (length(frames[at(k)].force_n) > 0.3 * level) {
          const Vec3 off = frames[at(k)].tip_mm - frames[at(onset)].tip_mm, aside = off - direction * dot(off, direction);
          if (dot(aside, aside) < s.dwell_mm * s.dwell_mm) ++dwell;
        }
      if (dwell < count(s.dwell_s)) spoilt = true;
      // a point that wanders sideways slips
      const Vec3 came = f.tip_mm - before_mm, aside = came - direction * dot(came, direction);
      if (length(aside) > s.slips_mm_s * k_before_s) spoilt = true;
      // one that bounces is no longer held by a level
      int bounces = 0;
      for (std::int64_t k = std::max<std::int64_t>(turning_since + 1, onset - count(0.8)); k < onset; ++k)
        bounces += push[at(k)] < s.opens_at * level && push[at(k - 1)] >= s.opens_at * level;
      if (bounces >= s.bounces) spoilt = true;
    } else {
      push[at(i)] = size_n(frames, i, 2);
    }
    const Vec3 way = f.tip_mm - frames[at(onset)].tip_mm;
    const double advance = -dot(way, direction);
    fall.advance_mm = std::max(fall.advance_mm, advance);
    // the least mean over 30 ms, before the tip gives way
    if (advance < fall.advance_mm - s.give_way_mm || dot(way, f.handle) > s.withdrawal_mm) {
      if (told && i - told_at <= count(s.confirm_s)) spoilt = true;
      close();
      // the force is gone because the tip is: wait for a new level
      median.clear();
      levels.clear();
      turning_since = i + 1;
      continue;
    }
    if (i - opened >= 2) {
      const double mean = size_n(frames, i, 3);
      if (mean < least || i - opened == 2) {
        least = i - opened == 2 ? mean : std::min(least, mean);
        const double rest = std::max(0.0, least) / level;
        // as likely as not at `rests_at`
        const double sure = std::clamp(1.0 - 0.5 * rest / s.rests_at, 0.0, 1.0);
        if (sure > fall.sureness) {
          if (fall.sureness < s.sure_from && sure >= s.sure_from) fall.seen_tick = (i + 1) * k_frame_ticks;
          fall.sureness = sure;
          fall.force_after_n = std::max(0.0, least);
        }
        if (!told && sure >= s.sure_from) {
          told = true;
          told_at = i;
          if (advance < fall.advance_mm - s.gives_mm) spoilt = true;  // it is on its way back already
          const Vec3 came = f.tip_mm - before_mm, aside = came - direction * dot(came, direction);
          if (length(aside) > s.strays_mm + s.strays_share * std::max(0.0, -dot(came, direction))) spoilt = true;
          if (free_places.ahead(frames[at(onset)].tip_mm, f.tip_mm, s.near_air_mm, onset - count(0.2))) spoilt = true;
        }
      }
    }
    if (push[at(i)] > 0.7 * level || i - opened > longest) {
      close();
      median.clear();
      levels.clear();
      turning_since = i + 1;
    }
  }
  close();
  return found;
}

}  // namespace cavum
