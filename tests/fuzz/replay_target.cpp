// The physics under any motion that a session can hold: up to four ticks of any bits, from the
// state after a sound beginning or from the first. The servo must come to an end with numbers, and
// give the same again.
#include <cmath>
#include <cstdlib>

#include "engine/session/session_reader.h"
#include "engine/session/simulation.h"
#include "tests/fuzz/material.h"
#include "tests/fuzz/targets.h"

namespace cavum::fuzz {
namespace {

constexpr std::size_t k_tick_bytes = 33, k_max_ticks = 4;

TickInput input_of(Data b) {
  ByteReader in(b, "tick");
  TickInput t;
  for (auto& x : t.tip_nm) x = in.get<std::int32_t>();
  for (auto& x : t.rotation_q30) x = in.get<std::int32_t>();
  t.pedal_q16 = in.get<std::uint16_t>();
  t.flags = in.get<std::uint16_t>();
  t.bur = in.get<std::uint8_t>();
  return t;
}

Bytes bytes_of(const TickInput& t) {
  ByteWriter out;
  for (const auto x : t.tip_nm) out.put(x);
  for (const auto x : t.rotation_q30) out.put(x);
  out.put(t.pedal_q16);
  out.put(t.flags);
  out.put(t.bur);
  return out.take();
}

struct Start {
  Simulation fresh = make_simulation(small_setup(), "replay");
  ServoState drilling = fresh.state;
  std::vector<TickInput> motion = SessionReader(small_session(), "session").inputs();
  Start() {
    for (std::size_t i = 0; i < 20; ++i) step(fresh.model, drilling, motion[i]);
  }
};
const Start& start() {
  static const Start k_start;
  return k_start;
}

std::uint64_t run(Data data, ServoState state) {
  for (std::size_t i = 0; i < k_max_ticks && data.size() >= k_tick_bytes;
       ++i, data = data.subspan(k_tick_bytes)) {
    const TickOutput output = step(start().fresh.model, state, input_of(data));
    static_cast<void>(make_tick_record(output));
    if (!is_finite(output.rendered_force_n) || !is_finite(output.proxy_mm) ||
        !std::isfinite(output.model_force_n))
      std::abort();
  }
  return state_hash(state);
}

}  // namespace

void fuzz_replay(Data data) {
  if (data.empty()) return;
  const ServoState& from = (data[0] & 1) != 0 ? start().drilling : start().fresh.state;
  if (run(data.subspan(1), from) != run(data.subspan(1), from)) std::abort();
}

std::vector<Bytes> replay_seeds() {
  std::vector<Bytes> seeds;
  for (const std::size_t first :
       {std::size_t{0}, std::size_t{10}, std::size_t{20}, std::size_t{26}}) {
    Bytes seed{static_cast<std::uint8_t>(first == 20)};
    for (std::size_t i = 0; i < k_max_ticks; ++i) {
      const Bytes tick = bytes_of(start().motion[first + i]);
      seed.insert(seed.end(), tick.begin(), tick.end());
    }
    seeds.push_back(std::move(seed));
  }
  return seeds;
}

}  // namespace cavum::fuzz
