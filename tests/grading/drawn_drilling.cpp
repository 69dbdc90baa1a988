#include "tests/grading/drawn_drilling.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <sstream>

#include "engine/base/random.h"
#include "engine/device/simulated_omni.h"
#include "engine/tooth/make/make_block.h"
#include "tests/engine/support/engine_testing.h"

namespace cavum::testing_grading {
namespace {

using namespace testing_engine;

constexpr double k_dt = k_tick_s;
constexpr double k_feels_s = 0.03;         // time constant of what a hand feels
constexpr std::int64_t k_longest = 60000;  // ticks
constexpr double k_through_mm =
    1.8;  // so far beyond the cavity's roof the hand stops, whatever it has felt
constexpr double k_seen_mm =
    4.0;  // a hand lets itself be drawn no further from the bur that it sees on the screen

const Tooth& tooth_named(const std::string& name) {
  static const auto load = [](const char* file) {
    return load_tooth_file(std::string(CAVUM_SOURCE_DIR) + "/data/teeth/" + file);
  };
  static const Tooth molar = load("lower_molar.cvt"), premolar = load("upper_premolar.cvt"),
                     incisor = load("upper_incisor.cvt");
  static const Tooth block = make_block(
      {6, 6, 6}, {{"enamel", 1.0}, {"dentin", 1.6}, {"pulp", 1.2}, {"dentin", 2.2}}, 0.05);
  static const Tooth floor =
      make_block({6, 6, 5}, {{"dentin", 2.3}, {"periodontium", 1.0}, {"dentin", 1.7}}, 0.05);
  static const auto with_lesion = [](double roof_mm) {  // sound dentin between lesion and pulp
    return make_block({6, 6, 5.0 + roof_mm},
                      {{"enamel", 0.8},
                       {"dentin", 0.6},
                       {"lesion", 0.8},
                       {"dentin", roof_mm},
                       {"pulp", 1.0},
                       {"dentin", 1.8}},
                      0.05);
  };
  static const Tooth lesion = with_lesion(1.4), deep_lesion = with_lesion(0.65);
  if (name == "molar") return molar;
  if (name == "premolar") return premolar;
  if (name == "incisor") return incisor;
  if (name == "floor") return floor;
  if (name == "deep lesion") return deep_lesion;
  return name == "lesion" ? lesion : block;
}

bool is_void(const Octree& o, std::uint8_t t) { return t != k_air && !o.is_solid(t); }

/// A straight way in: from the surface at `top` along `into`.
struct Way {
  Vec3 top, into;
  double void_at_mm = 0;  // depth at which the axis meets void tissue
  double safe_mm = 0;     // depth that the head can reach with 0.3 mm to spare
};

class Session {
 public:
  Session(std::uint64_t seed, Drawn drawn, DrawnSession& out)
      : shifted_(drawn == Drawn::shifted), random_(seed), out_(out) {
    draw();
  }
  void run();

 private:
  double u(double a, double b) { return random_.uniform(a, b); }
  /// One of the ends of the range in a shifted session.
  double range(double a, double b) { return !shifted_ ? u(a, b) : random_.below(2) == 0 ? a : b; }
  void draw();
  bool find_way();
  [[nodiscard]] double safe_depth(const Way& w, double radius) const;
  void tick(Vec3 intended, double pedal);
  void expect(std::int64_t now);
  void travel(Vec3 to, double mm_s, double pedal);
  void wait(double s, double pedal);
  /// Presses on along `into` until `stop`, or `most_s` have gone.
  bool drill(Vec3 from, Vec3 into, double most_s, const std::function<bool()>& stop);
  [[nodiscard]] double depth() const { return dot(proxy() - way_.top, way_.into); }
  [[nodiscard]] Vec3 proxy() const { return state_.contact.proxy_mm; }
  [[nodiscard]] Vec3 tip() const { return omni_state_.position_mm; }
  [[nodiscard]] bool over() const {
    return static_cast<std::int64_t>(out_.inputs.size()) >= k_longest;
  }
  void retreat(double mm, double mm_s, double pedal) {
    travel(tip() - way_.into * mm, mm_s, pedal);
  }
  void look_alike();
  void back_to_work(double mm_s);
  void earlier_cut();
  void slip();

