#include "scenarios/operators/operator.h"

#include <algorithm>
#include <cmath>
#include <string_view>

#include "engine/base/error.h"

namespace cavum::scenarios {
namespace {

constexpr double k_free_speed_mm_s = 5.0;  // through the air near the tooth
constexpr double k_arrived_mm = 0.04;  // cutting; ways through the air need not end that exactly
constexpr double k_lead_rate_mm_s = 15.0;    // how fast the hand builds up its push
constexpr double k_correction = 2.0;         // of an error across the way ...
constexpr double k_max_correction_mm = 0.8;  // ... up to this
constexpr double k_astray_mm = 0.06;         // further off the way it no longer goes on along it
constexpr double k_friction_n = 0.26;        // of the device's joints: a practised hand knows it
constexpr double k_felt_n = 0.02;
constexpr double k_firmest = 1.3;  // of the way that a push goes before its force is there: a hand
                                   // that is held up pushes no harder
constexpr double k_turning_s = 0.06;  // in which a push changes its direction
constexpr double k_intention_s = 0.025;
constexpr double k_gentle_bend = 0.7;  // cosine between two pieces of the way
constexpr double k_give_up_s = 1.5;    // without getting nearer
constexpr double k_upright = 0.5;      // cosine: flatter, the tooth is entered from its side
constexpr double k_curved_spacing_mm = 0.15;

/// 0..100 of "student-LEVEL", else -1.
int level_in(const std::string& name) {
  constexpr std::string_view k_begin = "student-";
  const std::string digits = name.starts_with(k_begin) ? name.substr(k_begin.size()) : "";
  if (digits.empty() || digits.size() > 3 ||
      digits.find_first_not_of("0123456789") != std::string::npos)
    return -1;
  const int level = std::stoi(digits);
  return level <= 100 ? level : -1;
}

/// Between a beginner worse than the novice (0) and an expert (1); what is wrong with the hand
/// varies from student to student, and its size shrinks with skill.
Skill student(double level, std::uint64_t seed) {
  Random random(seed);
  const double lack = 1.0 - level;
  const auto between = [&](double beginner, double expert) {
    return expert + lack * (beginner - expert);
  };
  Skill s;
  s.name = "student";
  s.press_n = between(random.uniform(0.7, 1.2), s.press_n);
  s.careful_press_n = between(random.uniform(0.55, 0.9), s.careful_press_n);
  s.reaction_s = between(0.18, s.reaction_s);
  s.tremor_mm = between(random.uniform(0.05, 0.1), s.tremor_mm);
  s.offset_mm = Vec3{random.uniform(-0.7, 0.7), random.uniform(-0.7, 0.7), 0} * lack;
  s.stops_short = lack * random.uniform(0.0, 0.2);
  s.hand.stiffness_n_per_mm = between(random.uniform(0.8, 1.4), s.hand.stiffness_n_per_mm);
  s.perforates = random.uniform() < 0.2 * lack * lack;
  return s;
}

}  // namespace

Skill make_skill(const std::string& name, std::uint64_t seed) {
  Skill s;
  s.name = name;
  if (name == "expert" || name == "careless") return s;
  if (name == "perforator") {
    s.perforates = true;
    s.press_n = 1.2;
    s.careful_press_n = 0.9;  // presses on and plunges
    return s;
  }
  if (name == "novice") {
    Random random(seed);
    s.press_n = 0.95;
    s.careful_press_n = 0.7;
    s.reaction_s = 0.16;
    s.tremor_mm = 0.07;
    // leans towards one wall, by half a millimetre to three quarters
    const double side = random.uniform(0.5, 0.75);
    const bool across = random.below(2) == 0;
    const double sign = random.below(2) == 0 ? 1.0 : -1.0;
    s.offset_mm = across ? Vec3{0, sign * side, 0} : Vec3{sign * side, 0, 0};
    s.stops_short = random.uniform(0.05, 0.12);
    s.hand.stiffness_n_per_mm = 1.2;
    return s;
  }
  if (const int level = level_in(name); level >= 0) return student(level * 0.01, seed);
  throw Error(msg("operator '{}'", name), msg("is not known"),
              msg("use expert, novice, perforator, careless, or student-0 to student-100"));
}

Operator::Operator(Skill skill, std::vector<Waypoint> way, Vec3 approach, std::uint64_t seed)
    : skill_(std::move(skill)), way_(std::move(way)), approach_(approach), random_(seed) {
  double top = -1e9, bottom = 1e9;
  for (const auto& w : way_) {
    top = std::max(top, dot(w.tip_mm, approach_));
    bottom = std::min(bottom, dot(w.tip_mm, approach_));
  }
  for (auto& w : way_) {
    if (!w.cut) continue;
    w.tip_mm += approach_.z >= k_upright ? skill_.offset_mm
                                         : cavum::rotation(rotation()) * skill_.offset_mm;
    w.tip_mm += approach_ * std::max(0.0, bottom + skill_.stops_short * (top - bottom) -
                                              dot(w.tip_mm, approach_));
  }
  memory_.resize(static_cast<std::size_t>(skill_.reaction_s / k_tick_s) + 1);
  for (auto& m : memory_) m.proxy_mm = start_mm();
  from_mm_ = intended_mm_ = start_mm();
  way_.reserve(2 * way_.size() + 16);  // retreats add to it
}

Operator::Sight Operator::delayed(const TickOutput& seen, double dt_s) noexcept {
  const auto length_ticks = std::clamp<std::size_t>(
      static_cast<std::size_t>(skill_.reaction_s / dt_s), 1, memory_.size());
  memory_[now_] = {seen.proxy_mm, length(seen.rendered_force_n), seen.contact};
  now_ = (now_ + 1) % length_ticks;
  return memory_[now_];
}

bool Operator::retreat(Vec3 from_mm) noexcept {
  if (next_ + 1 >= way_.size() || way_.size() == way_.capacity()) return false;
  // held up: out of the cavity, and in again above the place after the next
  const Vec3 to = way_[next_ + 1].tip_mm;
  const std::uint8_t bur = way_[next_].bur;
  way_[next_] = {in_air(from_mm), true, false, bur};  // turning, so that a ledge gives way
  way_.insert(way_.begin() + static_cast<std::ptrdiff_t>(next_) + 1,
              {in_air(to), false, false, bur});
  from_mm_ = from_mm;
  best_mm_ = 1e9;
  stuck_s_ = 0;
  lead_mm_ = 0;
  return true;
}

double Operator::left_to_goal(Vec3 proxy_mm) const noexcept {
  const Waypoint& goal = way_[next_];
  const Vec3 rest = goal.tip_mm - proxy_mm;
  return goal.cut ? length(rest) : std::max(0.0, dot(rest, normalized(goal.tip_mm - from_mm_)));
}

void Operator::watch_progress(double left_mm, double dt_s) noexcept {
  stuck_s_ += dt_s;
  if (left_mm < best_mm_ - 0.01) {
    best_mm_ = left_mm;
    stuck_s_ = 0;
  }
}

bool Operator::bends_gently() const noexcept {
  if (next_ + 1 >= way_.size()) return false;
  const Vec3 goal = way_[next_].tip_mm;
  return dot(normalized(way_[next_ + 1].tip_mm - goal), normalized(goal - from_mm_)) >
         k_gentle_bend;
}

void Operator::go_on(bool through) noexcept {
  if (!through) lead_mm_ *= 0.5;  // into a corner the hand yields, along a gentle bend it goes on
  from_mm_ = way_[next_].tip_mm;
  ++next_;
  best_mm_ = 1e9;
  stuck_s_ = 0;
}

Operator::Aim Operator::aim_at(const Waypoint& goal, Vec3 proxy_mm) const noexcept {
  Aim aim{normalized(goal.tip_mm - proxy_mm), {}};
  const Vec3 line = normalized(goal.tip_mm - from_mm_);
  // Across the way the hand corrects more than it sees, or the friction of the joints would keep
  // the error.
  const Vec3 anchor = from_mm_ + line * std::clamp(dot(proxy_mm - from_mm_, line), 0.0,
                                                   length(goal.tip_mm - from_mm_));
  const Vec3 off = anchor - proxy_mm;
  aim.correction_mm = off * k_correction;
  // A groove cut before leads the bur astray: back to the way first, or the wall between them would
  // be left standing.
  if (const double astray = length(off); goal.cut && astray > k_astray_mm)
    aim.direction =
        normalized(aim.direction * (k_astray_mm / astray * (k_astray_mm / astray)) + off / astray);
  if (const double c = length(aim.correction_mm); c > k_max_correction_mm)
    aim.correction_mm = aim.correction_mm * (k_max_correction_mm / c);
  return aim;
}

void Operator::push(const Waypoint& goal, const Sight& felt, double slow_down,
                    double dt_s) noexcept {
  const double wanted_n =
      goal.cut ? (goal.careful ? skill_.careful_press_n : skill_.press_n) : 0.25;
  const double free_n =
      k_free_speed_mm_s * (goal.careful ? 0.4 : 1.0) * skill_.hand.damping_n_s_per_mm +
      k_friction_n;
  const double free_lead = free_n / skill_.hand.stiffness_n_per_mm;
  if (felt.contact && felt.force_n > k_felt_n) {
    const double error = std::clamp((wanted_n * slow_down - felt.force_n) / wanted_n, -1.0, 1.0);
    const double most_mm =
        free_lead +
        k_firmest * wanted_n * (1.0 / skill_.hand.stiffness_n_per_mm + 1.0 / k_hard_n_per_mm);
    lead_mm_ = std::clamp(lead_mm_ + k_lead_rate_mm_s * error * dt_s, 0.05, most_mm);
  } else {
    lead_mm_ = std::max(free_lead, lead_mm_ - 40.0 * dt_s);
    if (lead_mm_ < free_lead + 0.2) lead_mm_ = free_lead;
  }
}

void Operator::tremble(double dt_s) noexcept {
  constexpr double k_tremor_s = 0.05;
  const double kick = skill_.tremor_mm * std::sqrt(2 * dt_s / k_tremor_s);
  tremor_mm_ = tremor_mm_ * (1 - dt_s / k_tremor_s) +
               Vec3{random_.normal(), random_.normal(), random_.normal()} * kick;
}

void Operator::move_foot(bool cut, double dt_s) noexcept {
  const double pedal = cut ? 1.0 : 0.0;
  pedal_ += std::clamp(pedal - pedal_, -dt_s / 0.15, dt_s / 0.15);  // a foot takes 150 ms
}

Intent Operator::act(const TickOutput& seen, double dt_s) noexcept {
  const Sight felt = delayed(seen, dt_s);
  if (next_ >= way_.size())
    return {way_.empty() ? start_mm() : way_.back().tip_mm, 0.0,
            way_.empty() ? std::uint8_t{0} : way_.back().bur, true};
  // The eye sees the bur where it is now; a free way is judged along it, a cut by how near the bur
  // came.
  double left = left_to_goal(seen.proxy_mm);
  watch_progress(left, dt_s);
  const bool through = bends_gently(), cutting = way_[next_].cut;
  const double arrived_mm = !cutting ? 0.2 : through ? 0.06 : k_arrived_mm;
  if (stuck_s_ > k_give_up_s && cutting && retreat(seen.proxy_mm))
    return {intended_mm_, pedal_, way_[next_].bur, false};
  if (left < arrived_mm || stuck_s_ > k_give_up_s) {
    go_on(through);
    if (next_ >= way_.size()) return {from_mm_, 0.0, way_.back().bur, true};
    left = left_to_goal(seen.proxy_mm);
  }
  const Waypoint& goal = way_[next_];
  const Aim aim = aim_at(goal, seen.proxy_mm);
  push(goal, felt, through ? 1.0 : std::clamp(left / 0.25, 0.4, 1.0), dt_s);
  tremble(dt_s);
  move_foot(goal.cut, dt_s);
  towards_ += (aim.direction - towards_) *
              (dt_s / (k_turning_s + dt_s));  // where it goes to and fro it pushes less
  Vec3 tip = seen.proxy_mm + aim.correction_mm + towards_ * lead_mm_ + tremor_mm_;
  if (goal.cut && pedal_ < 0.95 && !felt.contact)
    tip = from_mm_ + tremor_mm_;  // wait for the handpiece
  // an intention has no corners: the hand follows it within some 25 ms
  intended_mm_ += (tip - intended_mm_) * (dt_s / (k_intention_s + dt_s));
  return {intended_mm_, pedal_, way_[next_].bur, false};
}

namespace {

/// Radius near the end as a share of the head's, 0..1: a ball has 0.66, a flat end 1.
double bluntness(const Bur& p) {
  return p.profile.radius_mm(0.25 * p.head_radius_mm) / p.head_radius_mm;
}

}  // namespace

ChosenBur choose_bur(const ZoneMap& zones, const Tooth& tooth,
                     const std::vector<ContactTool>& tray) {
  ChosenBur chosen;
  chosen.index = tray.size();
  double best_score = 0, best_bluntness = 0;
  const FreeRoom room = free_room(zones, tooth, k_expert_margin);
  for (std::size_t i = 0; i < tray.size(); ++i) {
    ReachMap map = reach_map(room, zones, tooth, tray[i]);
    chosen.covers.push_back(coverage(room, map, tray[i]));
    // a head shorter than the target is deep leaves ledges that hold up its neck
    const double depth = zones.top_level_mm() - zones.floor_level_mm();
    if (const double blunt = bluntness(tray[i].bur);
        chosen.covers.back() > 0 && blunt > best_bluntness * 1.01) {
      best_bluntness = blunt;
      chosen.blunt = i;
      chosen.blunt_map = map;
    }
    const double score =
        chosen.covers.back() * (tray[i].bur.cutting_length_mm >= depth ? 1.0 : 0.9);
    if (score > best_score * 1.01) {
      best_score = score;
      chosen.index = i;
      chosen.map = std::move(map);
    }
  }
  if (chosen.index < tray.size())
    chosen.map = without_skimming(room, std::move(chosen.map), tray[chosen.index]);
  return chosen;
}

std::vector<Waypoint> plan_work(const ChosenBur& chosen, const Tooth& tooth,
                                const std::vector<ContactTool>& tray,
                                const std::vector<std::string>& aims) {
  PlanOptions options;
  // from a side the floor is curved, as the surface is: wide loops would leave ridges
  if ((chosen.map.tool * Vec3{0, 0, 1}).z < k_upright)
    options.finish_spacing_mm = k_curved_spacing_mm;
  std::vector<Waypoint> cut = plan_cut(chosen.map, tooth, options);
  if (cut.empty()) return cut;
  for (auto& w : cut) w.bur = static_cast<std::uint8_t>(chosen.index);
  std::vector<Waypoint> way =
      plan_pilot(chosen.blunt_map, tooth, tray[chosen.blunt].bur.head_radius_mm, aims);
  for (auto& w : way) w.bur = static_cast<std::uint8_t>(chosen.blunt);
  way.insert(way.end(), cut.begin(), cut.end());
  return way;
}

namespace {

/// Where the careless candidate goes, with the bur that an expert would have chosen.
ReachMap careless_map(const Scenario& scenario, const ZoneMap& zones, const Tooth& tooth,
                      const ContactTool& bur) {
  const CarelessSpec& c = scenario.careless;
  const MarginSpec margin{k_expert_margin.sides_mm + c.sides_mm,
                          k_expert_margin.bottom_mm + c.bottom_mm};
  return middle_of(reach_map(zones, tooth, bur, margin), c.opening_percent);
}

}  // namespace

Candidate make_candidate(const std::string& skill_name, const Scenario& scenario,
                         const ZoneMap& zones, const Tooth& tooth,
                         const std::vector<ContactTool>& tray, std::uint64_t seed) {
  Skill skill = make_skill(skill_name, seed);
  const Message where = scenario.path.empty() ? msg("the scenario") : Message(Name{scenario.path});
  ChosenBur chosen = choose_bur(zones, tooth, tray);
  if (chosen.index == tray.size() && !zones.target_is_open())
    throw Error(where, msg("the target lies buried: no bur comes to it without cutting elsewhere"),
                msg("let it reach up to the tooth's surface"));
  if (chosen.index == tray.size())
    throw Error(where, msg("no allowed bur fits into the target"), msg("allow a thinner one"));
  if (skill.name == "careless") {
    if (scenario.careless.fails_by.empty())
      throw Error(where, msg("does not say what a careless candidate does"),
                  msg("add [careless] to it"));
    skill.perforates = scenario.careless.perforates;
    chosen.map = careless_map(scenario, zones, tooth, tray[chosen.index]);
  }
  auto way = plan_work(chosen, tooth, tray, scenario.perforation.aims);
  if (way.empty())
    throw Error(where, msg("the careless candidate finds nothing to cut"),
                msg("let [careless] leave more of the target"));
  bool finds_a_way = false;
  if (skill.perforates)
    for (const auto& fault : scenario.perforation.faults) {
      bool present = false;
      for (const auto& t : tooth.tissues) present = present || t.name == fault;
      if (!present) continue;
      auto deeper = plan_perforation(zones, tooth, chosen.map, tooth.tissue_id(fault));
      if (deeper.empty()) continue;
      for (auto& w : deeper) w.bur = static_cast<std::uint8_t>(chosen.index);
      way.insert(way.end(), deeper.begin(), deeper.end());
      finds_a_way = true;
      break;
    }
  if (skill.perforates && !finds_a_way &&
      (skill.name == "perforator" ||
       skill.name == "careless"))  // a student who would have is lucky
    throw Error(
        where, msg("the {} finds no way through to what must not be opened", skill.name),
        msg("see that tooth and perforation.faults have such a tissue, allow a longer or thinner bur, or take another candidate"));
  return {Operator(skill, std::move(way), zones.approach(), seed),
          static_cast<std::uint8_t>(chosen.index)};
}

}  // namespace cavum::scenarios
