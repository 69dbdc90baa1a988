#include "grading/perforation/breakthrough.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "engine/base/det_math.h"
#include "grading/perforation/drill_frames.h"
#include "grading/perforation/freed_sites.h"

namespace cavum::grading {
namespace {

constexpr double k_as_likely_as_not = 0.5;
constexpr double k_onset_share = 0.9;     // of G: from there on the tip's way counts
constexpr double k_longest_onset_s = 3;   // a fall that began longer ago began with its opening
constexpr double k_came_s = 0.3;          // before a fall opens: whence the tip came
constexpr double k_dwell_back_s = 10;     // how far back cutting in the same place counts
constexpr double k_dwell_share = 0.3;     // of the force that held: it cuts there
constexpr double k_asked_from = 0.2;      // probability from which other explanations are asked for
constexpr double k_before_onset_s = 0.2;  // places freed since then belong to the fall itself
constexpr double k_noise_scatter =
    1.5;  // scatter of three frames by noise alone is below that, times its mean
constexpr double k_surely_n = 1.0;  // a force below that says to within 0.3 mm where the surface is
constexpr double k_lifted_share =
    0.3;  // of the held force: when the tip's motion leaves no more of G, the hand has lifted
constexpr std::size_t k_max_confirming = 8;

std::size_t at(std::int64_t i) { return static_cast<std::size_t>(i); }

/// The fall that is being watched.
struct Fall {
  std::int64_t onset =
      -1;  ///< frame in which nearly all of the force was still there; -1 = none is watched
  Vec3 came_from_mm;       ///< tip a while before it opened
  bool explained = false;  ///< by something else than a cavity
  bool asked = false;
  std::array<double, k_max_confirming> recent{};  ///< probability of the last frames, newest first
  Breakthrough found;
};

class Finder {
 public:
  Finder(std::span<const TickInput> inputs, std::span<const TickRecord> records,
         const BreakthroughSettings& settings)
      : s_(settings),
        frames_(drill_frames(inputs, records)),
        expected_(settings.expected),
        share_(frames_.size(), 1.0) {}

  std::vector<Breakthrough> run() {
    for (std::int64_t i = 0; i < static_cast<std::int64_t>(frames_.size()); ++i) take(i);
    close();
    return std::move(found_);
  }

 private:
  void take(std::int64_t i);
  void open(std::int64_t i);
  void watch(std::int64_t i);
  void close();
  /// Of a cavity, from what is left of the expected force.
  [[nodiscard]] double probability(std::int64_t i) const;
  /// Whether the fall is explained by how the tip came to its place: withdrawn, slipping, milling,
  /// or hardly there yet.
  [[nodiscard]] bool explained_before(std::int64_t i) const;
  /// Whether it is explained by where the tip went: off something, or into an earlier cut.
  [[nodiscard]] bool explained_after(std::int64_t i) const;
  [[nodiscard]] Vec3 aside(Vec3 way) const {
    return way - expected_.out() * dot(way, expected_.out());
  }
  [[nodiscard]] const DrillFrame& frame(std::int64_t i) const { return frames_[at(i)]; }