  bool shifted_;
  Random random_;
  DrawnSession& out_;
  const Tooth* tooth_ = nullptr;
  ServoModel model_;
  ServoState state_;
  TickInput input_;
  TickOutput last_;
  OmniModel omni_;
  HandModel hand_;
  OmniState omni_state_;
  Vec3 intended_, tremor_;
  Way way_;
  Quat turned_;
  bool constant_force_ = false;
  double force_n_ = 0.8, feed_mm_s_ = 0.3, tremor_mm_ = 0.01, noise_n_ = 0, reaction_s_ = 0.2,
         pedal_ = 1;
  std::uint8_t bur_ = 0;
  bool perforates_ = false;
  double felt_n_ = 0;      // the force, as a hand feels it
  double level_n_ = 0;     // the same before the cavity was touched, over half a second
  double deepest_mm_ = 0;  // along the way
  bool going_through_ = false;
  std::int64_t let_go_ = -1;  // tick in which the hand noticed that nothing resists any more
  Material dentin_;
  double expected_n_ = 0, pushing_n_ = 0;  // see expect()
  double expected_felt_n_ = 0;             // as a hand would feel it
  std::int64_t held_at_ = 0;               // last tick with nearly all of the force
  bool pressing_ = false;                  // the hand means to drill on
  Vec3 last_tip_mm_;
};

void Session::draw() {
  out_.what = static_cast<LookAlike>(random_.below(k_look_alikes));
  perforates_ = random_.below(2) == 0;
  static const std::array<const char*, 5> teeth{"molar", "premolar", "incisor", "block", "floor"};
  out_.tooth = out_.what == LookAlike::soft_lesion
                   ? (random_.below(2) == 0 ? "lesion" : "deep lesion")
                   : teeth[random_.below(teeth.size())];
  if (out_.what == LookAlike::enamel_to_dentin && out_.tooth == "floor") out_.tooth = "block";
  if (out_.what == LookAlike::slip)
    out_.tooth = teeth[random_.below(3)];  // the layers of a block lie open at its sides
  tooth_ = &tooth_named(out_.tooth);
  ForceModel force = shipped_model((random_.below(3) == 0) != shifted_ ? "paper" : "consistent");
  auto& enamel = force.materials.find("enamel")->second;
  auto& dentin = force.materials.find("dentin")->second;
  auto& lesion = force.materials.find("lesion")->second;
  const double damping =
      enamel.voigt.damping_n_s_per_mm / std::sqrt(enamel.voigt.stiffness_n_per_mm);
  const double k = u(0.5, 1.2),
               share = out_.what == LookAlike::enamel_to_dentin ? u(0.4, 0.65) : u(0.65, 1.0),
               soft = shifted_ ? u(0.2, 0.3) : u(0.2, 0.45);
  enamel.voigt = {k, damping * std::sqrt(k)};
  dentin.voigt = {k * share, damping * std::sqrt(k * share)};
  lesion.voigt = {k * share * soft, damping * std::sqrt(k * share * soft)};
  enamel.tau_s = u(1.6, 2.4);
  dentin.tau_s = enamel.tau_s * u(0.8, 1.0);
  lesion.tau_s = dentin.tau_s * u(0.4, 0.8);

  dentin_ = dentin;
  constant_force_ = random_.below(2) == 0;
  force_n_ = k * share * (shifted_ ? u(0.3, 1.7) : u(0.4, 1.4));
  feed_mm_s_ = shifted_ ? u(0.12, 0.9) : u(0.15, 0.7);
  tremor_mm_ = range(0.0, 0.04);
  noise_n_ = range(0.0, 0.05);
  reaction_s_ = u(0.12, 0.35);
  pedal_ = u(0.7, 1.0);
  omni_.coulomb_n = range(0.0, 0.7);
  omni_.delay_ticks = static_cast<int>(random_.below(2));
  hand_.stiffness_n_per_mm = shifted_ ? u(0.25, 3.0) : u(0.3, 2.0);
  hand_.damping_n_s_per_mm = u(0.02, 0.1);

  bool found = false;
  const auto names = bur_names();
  for (int i = 0; i < 2000 && !found; ++i) {
    if (i % 20 == 0) {
      const std::size_t first = random_.below(names.size());
      out_.bur = names[first];
      out_.tray = {
          shipped_bur(names[first]),
          shipped_bur(names[(first + 1 + random_.below(names.size() - 1)) % names.size()])};
    }
    found = find_way();
  }
  if (!found) throw std::runtime_error("no way into tooth " + out_.tooth);
  std::ostringstream story;
  story << name_of(out_.what) << ", " << out_.tooth << ", " << out_.bur << ", "
        << (perforates_ ? "perforates" : "stops") << ", " << (constant_force_ ? "force " : "feed ")
        << (constant_force_ ? force_n_ : feed_mm_s_) << ", k " << k << " share " << share
        << " soft " << soft << ", c " << damping << ", noise " << noise_n_ << ", friction "
        << omni_.coulomb_n << ", tremor " << tremor_mm_ << ", hand " << hand_.stiffness_n_per_mm
        << ", void at " << way_.void_at_mm;
  out_.story = story.str();
  turned_ = rotation_between({0, 0, 1}, -way_.into);
  ServoConfig config;
  config.position_quantum_mm = omni_.quantum_mm;
  model_ = make_servo_model(*tooth_, out_.tray, force, config);
  intended_ = way_.top - way_.into * 1.0;
  state_ = make_servo_state(model_, *tooth_, intended_);
  omni_state_ = make_omni_state(intended_);
}

double Session::safe_depth(const Way& w, double radius) const {
  const Octree& o = tooth_->octree;
  Vec3 a = normalized(cross(w.into, Vec3{0.3, 0.7, 0.2})), b = cross(w.into, a);
  for (double d = 0; d < w.void_at_mm; d += 0.1)
    for (int i = 0; i < 16; ++i) {
      const double angle = i * 0.3927, r = radius + 0.3;
      const Vec3 at =
          w.top + w.into * (d + 0.3) + a * (r * std::cos(angle)) + b * (r * std::sin(angle));
      if (is_void(o, o.tissue_at(at))) return d;
    }
  return std::max(0.0, w.void_at_mm - 0.4);
}

bool Session::find_way() {
  const Octree& o = tooth_->octree;
  Way w;
  const double tilt = u(0.0, shifted_ ? 0.6 : 0.4), around = u(0, 6.2832);
  w.into = normalized(Vec3{tilt * std::cos(around), tilt * std::sin(around), -1.0});
  const bool is_block = out_.tooth == "block" || out_.tooth == "floor" || out_.tooth == "lesion" ||
                        out_.tooth == "deep lesion";
  // the spot: somewhere over the chamber, or on the block's top
  Vec3 at =
      is_block ? Vec3{u(-1.2, 1.2), u(-1.2, 1.2), 3.0} : Vec3{u(-1.6, 1.6), u(-1.6, 1.6), 8.0};
  int i = 0;
  while (!o.is_solid(o.tissue_at(at)) && i++ < 1500) at += w.into * 0.01;
  if (i >= 1500) return false;
  w.top = at;
  while (o.is_solid(o.tissue_at(at)) && w.void_at_mm < 8) {
    at += w.into * 0.01;
    w.void_at_mm += 0.01;
  }
  if (!is_void(o, o.tissue_at(at)) || w.void_at_mm < 1.3 || w.void_at_mm > 6) return false;
  for (int k = 0; k < 30; ++k)  // a real cavity, not its edge
    if (!is_void(o, o.tissue_at(at + w.into * (0.01 * k)))) return false;
  w.safe_mm = safe_depth(w, std::max(out_.tray[0].head_radius_mm, out_.tray[1].head_radius_mm));
  if (!perforates_ && w.safe_mm < 0.9) return false;
  for (const auto& bur : out_.tray) {  // neck and shank must find room in the hole
    double room = 100;
    for (const auto& p : bur.profile.walk(0.05, bur.profile.length_mm()))
      if (p.at.z_mm > bur.cutting_length_mm && p.at.r_mm > bur.head_radius_mm - 0.02)
        room = std::min(room, p.at.z_mm);
    if (w.void_at_mm + 0.6 > room) return false;
  }
  way_ = w;
  return true;
}

void Session::tick(Vec3 intended, double pedal) {
  if (over()) return;
  intended_ = intended;
  // tremor: a slow wander, below 5 Hz
  const double keep = 1 - 2 * 3.14159 * 3 * k_dt, kick = tremor_mm_ * std::sqrt(1 - keep * keep);
  tremor_ = tremor_ * keep + Vec3{random_.normal(), random_.normal(), random_.normal()} * kick;
  const Vec3 tip =
      advance_omni(omni_, hand_, omni_state_, last_.rendered_force_n, intended + tremor_, k_dt);
  input_ = make_tick_input({tip, turned_}, pedal, k_stylus_fresh | k_pedal_fresh, bur_, input_);
  last_ = step(model_, state_, input_);
  TickRecord r = make_tick_record(last_);
  for (auto& f : r.rendered_un) f += static_cast<std::int32_t>(noise_n_ * 1e6 * random_.normal());
  const auto now = static_cast<std::int64_t>(out_.inputs.size());
  for (const auto& leaf : state_.removed)
    if (is_void(tooth_->octree, leaf.tissue)) {
      // the cavity that the way leads to; periodontium beside the root is grazed from outside
      const Vec3 off =
          tooth_->octree.centre_mm(leaf.leaf()) - (way_.top + way_.into * way_.void_at_mm);
      const double along = dot(off, way_.into);
      if (along > -0.8 && length(off - way_.into * along) < 1.0) {
        if (out_.touched < 0) out_.touched = now;
      } else {
        out_.grazed_elsewhere = out_.touched < 0;
      }
    }
  felt_n_ += (length(last_.rendered_force_n) - felt_n_) * (k_dt / k_feels_s);
  if (out_.touched < 0) level_n_ += (felt_n_ - level_n_) * (k_dt / 0.5);
  if (going_through_ && out_.touched >= 0 && let_go_ < 0 && felt_n_ < 0.1 * level_n_) let_go_ = now;
  expect(now);
  deepest_mm_ = std::max(deepest_mm_, depth());
  out_.inputs.push_back(input_);
  out_.records.push_back(r);
}

/// What solid dentin would give at the same motion of the tip, and whether the hand can feel that
/// the tooth gives less. The tip presses in by its advance, the surface recedes at X / tau, and the
/// level before the touch is the most that it can be. Only a force at the bottom of the hole tells
/// of the bottom: a blow against the wall or the rim on the way there does not. Force and
/// expectation are compared as a hand feels them, both smoothed.
void Session::expect(std::int64_t now) {
  const Vec3 at{input_.tip_nm[0] * 1e-6, input_.tip_nm[1] * 1e-6, input_.tip_nm[2] * 1e-6};
  const double k = dentin_.voigt.stiffness_n_per_mm;
  if (now > 0)
    expected_n_ +=
        k * dot(at - last_tip_mm_, way_.into) - std::max(0.0, expected_n_) * k_dt / dentin_.tau_s;
  last_tip_mm_ = at;
  expected_n_ = std::min(expected_n_, level_n_);
  pushing_n_ += (-dot(last_.rendered_force_n, way_.into) - pushing_n_) * (k_dt / k_feels_s);
  const bool at_bottom = depth() >= deepest_mm_ - k_felt_near_mm;
  if (at_bottom && pushing_n_ > k_felt_share * k_felt_least_n)
    expected_n_ = std::max(expected_n_, std::min(pushing_n_, level_n_));
  if (at_bottom && felt_n_ >= 0.8 * level_n_) held_at_ = now;
  expected_felt_n_ += (std::max(0.0, expected_n_) - expected_felt_n_) * (k_dt / k_feels_s);
  if (out_.touched < 0 || !pressing_ || now - held_at_ > k_felt_within_ticks || !at_bottom) return;
  if (std::min(expected_n_, expected_felt_n_) < std::max(k_felt_least_n, 0.5 * level_n_)) return;
  out_.least_share = std::min(out_.least_share, felt_n_ / expected_felt_n_);
  if (out_.felt < 0 && felt_n_ < k_felt_share * expected_felt_n_) out_.felt = now;
}

void Session::travel(Vec3 to, double mm_s, double pedal) {
  const Vec3 from = intended_;
  const int n = std::max(1, static_cast<int>(length(to - from) / (mm_s * k_dt)));
  for (int i = 1; i <= n; ++i) tick(from + (to - from) * (static_cast<double>(i) / n), pedal);
}

void Session::wait(double s, double pedal) {
  for (double t = 0; t < s; t += k_dt) tick(intended_, pedal);
}

bool Session::drill(Vec3 from, Vec3 into, double most_s, const std::function<bool()>& stop) {
  double along = dot(tip() - from, into);
  for (double t = 0; t < most_s && !over(); t += k_dt) {
    if (constant_force_) {
      along = dot(tip() - from, into) + force_n_ / hand_.stiffness_n_per_mm;
      along = std::min(along,
                       dot(proxy() - from, into) + k_seen_mm + force_n_ / hand_.stiffness_n_per_mm);
    } else {
      along += feed_mm_s_ * k_dt;
      along = std::min(along, dot(tip() - from, into) + 3.0 / hand_.stiffness_n_per_mm);
    }
    pressing_ = true;
    tick(from + into * along, pedal_);
    pressing_ = false;
    if (stop()) return true;
  }
  return false;
}

void Session::back_to_work(double mm_s) {
  // down the axis until it touches
  for (int i = 0; i < 8000 && !over() && !(last_.contact && depth() > deepest_mm_ - 0.15) &&
                  depth() < deepest_mm_ + 0.1;
       ++i)
    tick(intended_ + way_.into * (mm_s * k_dt), pedal_);
}

void Session::look_alike() {
  switch (out_.what) {
    case LookAlike::lift_off:
      for (int i = 0; i < 3; ++i) {
        retreat(u(0.4, 2.5), u(5, 60), pedal_);
        wait(u(0.1, 0.5), pedal_);
        back_to_work(u(1, 8));
        (void)drill(way_.top, way_.into, u(0.5, 1.0), [&] { return depth() > way_.safe_mm - 0.3; });
      }
      break;
    case LookAlike::pedal_release:
      for (int i = 0; i < 2; ++i) {
        wait(u(0.5, 1.5), 0.0);
        (void)drill(way_.top, way_.into, u(0.5, 1.2), [&] { return depth() > way_.safe_mm - 0.3; });
      }
      break;
    case LookAlike::change_of_bur:
      retreat(u(2, 5), u(5, 30), pedal_);
      wait(0.5, 0.0);
      bur_ = 1;
      wait(0.5, 0.0);
      wait(0.6, pedal_);
      back_to_work(u(1, 8));
      break;
    case LookAlike::saturation: {
      const double usual = force_n_;
      const bool style = constant_force_;
      constant_force_ = true;
      force_n_ = u(3.2, 3.7);
      (void)drill(way_.top, way_.into, u(0.3, 0.8), [&] { return depth() > way_.safe_mm - 0.3; });
      force_n_ = usual;
      constant_force_ = style;
      (void)drill(way_.top, way_.into, u(0.5, 1.0), [&] { return depth() > way_.safe_mm - 0.3; });
      break;
    }
    case LookAlike::look:
      for (int i = 0; i < 2; ++i) {
        retreat(u(3, 7), u(1, 6), pedal_);
        wait(u(0.4, 1.0), pedal_);
        back_to_work(u(2, 10));
        (void)drill(way_.top, way_.into, u(0.5, 1.0), [&] { return depth() > way_.safe_mm - 0.3; });
      }
      break;
    default:
      break;
  }
}

/// A hole beside the way, then from the way's side into it.
void Session::earlier_cut() {
  const double r = out_.tray[0].head_radius_mm, down = std::min(0.9, way_.safe_mm - 0.4);
  const Vec3 side = normalized(cross(way_.into, Vec3{0.2, 0.9, 0.1}));
  const Vec3 first = way_.top;
  (void)drill(first, way_.into, 8, [&] { return depth() > down; });
  retreat(down + 1.0, 10, pedal_);
  // second start beside it, slanting towards the first hole's bottom
  const double apart = 2 * r + u(0.15, 0.5);
  const Vec3 start = first + side * apart - way_.into * 1.0, aim = first + way_.into * (down - 0.1);
  const Vec3 into = normalized(aim - (first + side * apart));
  travel(start, 10, pedal_);
  for (int i = 0; i < 6000 && !over() && !last_.contact; ++i)
    tick(intended_ + way_.into * (3 * k_dt), pedal_);
  const Vec3 from = tip();
  (void)drill(from, into, 7,
              [&] { return depth() > way_.safe_mm - 0.3 || dot(proxy() - aim, into) > 0.4; });
  retreat(2.5, 20, pedal_);
  travel(first - way_.into * 1.0, 10, pedal_);
}

/// Pushes outwards over the surface until the bur falls off it.
void Session::slip() {
  const double angle = u(0, 6.2832);
  const Vec3 side = normalized(Vec3{std::cos(angle), std::sin(angle), 0});
  const double speed = u(1.5, 5.0), press = u(0.3, 1.0) / hand_.stiffness_n_per_mm;
  Vec3 at = tip();
  int off = 0;
  const double high = at.z;
  const double lead_mm = 0.5 / hand_.stiffness_n_per_mm;
  for (int i = 0; i < 6000 && !over() && off < 60 && tip().z > high - 3.0; ++i) {
    at += side * (speed * k_dt);
    const Vec3 lead{at.x - tip().x, at.y - tip().y, 0};
    if (length(lead) > lead_mm)
      at = at - lead * (1 - lead_mm / length(lead));  // a hand that is held back waits
    tick({at.x, at.y, tip().z - press}, pedal_);
    off = last_.contact ? 0 : off + 1;
  }
  travel(tip() + Vec3{0, 0, 4}, 20, pedal_);
  travel(way_.top - way_.into * 2.0, 10, pedal_);
}

void Session::run() {
  wait(u(0.6, 1.0), pedal_);
  back_to_work(u(1, 8));
  if (out_.what == LookAlike::slip) {
    slip();
    back_to_work(u(1, 8));
  }
  if (out_.what == LookAlike::earlier_cut) {
    earlier_cut();
    back_to_work(u(1, 8));
  }
  const double half_way = std::min(0.55 * way_.void_at_mm, way_.safe_mm - 0.4);
  (void)drill(way_.top, way_.into, 15, [&] { return depth() > half_way; });
  look_alike();
  if (perforates_) {
    // on until the loss of resistance has been felt
    going_through_ = true;
    (void)drill(way_.top, way_.into, 25, [&] {
      if (depth() > way_.void_at_mm + k_through_mm) return true;
      return let_go_ >= 0 &&
             static_cast<double>(static_cast<std::int64_t>(out_.inputs.size()) - let_go_) * k_dt >
                 reaction_s_;
    });
  } else {
    (void)drill(way_.top, way_.into, 25, [&] { return depth() > way_.safe_mm - 0.3; });
  }
  going_through_ = false;
  retreat(u(2, 5), u(3, 40), pedal_);
  wait(0.3, 0.0);
}

}  // namespace

const char* name_of(LookAlike what) {
  static const std::array<const char*, k_look_alikes> names{
      "steady",      "lift-off",    "pedal release", "enamel to dentin",
      "earlier cut", "soft lesion", "change of bur", "saturation",
      "slip",        "look"};
  return names[static_cast<std::size_t>(what)];
}

DrawnSession draw_session(std::uint64_t seed, Drawn drawn) {
  DrawnSession session;
  Session(seed, drawn, session).run();
  return session;
}

}  // namespace cavum::testing_grading
