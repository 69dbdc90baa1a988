#include "ui/station/spray.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <numbers>

namespace cavum::station {
namespace {

constexpr float k_whole_turn = 2.0F * std::numbers::pi_v<float>;

/// Evenly from 0 to 1, the same for the same number.
float share_of_drop(std::uint32_t n) {
  n ^= n >> 16U;
  n *= 0x7feb352dU;
  n ^= n >> 15U;
  n *= 0x846ca68bU;
  n ^= n >> 16U;
  return static_cast<float>(n >> 8U) / 16777216.0F;
}

/// One drop's flight: how far it is on its way, 0..1, and numbers of its own that change from one
/// flight to the next.
struct Flight {
  float done;
  std::array<float, 3> own;
};
Flight flight_of(int number, double time_s, double lasts_s) {
  const auto n = static_cast<std::uint32_t>(number);
  const double t = time_s / lasts_s + static_cast<double>(share_of_drop(n * 7U + 1U));
  const double which = std::floor(t);
  const std::uint32_t base =
      (n * 2654435761U) ^ (static_cast<std::uint32_t>(static_cast<std::int64_t>(which)) * 40503U);
  return {static_cast<float>(t - which),
          {share_of_drop(base + 1U), share_of_drop(base + 2U), share_of_drop(base + 3U)}};
}

glm::vec3 around(float turn, float radius_mm, float z_mm) {
  return {radius_mm * std::cos(k_whole_turn * turn), radius_mm * std::sin(k_whole_turn * turn),
          z_mm};
}

GpuDrop drop_at(const glm::vec3& at_mm, float size_mm, const glm::vec3& colour, float opacity) {
  const auto byte = [](float v) {
    return static_cast<std::uint8_t>(std::lround(255.0F * glm::clamp(v, 0.0F, 1.0F)));
  };
  return {{at_mm.x, at_mm.y, at_mm.z},
          size_mm,
          {byte(colour.r), byte(colour.g), byte(colour.b), byte(opacity)}};
}

constexpr glm::vec3 k_water(0.64F, 0.77F, 0.88F);  // seen before a white tooth and before the dark

/// From one of three mouths to the lower end of the head.
GpuDrop jet_drop(const Spray& s, int i, float head_mm) {
  constexpr double k_lasts_s = 0.12;
  constexpr float k_mouth_mm = 2.9F, k_wander_mm = 0.7F;
  const Flight f = flight_of(i, s.time_s, k_lasts_s);
  const float turn = static_cast<float>(i % 3) / 3.0F + 0.08F;
  const glm::vec3 from = around(turn, k_mouth_mm, k_jets_from_mm), to = around(turn, head_mm, 0.6F);
  const glm::vec3 aside = around(f.own[0], k_wander_mm * f.own[1] * f.done, 0.0F);
  return drop_at(from + (to - from) * f.done + aside, 0.10F + 0.22F * f.own[2], k_water,
                 0.40F * s.water);
}

/// Thrown back from the tooth, thinner the farther it is.
GpuDrop mist_drop(const Spray& s, int i, float head_mm) {
  constexpr double k_lasts_s = 0.55;
  const Flight f = flight_of(i, s.time_s, k_lasts_s);
  const float away_mm =
      head_mm + 0.3F + (k_spray_reach_mm - 1.5F - head_mm) * f.done * (0.4F + 0.6F * f.own[1]);
  return drop_at(around(f.own[0], away_mm, 0.4F + 2.6F * f.done * f.own[2]), 0.7F + 1.6F * f.done,
                 k_water, 0.22F * s.water * (1.0F - f.done));
}

/// Off the turning head, up, outwards and down again.
GpuDrop chip(const Spray& s, int i, float head_mm) {
  constexpr double k_lasts_s = 0.28;
  const Flight f = flight_of(i, s.time_s, k_lasts_s);
  const float out_mm = 3.4F * f.done * (0.35F + 0.65F * f.own[1]),
              up_mm = (3.0F * f.done - 2.4F * f.done * f.done) * (0.3F + 0.7F * f.own[2]);
  const glm::vec3 start = around(f.own[0], head_mm, 0.15F + 0.7F * f.own[1]),
                  along = around(f.own[0] + 0.25F, 1.6F * f.done, 0.0F);
  return drop_at(start + around(f.own[0], out_mm, up_mm) + along, 0.09F + 0.10F * f.own[2],
                 s.chip_colour, 0.9F * s.chips * std::min(1.0F, 3.0F * (1.0F - f.done)));
}

}  // namespace

void spray_on(Spray& s, double rpm, bool cutting, double enamel_share, double dentin_share,
              double frame_s) {
  constexpr double k_standing_rpm = 1000.0, k_come_and_go_s = 0.2;
  const auto step = static_cast<float>(std::clamp(frame_s / k_come_and_go_s, 0.0, 1.0));
  const auto towards = [step](float& share, bool on) {
    share = std::clamp(share + (on ? step : -step), 0.0F, 1.0F);
  };
  towards(s.water, rpm > k_standing_rpm);
  towards(s.chips, cutting && rpm > k_standing_rpm);
  if (cutting) {
    const auto e = static_cast<float>(enamel_share), d = static_cast<float>(dentin_share),
               rest = std::max(0.0F, 1.0F - e - d);
    s.chip_colour = e * glm::vec3(0.86F, 0.87F, 0.85F) + d * glm::vec3(0.84F, 0.72F, 0.48F) +
                    rest * glm::vec3(0.70F, 0.25F, 0.22F);
  }
  if (s.water > 0 || s.chips > 0) s.time_s += std::max(0.0, frame_s);
}

std::vector<GpuDrop> drops_of(const Spray& s, double head_radius_mm, int count) {
  std::vector<GpuDrop> drops;
  const auto head_mm = static_cast<float>(head_radius_mm);
  // of eight drops four are of the jets, one is mist, three are chips
  constexpr int k_share = 8, k_jets = 4, k_mist = 5;
  for (int i = 0; i < count; ++i) {
    const int kind = i % k_share;
    if (kind < k_mist && s.water > 0)
      drops.push_back(kind < k_jets ? jet_drop(s, i, head_mm) : mist_drop(s, i, head_mm));
    if (kind >= k_mist && s.chips > 0) drops.push_back(chip(s, i, head_mm));
  }
  return drops;
}

}  // namespace cavum::station