  const BreakthroughSettings& s_;
  std::vector<DrillFrame> frames_;
  ExpectedForce expected_;
  FreedSites freed_;
  std::vector<double> share_;  // F / G by frame
  std::int64_t turning_since_ = 0;
  Vec3 surface_mm_;  // in the frame before
  Fall fall_;
  std::vector<Breakthrough> found_;
};

void Finder::take(std::int64_t i) {
  const DrillFrame& f = frame(i);
  expected_.take(frames_, i);
  const Vec3 surface =
      f.tip_mm + f.force_n / expected_.stiffness_n_per_mm();  // it lies F / k before the tip
  if (length(f.force_n) < s_.freed_n &&
      (i == 0 || length(f.tip_mm - frame(i - 1).tip_mm) < s_.springs_mm_s * k_frame_s))
    freed_.note(i > 0 && length(frame(i - 1).force_n) < k_surely_n ? surface_mm_ : surface, surface,
                i);
  surface_mm_ = surface;
  if (!f.cutting_possible) {
    close();
    turning_since_ = i + 1;
    return;
  }
  if (!expected_.ready()) return;
  const double expected = expected_.expected_n();
  share_[at(i)] = expected > 0 ? expected_.force_n() / expected : 1.0;
  const bool presses =
      expected_.held_n() >= s_.least_n && expected >= s_.presses_on * expected_.held_n();
  if (fall_.onset < 0 && presses && share_[at(i)] < s_.opens_at) open(i);
  if (fall_.onset >= 0) watch(i);
}

void Finder::open(std::int64_t i) {
  fall_ = {};
  fall_.onset = i;
  while (fall_.onset > turning_since_ && i - fall_.onset < frames_in(k_longest_onset_s) &&
         share_[at(fall_.onset)] < k_onset_share)
    --fall_.onset;
  std::int64_t dated = i;
  while (dated > fall_.onset && share_[at(dated)] < s_.dated_at) --dated;
  fall_.found.tick = dated * k_frame_ticks;
  fall_.found.force_before_n = fall_.found.force_after_n = expected_.held_n();
  fall_.came_from_mm = frame(std::max(turning_since_, i - frames_in(k_came_s))).tip_mm;
  fall_.explained = explained_before(i);
}

void Finder::watch(std::int64_t i) {
  Breakthrough& found = fall_.found;
  const Vec3 way = frame(i).tip_mm - frame(fall_.onset).tip_mm;
  found.advance_mm = std::max(found.advance_mm, -dot(way, expected_.out()));
  found.force_after_n = std::min(found.force_after_n, expected_.force_n());
  std::copy_backward(fall_.recent.begin(), fall_.recent.end() - 1, fall_.recent.end());
  fall_.recent[0] = found.advance_mm >= s_.least_advance_mm ? probability(i) : 0.0;
  const auto confirming = std::min<std::int64_t>(k_max_confirming, frames_in(s_.confirm_s) + 1);
  const double sure = *std::min_element(fall_.recent.begin(), fall_.recent.begin() + confirming);
  if (sure > found.probability) {
    if (!fall_.asked && sure > k_asked_from) {
      fall_.asked = true;
      if (explained_after(i)) fall_.explained = true;
    }
    if (found.probability < k_as_likely_as_not) found.seen_tick = (i + 1) * k_frame_ticks;
    found.probability = sure;
  }
  const bool told = found.probability >= k_as_likely_as_not;
  const bool lifted = expected_.expected_n() < k_lifted_share * expected_.held_n();
  if ((told ? expected_.force_n() / expected_.pressed_n() > s_.returns_at
            : share_[at(i)] > s_.closes_at) ||
      lifted) {
    close();
    if (told) {  // a new level has to build up
      expected_.forget();
      turning_since_ = i + 1;
    }
  }
}

void Finder::close() {
  if (fall_.onset >= 0 && !fall_.explained && fall_.found.probability >= s_.sure_from)
    found_.push_back(fall_.found);
  fall_ = {};
}

double Finder::probability(std::int64_t i) const {
  const double expected = expected_.expected_n(), pressed = expected_.pressed_n(),
               rest = expected_.force_n() / pressed;
  if (expected_.held_n() < s_.least_n || expected < s_.presses_on * expected_.held_n()) return 0.0;
  double noise_n2 = 0, scatter_n2 = 0;  // per tick
  for (std::int64_t k = std::max<std::int64_t>(0, i - k_mean_frames + 1); k <= i; ++k) {
    noise_n2 += frame(k).noise_n2 / k_mean_frames;
    scatter_n2 += frame(k).scatter_n2 / k_mean_frames;
  }
  if (scatter_n2 - k_noise_scatter * noise_n2 > s_.chatter * s_.chatter * expected * expected)
    return 0.0;
  // variance of the share, one axis of the mean over the frames
  const double noise = noise_n2 / (3.0 * k_mean_frames * k_frame_ticks * pressed * pressed);
  const double wide2 = s_.void_rest * s_.void_rest + noise;
  const double likely = std::sqrt(2.0 / (k_pi * wide2)) * det_exp(-0.5 * rest * rest / wide2);
  return likely / (likely + s_.soft_odds);
}

bool Finder::explained_before(std::int64_t i) const {
  if (dot(expected_.out(), frame(i).handle) < s_.least_axial) return true;
  if (length(aside(frame(i).tip_mm - fall_.came_from_mm)) > s_.slips_mm_s * k_came_s) return true;
  std::int64_t dwell = 0;
  for (std::int64_t k = fall_.onset; k >= 0 && fall_.onset - k < frames_in(k_dwell_back_s); --k)
    if (length(frame(k).force_n) > k_dwell_share * expected_.held_n() &&
        length(aside(frame(k).tip_mm - frame(fall_.onset).tip_mm)) < s_.dwell_mm)
      ++dwell;
  return dwell < frames_in(s_.dwell_s);
}

bool Finder::explained_after(std::int64_t i) const {
  const Vec3 came = frame(i).tip_mm - fall_.came_from_mm;
  if (length(aside(came)) >
      s_.strays_mm + s_.strays_share * std::max(0.0, -dot(came, expected_.out())))
    return true;
  return freed_.ahead(frame(fall_.onset).tip_mm, frame(i).tip_mm, s_.near_freed_mm,
                      fall_.onset - frames_in(k_before_onset_s));
}

}  // namespace

std::vector<Breakthrough> find_breakthroughs(std::span<const TickInput> inputs,
                                             std::span<const TickRecord> records,
                                             const BreakthroughSettings& settings) {
  return Finder(inputs, records, settings).run();
}

}  // namespace cavum::grading
