// What does not hold of a recording: a kind, which programs ask for, and the sentence.
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string_view>
#include <vector>

#include "engine/base/message.h"
#include "engine/base/named_enum.h"

namespace cavum {

// clang-format off
#define CAVUM_DAMAGES(DAMAGE) \
  DAMAGE(file)      /* its database: form, log, a row that cannot be read */ \
  DAMAGE(meta)      /* a fact of the exam, or the beginning's signature */ \
  DAMAGE(artifact)  /* a file in it is changed or missing */ \
  DAMAGE(event) \
  DAMAGE(chunk)     /* motion, forces or their chain */ \
  DAMAGE(result) \
  DAMAGE(seal) \
  DAMAGE(station)   /* closed by another than expected */ \
  DAMAGE(physics)   /* of another version: cannot be replayed */ \
  DAMAGE(replay)    /* did not come to its end */ \
  DAMAGE(ticks)     /* forces of the replay differ from the recorded ones */ \
  DAMAGE(state)     /* the replay's state differs at a chunk's end */ \
  DAMAGE(tooth)     /* the final tooth is not the one that the replay leaves */ \
  DAMAGE(open)      /* never closed */
// clang-format on

CAVUM_NAMED_ENUM(DamageKind, CAVUM_DAMAGES)

struct Damage {
  DamageKind kind{};
  Message what;
};
using Damages = std::vector<Damage>;
[[nodiscard]] std::vector<Message> words_of(const Damages& damages);

/// For other programs: {"kind", "values", "text"}.
void to_json(nlohmann::json& json, const Damage& damage);

}  // namespace cavum
