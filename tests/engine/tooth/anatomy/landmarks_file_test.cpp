// Landmarks that an exam keeps: every bit comes back, and what is anything else is refused.
#include "engine/tooth/anatomy/landmarks_file.h"

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "engine/base/file_error.h"
#include "engine/tooth/make/make_premolar.h"
#include "engine/tooth/make/tooth_shapes.h"
#include "tests/engine/support/basics.h"

namespace cavum {
namespace {

/// With every kind of field, and doubles that have no short decimal.
Landmarks kept_landmarks() {
  PremolarShape shape;
  shape.leaf_mm = 0.1;
  Landmarks l = find_landmarks(make_premolar(shape));
  l.fissure_branches_mm = {{{1.0 / 3, 0.1, -0.2}, {2e-17, -1e-300, 5}}, {}};
  l.chamber_floor_mm = Vec3{0.1 + 0.2, -0.0, 999.999};
  l.incisal_edge_mm.clear();
  l.central_pit_mm.reset();
  l.moved = {"mesial_pit"};
  return l;
}

TEST(LandmarksFile, EveryBitComesBack) {
  const Landmarks is = kept_landmarks();
  const Landmarks l = parse_landmarks(landmarks_text(is), "here");
  EXPECT_EQ(landmarks_text(l), landmarks_text(is));
  EXPECT_EQ(l.tooth_class.kind, ToothClass::premolar);
  EXPECT_EQ(l.central_fissure_mm, is.central_fissure_mm);
  EXPECT_EQ(l.fissure_branches_mm, is.fissure_branches_mm);
  EXPECT_EQ(l.neck_mm, is.neck_mm);
  EXPECT_EQ(l.chamber_floor_mm, is.chamber_floor_mm);
  EXPECT_EQ(l.mesial_ridge.lowest_mm, is.mesial_ridge.lowest_mm);
  EXPECT_FALSE(l.central_pit_mm);
  ASSERT_EQ(l.cusps.size(), is.cusps.size());
  EXPECT_EQ(l.cusps[0].name, is.cusps[0].name);
  EXPECT_EQ(l.cusps[0].tip_mm, is.cusps[0].tip_mm);
  EXPECT_EQ(l.canal_mouths.at(0).radius_mm, is.canal_mouths.at(0).radius_mm);
  EXPECT_EQ(l.long_axis.occlusal, is.long_axis.occlusal);
  EXPECT_EQ(l.moved, is.moved);
}

TEST(LandmarksFile, WhatIsAnythingElseIsRefusedByItsKey) {
  const auto good = nlohmann::json::parse(landmarks_text(kept_landmarks()));
  using testing_basics::code_of, testing_basics::tells;
  const auto refused = [](const nlohmann::json& text) {
    return testing_basics::thrown_by(
        [&] { static_cast<void>(parse_landmarks(text.dump(), "kept")); });
  };
  const auto expect_refused = [&](const nlohmann::json& text, FileError code,
                                  const std::string& key) {
    EXPECT_EQ(code_of(refused(text)), code) << key;
    EXPECT_TRUE(tells(refused(text), key)) << key;
  };
  EXPECT_FALSE(refused(good));
  for (const auto& [key, value] : good.items()) {
    auto less = good;
    less.erase(key);
    if (!key.starts_with("chamber_") && !key.ends_with("lowest_mm") && !key.ends_with("pit_mm"))
      expect_refused(less, FileError::missing, key);
    auto other = good;
    other[key] = true;
    expect_refused(other, FileError::wrong_type, key);
  }
  auto far = good;
  far["neck_mm"][0][2] = 1000.5;
  expect_refused(far, FileError::out_of_range, "neck_mm[0]");
  far["neck_mm"] = std::vector<std::vector<double>>(20'001, {0, 0, 0});
  expect_refused(far, FileError::too_large, "neck_mm");
  auto cusp = good;
  cusp["cusps"][0].erase("tip_mm");
  expect_refused(cusp, FileError::missing, "cusps[0].tip_mm");
  for (const char* text : {"", "[]", "7", "{", "{\"neck_mm\":1e999}"})
    EXPECT_THROW(static_cast<void>(parse_landmarks(text, "kept")), Error) << text;
}

}  // namespace
}  // namespace cavum
