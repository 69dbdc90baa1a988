#include "engine/device/hardware/stylus_kind.h"

#include <algorithm>
#include <set>

#include "engine/device/device_error.h"
#include "engine/device/hardware/falcon_stylus.h"
#include "engine/device/hardware/inverse3_stylus.h"
#include "engine/device/hardware/openhaptics_stylus.h"
#include "engine/device/pointer_stylus.h"

namespace cavum {
namespace {

std::unique_ptr<Stylus> open_simulated(const StylusOptions& options) {
  if (options.hand)
    return std::make_unique<SimulatedStylus>(OmniModel{}, HandModel{}, k_tick_s, options.hand);
  const HandModel nobody{.mass_kg = 0.0, .stiffness_n_per_mm = 0.0, .damping_n_s_per_mm = 0.0};
  return std::make_unique<SimulatedStylus>(OmniModel{}, nobody, k_tick_s,
                                           [at = options.free_at_mm](double) {
                                             return HandIntent{at, 0.0};
                                           });
}

StylusKind simulated_kind() {
  return {.facts = simulated_facts(OmniModel{}),
          .hand = StylusHand::candidate,
          .look = [](const StationStylus&, bool) { return StylusLook{.there = true}; },
          .open = open_simulated};
}

StylusKind mouse_kind() {
  StylusFacts facts = simulated_facts(pointer_omni());
  facts.id = "mouse";
  facts.name = msg("mouse and keyboard, simulated Omni");
  return {.facts = facts, .hand = StylusHand::mouse};
}

bool is_word(const std::string& id) {
  return !id.empty() && std::all_of(id.begin(), id.end(), [](char c) {
    return (c >= 'a' && c <= 'z') || (c >= '0' && c <= '9');
  });
}

/// What the record lacks; empty when nothing.
Message lacks(const StylusKind& k) {
  const StylusFacts& f = k.facts;
  if (!is_word(f.id)) return msg("an id of lower-case letters and digits");
  if (f.name.empty()) return msg("a name");
  if (!(f.peak_n > 0.0) || !(f.continuous_n > 0.0) || f.continuous_n > f.peak_n)
    return msg("forces above 0, the peak the larger one");
  if (!(f.rate_hz > 0.0)) return msg("a rate");
  if (!(f.reach_mm > 0.0)) return msg("a reach");
  if (k.hand == StylusHand::mouse) return {};
  if (!k.look) return msg("a function that looks for it");
  if (!k.open) return msg("a function that opens it");
  return {};
}

bool among(std::initializer_list<StylusHand> hands, StylusHand hand) {
  return std::find(hands.begin(), hands.end(), hand) != hands.end();
}

}  // namespace

StylusKinds::StylusKinds(std::vector<StylusKind> kinds) : kinds_(std::move(kinds)) {
  std::set<std::string> taken;
  for (const auto& k : kinds_) {
    const Message where = msg("table of styluses, '{}'", k.facts.id);
    if (const Message lack = lacks(k); !lack.empty())
      throw Error(DeviceError::incomplete_record, where, msg("lacks {}", lack),
                  msg("complete its record; see docs/howto/add_a_stylus.md"));
    if (!taken.insert(k.facts.id).second)
      throw Error(DeviceError::name_taken, where, msg("stands there twice"),
                  msg("give each stylus an id of its own"));
  }
}

const StylusKind& StylusKinds::at(const std::string& id, const Message& where,
                                  std::initializer_list<StylusHand> hands) const {
  for (const auto& k : kinds_)
    if (k.facts.id == id && among(hands, k.hand)) return k;
  throw Error(DeviceError::unknown_stylus, where, msg("is no stylus that can be used here"),
              msg("name one of {}; `cavum devices` lists what is there", list_of(ids(hands))));
}

std::vector<std::string> StylusKinds::ids(std::initializer_list<StylusHand> hands) const {
  std::vector<std::string> ids;
  for (const auto& k : kinds_)
    if (among(hands, k.hand)) ids.push_back(k.facts.id);
  return ids;
}

const StylusKinds& stylus_kinds() {
  static const StylusKinds k_kinds(
      {simulated_kind(), mouse_kind(), falcon_kind(), touch_kind(), inverse3_kind()});
  return k_kinds;
}

}  // namespace cavum
