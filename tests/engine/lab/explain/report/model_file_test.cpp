#include "engine/lab/explain/report/model_file.h"

#include <gtest/gtest.h>

#include "engine/base/file.h"
#include "tests/engine/support/basics.h"

namespace cavum::explain {
namespace {

TEST(ModelFile, NamesOfTheModelThatWasGivenStayNames) {
  const std::string path = testing_basics::data_path("materials/paper.toml"),
                    evil = "x\"]\nrpm_ref = 1\n[rendering]\n\x7f\\";
  ForceModel start = parse_force_model(read_text_file(path), path);
  start.name = evil + "-extended";
  start.materials[evil] = start.materials.at("dentin");
  const std::string text = extended_model_toml(Explanation{}, start);
  const ForceModel again = parse_force_model(text, "extended.toml");
  EXPECT_EQ(again.name, start.name);
  EXPECT_EQ(again.rpm_ref, start.rpm_ref);
  ASSERT_EQ(again.materials.size(), start.materials.size());
  EXPECT_TRUE(again.materials.contains(evil));
  EXPECT_NE(text.find("\n[materials.dentin]\n"), std::string::npos)
      << "a plain name is written plainly";
}

TEST(ModelFile, AModelThatCutsByPressureStaysOne) {
  const std::string path = testing_basics::data_path("materials/clinical.toml");
  const ForceModel start = parse_force_model(read_text_file(path), path),
                   again = parse_force_model(extended_model_toml(Explanation{}, start), "e.toml");
  EXPECT_EQ(again.law, CuttingLaw::pressure);
  EXPECT_EQ(again.force_ratio, start.force_ratio);
  EXPECT_EQ(again.drive.torque_n_mm, start.drive.torque_n_mm);
  EXPECT_EQ(again.drive.slip_rpm, start.drive.slip_rpm);
  for (const auto& [name, m] : start.materials)
    EXPECT_EQ(again.materials.at(name).wear_mm3_per_n_m, m.wear_mm3_per_n_m) << name;
}

}  // namespace
}  // namespace cavum::explain
