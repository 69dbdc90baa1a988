#include "tests/ui/person/person.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <stdexcept>
#include <thread>

namespace cavum::testing_person {
namespace {

void wait_s(double s) { std::this_thread::sleep_for(std::chrono::duration<double>(s)); }

double length_mm(const Way& way) {
  double mm = 0;
  for (std::size_t i = 1; i < way.size(); ++i) mm += length(way[i] - way[i - 1]);
  return mm;
}

/// So far along a way; beyond its end straight on, 0.3 mm at most.
Vec3 at(const Way& way, double mm) {
  for (std::size_t i = 1; i < way.size(); ++i) {
    const double piece = length(way[i] - way[i - 1]);
    if (mm <= piece) return way[i - 1] + (way[i] - way[i - 1]) * (std::max(0.0, mm) / piece);
    mm -= piece;
  }
  constexpr double k_beyond_mm = 0.3;
  return way.back() + normalized(way.back() - way[way.size() - 2]) * std::min(mm, k_beyond_mm);
}

/// How far along the way its place nearest to `tip` lies, seen from above; no further than
/// `most_mm`.
double nearest_mm(const Way& way, Vec3 tip, double most_mm) {
  double best = 1e9, found = 0, before = 0;
  for (std::size_t i = 1; i < way.size(); ++i) {
    const Vec3 piece = way[i] - way[i - 1], to = tip - way[i - 1];
    if (before > most_mm) break;
    const double size = length(piece),
                 t = std::clamp((piece.x * to.x + piece.y * to.y) / (size * size), 0.0, 1.0);
    const Vec3 off = tip - (way[i - 1] + piece * t);
    if (const double mm = std::hypot(off.x, off.y); mm < best) {
      best = mm;
      found = std::min(most_mm, before + t * size);
    }
    before += size;
  }
  return found;
}

}  // namespace

std::vector<Way> ways_through(const scenarios::ZoneMap& zones, double radius_mm) {
  constexpr double k_grid_mm = 0.05, k_slice_mm = 0.3, k_layer_mm = 1.6, k_spared_mm = 0.05;
  const Vec3 low = zones.target_low_mm(), high = zones.target_high_mm();
  const bool along_x = high.x - low.x > high.y - low.y;
  const double floor_mm = zones.floor_level_mm();
  struct Slice {
    double u = 0, from = 1e9, to = -1e9, top = -1e9;
  };
  const auto place = [along_x](double u, double v, double z) {
    return along_x ? Vec3{u, v, z} : Vec3{v, u, z};
  };
  std::vector<Slice> slices;
  const double u_low = along_x ? low.x : low.y, u_high = along_x ? high.x : high.y,
               v_low = along_x ? low.y : low.x, v_high = along_x ? high.y : high.x;
  constexpr double k_middle_mm = 0.85;  // above the floor: no surface is nearer than the walls
  for (double u = u_low; u <= u_high; u += k_grid_mm) {
    Slice s{.u = u};
    for (double v = v_low; v <= v_high; v += k_grid_mm)
      if (zones.distance_mm(place(u, v, floor_mm + k_middle_mm)) < -(radius_mm - k_spared_mm)) {
        s.from = std::min(s.from, v);
        s.to = std::max(s.to, v);
      }
    if (s.from > s.to) continue;
    for (double z = floor_mm; z <= high.z; z += k_grid_mm)
      for (const double v : {s.from - radius_mm, s.from, s.to, s.to + radius_mm})
        if (zones.distance_mm(place(u, v, z)) < 0) s.top = std::max(s.top, z);
    slices.push_back(s);
  }
  std::vector<Way> ways;
  bool forward = true;
  constexpr double k_above_floor_mm = 0.02;
  for (double z = high.z - k_layer_mm;; z = std::max(z - k_layer_mm, floor_mm + k_above_floor_mm)) {
    // there along one wall, back along the other
    for (const bool upper : {false, true}) {
      Way way;
      for (std::size_t i = 0; i < slices.size(); ++i) {
        const Slice& s = slices[forward ? i : slices.size() - 1 - i];
        const Vec3 next = place(s.u, upper ? s.to : s.from, z);
        const bool last = i + 1 == slices.size();
        if (z < s.top + 0.1 && (way.empty() || last || length(next - way.back()) >= k_slice_mm))
          way.push_back(next);
      }
      if (way.size() > 1) ways.push_back(way);
      forward = !forward;
    }
    if (z <= floor_mm + k_above_floor_mm) break;
  }
  return ways;
}

Seen Person::look() const {
  const Seen first = eye_();
  constexpr double k_patience_s = 20.0;
  const auto began = std::chrono::steady_clock::now();
  for (;;) {
    Seen now = eye_();
    if (now.picture >= first.picture + 2) return now;  // the running one may have begun before
    if (std::chrono::duration<double>(std::chrono::steady_clock::now() - began).count() >
        k_patience_s)
      throw std::runtime_error("no picture came for 20 s");
    wait_s(0.003);
  }
}

Vec3 Person::at_rest() const {
  constexpr double k_still_mm = 0.03;
  constexpr int k_pictures = 60;
  Vec3 last = look().tip_mm;
  for (int i = 0, still = 0; i < k_pictures && still < 3; ++i) {
    const Vec3 now = look().tip_mm;
    still = length(now - last) < k_still_mm ? still + 1 : 0;
    last = now;
  }
  return last;
}

void Person::learn() {
  constexpr double k_moved_mm = 0.2;
  constexpr int k_tries = 10;
  // the first way of a mouse may only tell where it is
  static_cast<void>(means_.move({0.4, 0.4, 0}));
  static_cast<void>(means_.move({-0.4, -0.4, 0}));
  for (std::size_t i = 0; i < 3; ++i) {
    Vec3 units;
    (i == 0 ? units.x : i == 1 ? units.y : units.z) = 0.8;
    // a hand that sees nothing move does it once more
    for (int n = 0;; ++n) {
      const Vec3 before = at_rest();
      const Vec3 did = means_.move(units);
      wait_s(0.3);
      const Vec3 way = at_rest() - before;
      per_unit_mm_[i] = way / length(did);
      if (length(way) > k_moved_mm) break;
      if (n == k_tries) throw std::runtime_error("the tip did not follow the hand");
    }
    static_cast<void>(means_.move(units * -1.0));
    wait_s(0.3);
  }
  wanted_mm_ = at_rest();
}

void Person::want(Vec3 tip_mm) {
  const Vec3 way = tip_mm - wanted_mm_;
  const auto& [a, b, c] = per_unit_mm_;
  const double volume = dot(a, cross(b, c));
  const Vec3 units{dot(way, cross(b, c)) / volume, dot(way, cross(c, a)) / volume,
                   dot(way, cross(a, b)) / volume};
  const Vec3 did = means_.move(units);
  wanted_mm_ += a * did.x + b * did.y + c * did.z;
}

int Person::follow(const Way& way) {
  // the hand aims at the line, a little ahead of the tip, and never further from the tip than it
  // would press
  constexpr double k_near_mm = 0.08, k_ahead_mm = 0.6, k_max_ahead_mm = 1.0, k_press_mm = 0.7,
                   k_patience_s = 25.0, k_progress_mm = 0.05, k_on_line_mm = 0.4,
                   k_max_aside_mm = 2.0, k_above_mm = 0.15, k_beside_mm = 0.25;
  bool begun = false;
  double done_mm = 0.0, deepest_mm = 1e9, ahead_mm = k_ahead_mm;
  auto progressed = std::chrono::steady_clock::now();
  for (;;) {
    const Vec3 tip = look().tip_mm;
    const double at_mm = begun ? nearest_mm(way, tip, done_mm + k_max_ahead_mm) : 0.0,
                 all_mm = length_mm(way);
    const Vec3 there = at(way, at_mm), off = tip - there;
    begun = begun || length(off) < k_on_line_mm;
    if (all_mm - at_mm < k_near_mm && length(off) < 2 * k_near_mm) return 0;
    const auto now = std::chrono::steady_clock::now();
    if (at_mm > done_mm + k_progress_mm || tip.z < deepest_mm - k_progress_mm) {
      done_mm = std::max(done_mm, at_mm);
      deepest_mm = std::min(deepest_mm, tip.z);
      ahead_mm = k_ahead_mm;
      progressed = now;
    } else {
      ahead_mm = std::min(ahead_mm + 0.1, k_max_ahead_mm);
      if (std::chrono::duration<double>(now - progressed).count() > k_patience_s) return 1;
    }
    // over the line first, then down to it, then along it
    Vec3 aim = off.z > k_above_mm ? there : at(way, at_mm + ahead_mm);
    if (off.z > k_above_mm && std::hypot(off.x, off.y) > k_beside_mm) aim.z = tip.z;
    const Vec3 way_there = aim - tip;
    const double far_mm = length(way_there);
    // what it adds on the other side holds no way up: what of it points back along the way there
    // was of another piece of line
    if (far_mm > 0)
      aside_mm_ -=
          way_there * (0.25 * std::max(0.0, dot(aside_mm_, way_there)) / (far_mm * far_mm));
    if (far_mm > k_press_mm) aim = tip + way_there * (k_press_mm / far_mm);
    // what keeps the tip off the line, be it the tooth or that the hand is elsewhere than it
    // believes: as much is added on the other side
    if (begun) {
      aside_mm_ += Vec3{off.x, off.y, off.z > k_above_mm ? 0.0 : off.z} * 0.25;
      if (const double size = length(aside_mm_); size > k_max_aside_mm)
        aside_mm_ = aside_mm_ * (k_max_aside_mm / size);
      aim -= off * (0.5 * std::min(1.0, k_on_line_mm / std::max(length(off), k_near_mm)));
    }
    want(aim - aside_mm_);
  }
}

void Person::lift(double mm) {
  want(look().tip_mm + Vec3{0, 0, mm});
  wait_s(0.5);
}

}  // namespace cavum::testing_person
