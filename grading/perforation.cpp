#include "grading/perforation.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <deque>
#include <map>
#include <utility>

#include "grading/motion.h"

namespace cavum {
namespace {

constexpr std::int64_t k_confirm_ticks = 100;
constexpr double k_reach_mm = 1.0;  // from the place of a drop in force to the tissue it may be a breakthrough into

/// Where the tip has been, and when first.
class Visits {
 public:
  explicit Visits(double edge_mm) : edge_mm_(edge_mm) {}
  void note(Vec3 p, std::int64_t tick) { first_.emplace(cell(p), tick); }
  /// Whether the tip was in this cell before `tick`.
  [[nodiscard]] bool before(Vec3 p, std::int64_t tick) const {
    const auto found = first_.find(cell(p));
    return found != first_.end() && found->second < tick;
  }

 private:
  [[nodiscard]] IVec3 cell(Vec3 p) const {
    return {static_cast<int>(std::floor(p.x / edge_mm_)), static_cast<int>(std::floor(p.y / edge_mm_)), static_cast<int>(std::floor(p.z / edge_mm_))};
  }
  double edge_mm_;
  std::map<IVec3, std::int64_t> first_;
};

/// Median of the last `n` values of a series: a sorted window.
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

/// Tip of the diamond point where the tooth lets it be; the device's own tip is pressed in further, by X.
Vec3 place_of(const TickRecord& r) { return {r.proxy_nm[0] * 1e-6, r.proxy_nm[1] * 1e-6, r.proxy_nm[2] * 1e-6}; }
Vec3 tip_of(const TickInput& in) { return {in.tip_nm[0] * 1e-6, in.tip_nm[1] * 1e-6, in.tip_nm[2] * 1e-6}; }

}  // namespace

std::vector<PerforationEvent> detect_breakthroughs(std::span<const TickInput> inputs, std::span<const TickRecord> records,
                                                   const DetectorSettings& s) {
  std::vector<PerforationEvent> events;
  const auto n = static_cast<std::int64_t>(inputs.size());
  const auto at = [](std::int64_t i) { return static_cast<std::size_t>(i); };

  // the force, smoothed, and its vector for the direction of the push
  std::vector<double> force(at(n));
  std::vector<Vec3> push(at(n));
  Vec3 sum;
  for (std::int64_t i = 0; i < n; ++i) {
    const auto vector_of = [&](std::int64_t k) {
      const auto& r = records[at(k)].rendered_un;
      return Vec3{r[0] * 1e-6, r[1] * 1e-6, r[2] * 1e-6};
    };
    sum += vector_of(i);
    if (i >= s.smooth_ticks) sum -= vector_of(i - s.smooth_ticks);
    push[at(i)] = sum / static_cast<double>(std::min<std::int64_t>(i + 1, s.smooth_ticks));
    force[at(i)] = length(push[at(i)]);
  }

  Visits visits(s.visited_mm);
  RunningMedian median(at(s.level_ticks));
  std::int64_t down_since = -1, quiet_until = 0, turning_since = 0;
  bool armed = false;                                  // the force had a level worth falling from
  double level = 0;                                    // frozen while the force is down
  std::deque<std::pair<std::int64_t, double>> levels;  // recent medians that no later one exceeds, falling
  Vec3 direction;                                      // of the push while the level held
  for (std::int64_t i = 0; i < n; ++i) {
    const TickRecord& r = records[at(i)];
    visits.note(tip_of(inputs[at(i)]), i);
    const bool turns = r.rpm >= k_turning_rpm && (inputs[at(i)].flags & k_pedal_fresh) != 0 && inputs[at(i)].pedal() > 0.05;
    if (!turns || (i > 0 && inputs[at(i)].point != inputs[at(i - 1)].point)) {
      median.clear();
      levels.clear();
      armed = false;
      down_since = -1;
      turning_since = i + 1;
      continue;
    }
    const std::int64_t gap = i - s.level_gap_ticks;
    const bool is_down = armed && force[at(i)] < s.fall * level;
    if (!is_down) {
      down_since = -1;
      if (gap >= turning_since) median.add(force[at(gap)]);
      if (median.ready()) {
        const double now = median.value();
        while (!levels.empty() && levels.back().second <= now) levels.pop_back();
        levels.emplace_back(i, now);
        while (levels.front().first < i - s.longest_fall_ticks) levels.pop_front();
        level = levels.front().second;
        armed = level >= s.least_level_n;
        if (armed && force[at(i)] >= s.onset * level) direction = normalized(push[at(i)], direction);
      }
      continue;
    }
    if (down_since < 0) down_since = i;
    if (i - down_since + 1 < s.hold_ticks) continue;
    if (i - down_since + 1 > s.hold_ticks) {  // judged once; wait for the force to come back, or for a new level
      if (i - down_since > s.longest_fall_ticks) {
        median.clear();
        levels.clear();
        armed = false;
        turning_since = i + 1;
      }
      continue;
    }
    // onset: back to where the force still was at its level
    std::int64_t onset = down_since;
    while (onset > turning_since && down_since - onset < s.longest_fall_ticks && force[at(onset)] < s.onset * level) --onset;
    if (down_since - onset >= s.longest_fall_ticks || i < quiet_until) continue;
    onset = std::max(turning_since, onset - s.smooth_ticks / 2);  // the mean lags by half its length
    const Vec3 from = tip_of(inputs[at(onset)]), to = tip_of(inputs[at(i)]), way = to - from;
    const double advance = -dot(way, direction);
    // what the tip would have gone in that time anyway
    const std::int64_t earlier = std::max<std::int64_t>(turning_since, onset - (i - onset));
    const double usual = std::max(0.0, -dot(from - tip_of(inputs[at(earlier)]), direction));
    const bool deeper = advance >= s.least_advance_mm && advance >= s.keeps_up * usual && advance >= s.straightness * length(way) &&
                        way.z <= s.withdrawal * length(way);
    if (!deeper || visits.before(to, onset - s.visited_ticks)) continue;
    std::int64_t fell = down_since;
    while (fell > onset && force[at(fell)] < s.time_at * level) --fell;
    PerforationEvent e;
    e.tick = std::max(onset, fell - s.smooth_ticks / 2);
    e.seen_tick = i;
    e.site_mm = place_of(records[at(e.tick)]);
    e.force_before_n = level;
    e.force_after_n = force[at(i)];
    e.advance_mm = advance;
    events.push_back(e);
    quiet_until = i + s.refractory_ticks;
  }
  return events;
}

namespace {

/// True when the untouched tooth holds a tissue of role 1 or 2 within k_reach_mm of a place: elsewhere there is nothing to break into.
bool near_role(const Octree& before, const std::array<int, 256>& role, Vec3 site_mm) {
  constexpr double k_step_mm = 0.1;
  const int n = static_cast<int>(k_reach_mm / k_step_mm);
  for (int z = -n; z <= n; ++z)
    for (int y = -n; y <= n; ++y)
      for (int x = -n; x <= n; ++x)
        if (x * x + y * y + z * z <= n * n && role[before.tissue_at(site_mm + Vec3{double(x), double(y), double(z)} * k_step_mm)] != 0) return true;
  return false;
}

}  // namespace

PerforationMeasures measure_perforation(const GradeInput& input, std::int64_t ticks) {
  PerforationMeasures p;
  const PerforationSpec& spec = input.scenario.perforation;
  std::array<int, 256> role{};  // 1 aim, 2 fault
  for (const auto& t : input.before.tissues) {
    const auto among = [&](const std::vector<std::string>& list) { return std::find(list.begin(), list.end(), t.name) != list.end(); };
    role[t.id] = among(spec.aims) ? 1 : among(spec.faults) ? 2 : 0;
  }
  const double leaf_mm3 = input.zones.leaf_volume_mm3();
  std::array<std::vector<std::int64_t>, 3> touched;  // ticks, by role, in order
  for (const auto& r : input.removed) {
    if (r.tick >= ticks || role[r.leaf.tissue] == 0) continue;
    PerforationTruth& truth = role[r.leaf.tissue] == 1 ? p.aim : p.fault;
    if (!truth.perforated) {
      truth.perforated = true;
      truth.first = {r.tick, input.zones.centre_mm(r.leaf.leaf())};
      truth.tissue = input.before.tissue_name(r.leaf.tissue);
    }
    truth.volume_mm3 += leaf_mm3;
    touched[static_cast<std::size_t>(role[r.leaf.tissue])].push_back(r.tick);
  }
  const auto counted = std::min<std::size_t>(input.inputs.size(), static_cast<std::size_t>(ticks));
  p.events = detect_breakthroughs(input.inputs.first(counted), input.records.first(counted));
  // whoever cuts through the last wall between two grooves falls too, but into the cavity
  std::erase_if(p.events, [&](const PerforationEvent& e) { return !near_role(input.before.octree, role, e.site_mm); });
  for (auto& e : p.events) {
    const double beyond = input.zones.distance_mm(e.site_mm);
    const double leeway = std::max(input.scenario.zones.leeway.sides_mm, input.scenario.zones.leeway.bottom_mm);
    e.fault = spec.aims.empty() || beyond > leeway;
    const auto& list = touched[e.fault ? 2 : 1];
    const auto near = std::lower_bound(list.begin(), list.end(), e.tick - k_confirm_ticks);
    e.confirmed = near != list.end() && *near <= e.tick + k_confirm_ticks;
  }
  return p;
}

}  // namespace cavum
