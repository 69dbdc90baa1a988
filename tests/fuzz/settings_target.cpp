// The small texts that a session holds beside its motion: force model, servo settings, bur and
// landmarks, by the first byte.
#include "engine/physics/servo/servo.h"
#include "engine/tooth/anatomy/landmarks_file.h"
#include "tests/fuzz/material.h"
#include "tests/fuzz/targets.h"

namespace cavum::fuzz {

void fuzz_settings(Data data) {
  if (data.empty()) return;
  const std::string text = text_of(data.subspan(1));
  try {
    switch (data[0] % 4) {
      case 0:
        static_cast<void>(parse_force_model(text, "force_model.toml"));
        break;
      case 1:
        static_cast<void>(parse_servo_config(text, "servo.toml"));
        break;
      case 2:
        static_cast<void>(parse_bur(text, "bur.toml"));
        break;
      default:
        static_cast<void>(parse_landmarks(text, "landmarks.json"));
    }
  } catch (const Error&) {
  }
}

std::vector<Bytes> settings_seeds() {
  const auto with = [](char kind, const std::string& text) { return bytes_of(kind + text); };
  Landmarks some;
  some.cusps = {{"buccal", {0.1, 2, 1}, 0.5}};
  some.central_fissure_mm = some.neck_mm = {{1, 0, 0}, {-1, 1.0 / 3, 0}};
  some.canal_mouths = {{{0, 0, -6}, 0.4}};
  return {with(0, data_text("materials/paper.toml")),
          with(0, data_text("materials/consistent.toml")),
          with(0, data_text("materials/clinical.toml")),
          with(1, to_toml(ServoConfig{})),
          with(2, data_text("burs/round-1.0.toml")),
          with(2, data_text("burs/flame-1.0.toml")),
          with(2, data_text("burs/cylinder-flat-1.0.toml")),
          with(2, data_text("burs/endo-access-1.0.toml")),
          with(3, landmarks_text({})),
          with(3, landmarks_text(some))};
}

}  // namespace cavum::fuzz
