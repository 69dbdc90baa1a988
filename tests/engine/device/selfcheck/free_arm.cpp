#include "tests/engine/device/selfcheck/free_arm.h"

#include <algorithm>
#include <cmath>

namespace cavum::testing_selfcheck {
namespace {

double part(Vec3 v, std::size_t i) { return i == 0 ? v.x : i == 1 ? v.y : v.z; }
void set_part(Vec3& v, std::size_t i, double value) { (i == 0 ? v.x : i == 1 ? v.y : v.z) = value; }
double rounded(double value, double quantum) {
  return quantum > 0 ? std::round(value / quantum) * quantum : value;
}

}  // namespace

FreeArm::FreeArm(const ArmModel& model, Vec3 at_mm, std::uint64_t seed)
    : model_(model), random_(seed), home_(at_mm) {
  facts_ = {.id = "freearm",
            .name = cavum::Name{"an arm that nobody holds"},
            .serial = "A1",
            .position_quantum_mm = model.quantum_mm,
            .peak_n = 3.0,
            .continuous_n = 1.0,
            .rate_hz = model.rate_hz,
            .reach_mm = 60.0,
            .measures_direction = false};
  const double a = model.skew_rad, b = 0.6 * model.skew_rad;
  joints_[0] = normalized(Vec3{std::cos(a), std::sin(a), std::sin(b)});
  joints_[1] = normalized(cross({0, 0, 1}, joints_[0]));
  joints_[2] = cross(joints_[0], joints_[1]);
  at_ = play_ = to_joints(at_mm);
  told_mm_ = at_mm;
}

Vec3 FreeArm::to_joints(Vec3 v) const {
  return {dot(v, joints_[0]), dot(v, joints_[1]), dot(v, joints_[2])};
}
Vec3 FreeArm::to_axes(Vec3 v) const {
  return joints_[0] * v.x + joints_[1] * v.y + joints_[2] * v.z;
}

void FreeArm::exchange() {
  for (std::size_t i = 0; i + 1 < queue_.size(); ++i) queue_[i] = queue_[i + 1];
  queue_[static_cast<std::size_t>(model_.delay)] = commanded_n_;
  const double half = 0.5 * model_.backlash_mm;
  for (std::size_t i = 0; i < 3; ++i)
    set_part(play_, i, std::clamp(part(play_, i), part(at_, i) - half, part(at_, i) + half));
  if (model_.joint_encoders) {
    told_mm_ = to_axes({rounded(play_.x, model_.quantum_mm), rounded(play_.y, model_.quantum_mm),
                        rounded(play_.z, model_.quantum_mm)});
  } else {
    const Vec3 p = to_axes(play_);
    told_mm_ = {rounded(p.x, model_.quantum_mm), rounded(p.y, model_.quantum_mm),
                rounded(p.z, model_.quantum_mm)};
  }
  ++readings_;
  std::uniform_real_distribution<double> u(-1.0, 1.0);
  next_exchange_s_ += (1.0 + model_.jitter * u(random_)) / model_.rate_hz;
}

void FreeArm::move(double dt) {
  const Vec3 motor = queue_[0] * model_.gain;
  const Vec3 off = to_axes(at_) - home_;
  Vec3 push = motor - model_.weight_n - off * model_.spring_n_per_mm;
  const double wobble = hand_.tremor_mm * std::sin(2.0 * M_PI * hand_.tremor_hz * time_s_);
  push += (Vec3{wobble, 0.7 * wobble, 0.4 * wobble} - off) * hand_.stiffness_n_per_mm;
  Vec3 along = to_joints(push);
  const double speed = length(speed_);
  for (std::size_t i = 0; i < 3; ++i) {
    const double v = part(speed_, i), m = model_.mass_kg[i] + hand_.mass_kg;
    const double ripple = model_.ripple_n * std::sin(2.0 * M_PI * part(at_, i) / model_.ripple_mm +
                                                     static_cast<double>(i));
    const double damping = model_.viscous_n_s_per_mm + hand_.damping_n_s_per_mm;
    const double fast = model_.one_friction ? speed : std::abs(v);
    const double slowness = fast / model_.stribeck_mm_s;
    double friction =
        model_.coulomb_n[i] * (slowness < 12.0 ? 1.0 + model_.stribeck * std::exp(-slowness) : 1.0);
    if (model_.one_friction)
      friction *= speed > 1e-9 ? std::max(1e-3, std::abs(v) / speed)
                               : std::abs(part(along, i)) / std::max(1e-12, length(along));
    const double per_mass = 1000.0 / m * dt;
    double next = (v + (part(along, i) - ripple) * per_mass) / (1.0 + damping * per_mass);
    const double lost = friction * per_mass;
    next = std::abs(next) > lost ? next - std::copysign(lost, next) : 0.0;
    set_part(speed_, i, next);
    set_part(at_, i, part(at_, i) + next * dt);
  }
  if (const Vec3 p = to_axes(at_); p.x > wall_mm_) {
    at_ = to_joints({wall_mm_, p.y, p.z});
    const Vec3 v = to_axes(speed_);
    speed_ = to_joints({std::min(0.0, v.x), v.y, v.z});
  }
}

DeviceReading FreeArm::read(double elapsed_s) {
  constexpr double k_step_s = 2.5e-4;
  const double until = time_s_ + elapsed_s;
  largest_n_ = std::max(largest_n_, length(commanded_n_));
  while (time_s_ < until) {
    if (time_s_ >= next_exchange_s_) exchange();
    const double dt = std::min(k_step_s, until - time_s_);
    move(dt);
    time_s_ += dt;
  }
  return {.pose = {told_mm_, {}},
          .flags = static_cast<std::uint16_t>(silent_ ? 0 : k_stylus_fresh)};
}

StylusHealth FreeArm::health() const {
  StylusHealth h;
  h.readings = readings_;
  h.mean_period_s = 1.0 / model_.rate_hz;
  h.jitter_s = model_.jitter / model_.rate_hz / std::sqrt(3.0);
  return h;
}

}  // namespace cavum::testing_selfcheck
