#include "grading/perforation/known_tooth.h"

#include "engine/base/bytes.h"
#include "engine/base/hash.h"
#include "engine/tooth/fill.h"
#include "grading/perforation/drop.h"
#include "grading/perforation/exposure.h"

namespace cavum::grading {
namespace {

std::string hash_of_motion(const SessionSetup& setup, const std::array<bool, 256>& tissues,
                           std::span<const TickInput> inputs) {
  ByteWriter all;
  for (const bool t : tissues) all.put(static_cast<std::uint8_t>(t));
  for (const auto& bur : setup.burs_toml) all.put_string(bur);
  all.put_string(setup.force_model_toml);
  all.put_string(setup.servo_toml);
  for (const auto v : setup.first_tip_nm) all.put(v);
  for (const TickInput& in : inputs) {
    for (const auto v : in.tip_nm) all.put(v);
    for (const auto v : in.rotation_q30) all.put(v);
    all.put(in.pedal_q16);
    all.put(in.flags);
    all.put(in.bur);
  }
  return to_hex(sha256(all.bytes()));
}

}  // namespace

const std::array<bool, 256>& KnownTooth::around(const std::array<bool, 256>& of_interest) {
  const std::lock_guard lock(mutex_);
  const auto known = around_.find(of_interest);
  return known != around_.end()
             ? known->second
             : around_.emplace(of_interest, tissues_around(own_, of_interest)).first->second;
}

std::vector<double> KnownTooth::filled_force_n(const SessionSetup& setup,
                                               const std::array<bool, 256>& tissues,
                                               std::span<const TickInput> inputs) {
  std::string asked = hash_of_motion(setup, tissues, inputs);
  const Tooth* tooth = nullptr;
  {
    const std::lock_guard lock(mutex_);
    if (asked == last_asked_) return last_n_;
    auto filled = filled_.find(tissues);
    if (filled == filled_.end())
      filled = filled_.emplace(tissues, filled_tooth(seen_, tissues)).first;
    tooth = &filled->second;
  }
  std::vector<double> force_n = grading::filled_force_n(setup, *tooth, inputs);
  const std::lock_guard lock(mutex_);
  last_asked_ = std::move(asked);
  last_n_ = force_n;
  return force_n;
}

}  // namespace cavum::grading
