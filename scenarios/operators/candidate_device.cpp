#include "scenarios/operators/candidate_device.h"

#include <algorithm>
#include <cmath>

namespace cavum::scenarios {

CandidateDevice::CandidateDevice(Candidate candidate, const OmniModel& omni)
    : candidate_(std::move(candidate)),
      omni_(omni),
      state_(make_omni_state(candidate_.hands.start_mm())),
      start_mm_(candidate_.hands.start_mm()) {
  seen_.proxy_mm = start_mm_;
}

DeviceReading CandidateDevice::read(double elapsed_s) {
  constexpr int k_max_steps = 100;
  constexpr std::int64_t k_rest_ticks =
      1500;  // a finished candidate holds still: conditions of the last step can come true
  const int steps =
      std::clamp(static_cast<int>(std::floor(elapsed_s / k_tick_s + 0.5)), 1, k_max_steps);
  Intent intent;
  Vec3 tip;
  for (int i = 0; i < steps; ++i) {
    intent = candidate_.hands.act(seen_, k_tick_s);
    tip = advance_omni(omni_, candidate_.hands.skill().hand, state_,
                       cut_.load(std::memory_order_acquire) ? Vec3{} : force_n_, intent.tip_mm,
                       k_tick_s);
    if (intent.done && ++rested_ > k_rest_ticks) done_.store(true, std::memory_order_release);
  }
  progress_.store(candidate_.hands.progress(), std::memory_order_relaxed);
  return {
      {tip, candidate_.hands.rotation()}, intent.pedal, k_stylus_fresh | k_pedal_fresh, intent.bur};
}

void CandidateDevice::send_force(Vec3 force_n) {
  force_n_ = force_n;
  cut_.store(false, std::memory_order_release);
}

std::unique_ptr<CandidateDevice> make_candidate_device(const ExamSetup& setup,
                                                       const std::string& skill,
                                                       std::uint64_t seed) {
  std::vector<ContactTool> tray;
  for (const auto& p : setup.burs) tray.push_back(make_contact_tool(p));
  return std::make_unique<CandidateDevice>(
      make_candidate(skill, setup.scenario, setup.zones, setup.tooth, tray, seed), OmniModel{});
}

}  // namespace cavum::scenarios
