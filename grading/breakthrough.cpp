#include "grading/breakthrough.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>

#include "grading/freed_places.h"

namespace cavum {
namespace {

constexpr double k_before_s = 0.3;
std::size_t at(std::int64_t i) { return static_cast<std::size_t>(i); }
std::int64_t frames_in(double seconds) { return static_cast<std::int64_t>(seconds / k_frame_s + 0.5); }

/// exp(-x), x >= 0, without libm
double exp_minus(double x) {
  if (x > 40) return 0;
  double y = 1 + x / 1024 * (1 + x / 2048 * (1 + x / 3072));
  for (int i = 0; i < 10; ++i) y *= y;
  return 1 / y;
}

struct Fall {
  std::int64_t opened = -1, onset = 0;
  Vec3 before_mm;
  bool spoilt = false, asked = false;
  Breakthrough found;
  double recent[8]{};
};

}  // namespace

std::vector<Breakthrough> find_breakthroughs(std::span<const TickInput> inputs, std::span<const TickRecord> records, const BreakthroughSettings& s) {
  std::vector<Breakthrough> found;
  const std::vector<DrillFrame> frames = drill_frames(inputs, records);
  const auto n = static_cast<std::int64_t>(frames.size());
  ExpectedForce expected(s.expected);
  FreedPlaces freed;
  Fall fall;
  std::vector<double> share(at(n), 1.0);
  std::int64_t turning_since = 0;
  const std::int64_t confirm = std::min<std::int64_t>(8, frames_in(s.confirm_s) + 1);
  static const bool debug = std::getenv("BT_DEBUG") != nullptr;
  const auto close = [&] {
    if (fall.opened >= 0 && !fall.spoilt && fall.found.sureness >= s.sure_from) found.push_back(fall.found);
    fall = {};
  };
  for (std::int64_t i = 0; i < n; ++i) {
    const DrillFrame& f = frames[at(i)];
    expected.take(frames, i);
    if (length(f.force_n) < s.air_n) freed.note(f.tip_mm + f.force_n / std::max(0.5, expected.stiffness_n_per_mm()), i);
    if (!f.cutting_possible) {
      close();
      turning_since = i + 1;
      continue;
    }
    if (!expected.ready()) continue;
    const double F = expected.force_n(), G = expected.expected_n(), level = expected.level_n(), held = expected.held_n();
    if (debug && fall.opened < 0) std::fprintf(stderr, "%d F %.3f G %.3f held %.3f level %.3f K %.2f out %.2f %.2f %.2f\n", (int)i * 10, F, G, held, level, expected.stiffness_n_per_mm(), expected.out().x, expected.out().y, expected.out().z);
    share[at(i)] = G > 0 ? F / G : 1.0;
    if (fall.opened < 0) {
      if (held < s.least_level_n || G < s.held * held || F >= s.opens_at * G) continue;
      fall.opened = fall.onset = i;
      while (fall.onset > turning_since && i - fall.onset < frames_in(3.0) && share[at(fall.onset)] < 0.9) --fall.onset;
      std::int64_t dated = i;
      while (dated > fall.onset && share[at(dated)] < s.dated_at) --dated;
      fall.found.tick = dated * k_frame_ticks;
      fall.found.force_before_n = fall.found.force_after_n = held;
      fall.before_mm = frames[at(std::max<std::int64_t>(turning_since, i - frames_in(k_before_s)))].tip_mm;
      std::int64_t dwell = 0;
      for (std::int64_t k = fall.onset; k >= 0 && fall.onset - k < frames_in(10.0); --k)
        if (length(frames[at(k)].force_n) > 0.3 * held) {
          const Vec3 off = frames[at(k)].tip_mm - frames[at(fall.onset)].tip_mm, aside = off - expected.out() * dot(off, expected.out());
          if (dot(aside, aside) < s.dwell_mm * s.dwell_mm) ++dwell;
        }
      if (dot(expected.out(), f.handle) < -0.2) { fall.spoilt = true; if (debug) std::fprintf(stderr, "%d V withdrawn\n", (int)i * 10); }
      if (dwell < frames_in(s.dwell_s)) { fall.spoilt = true; if (debug) std::fprintf(stderr, "%d V dwell\n", (int)i * 10); }
      const Vec3 came = f.tip_mm - fall.before_mm, aside = came - expected.out() * dot(came, expected.out());
      if (length(aside) > s.slips_mm_s * k_before_s) { fall.spoilt = true; if (debug) std::fprintf(stderr, "%d V slips\n", (int)i * 10); }
    }
    const Vec3 way = f.tip_mm - frames[at(fall.onset)].tip_mm;
    fall.found.advance_mm = std::max(fall.found.advance_mm, -dot(way, expected.out()));
    // likelihoods
    double noise = 0, scatter = 0;
    for (std::int64_t k = std::max<std::int64_t>(0, i - 2); k <= i; ++k) {
      noise += frames[at(k)].noise_n2 / 3;
      scatter += frames[at(k)].scatter_n2 / 3;
    }
    const double mean_noise = std::sqrt(noise / 3 / 30);
    double sure = 0;
    if (G >= s.held * held && held >= s.least_level_n) {
      const double wide2 = s.void_rest * s.void_rest + mean_noise * mean_noise / (G * G);
      const double rest = F / G;
      const double likely = 0.798 / std::sqrt(wide2) * exp_minus(0.5 * rest * rest / wide2);
      sure = likely / (likely + s.soft_odds);
      const double chatter = std::sqrt(std::max(0.0, scatter - 1.5 * noise));
      if (chatter > s.chatter * held) sure = 0;
    }
    for (std::int64_t k = confirm - 1; k > 0; --k) fall.recent[k] = fall.recent[k - 1];
    fall.recent[0] = sure;
    const double confirmed = *std::min_element(fall.recent, fall.recent + confirm);
    if (confirmed > fall.found.sureness && fall.found.advance_mm >= s.least_advance_mm) {
      if (!fall.asked && confirmed > 0.2) {
        fall.asked = true;
        const Vec3 came = f.tip_mm - fall.before_mm, aside = came - expected.out() * dot(came, expected.out());
        if (length(aside) > s.strays_mm + s.strays_share * std::max(0.0, -dot(came, expected.out()))) { fall.spoilt = true; if (debug) std::fprintf(stderr, "%d V strays\n", (int)i * 10); }
        if (freed.ahead(frames[at(fall.onset)].tip_mm, f.tip_mm, s.near_air_mm, fall.onset - frames_in(0.2))) { fall.spoilt = true; if (debug) std::fprintf(stderr, "%d V ahead\n", (int)i * 10); }
        if (debug && fall.spoilt) std::fprintf(stderr, "spoilt at %d\n", (int)i * 10);
      }
      if (fall.found.sureness < 0.5) fall.found.seen_tick = (i + 1) * k_frame_ticks;
      fall.found.sureness = confirmed;
    }
    fall.found.force_after_n = std::min(fall.found.force_after_n, F);
    if (debug) std::fprintf(stderr, "%d F %.3f G %.3f held %.3f K %.2f sure %.2f conf %.2f spoilt %d adv %.2f\n", (int)i * 10, F, G, held, expected.stiffness_n_per_mm(), sure, confirmed, fall.spoilt, fall.found.advance_mm);
    if (F > s.closes_at * G || G < 0.3 * held || (fall.found.sureness >= 0.5 && F > 0.3 * G)) {
      const bool told = fall.found.sureness >= 0.5;
      close();
      if (told) { expected.forget(); turning_since = i + 1; }
    }
  }
  close();
  return found;
}

}  // namespace cavum
