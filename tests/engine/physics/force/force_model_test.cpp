#include "engine/physics/force/force_model.h"

#include <gtest/gtest.h>

#include <regex>

#include "tests/engine/support/engine_testing.h"

namespace cavum {
namespace {

using namespace testing_engine;

TEST(ForceModel, ThePapersSetHasThePapersNumbers) {
  const ForceModel model = shipped_model("paper");
  for (const char* hard : {"enamel", "dentin"}) {
    const Material& m = model.materials.find(hard)->second;
    EXPECT_EQ(m.voigt.stiffness_n_per_mm, 0.8);
    EXPECT_NEAR(m.voigt.damping_n_s_per_mm, 2 * std::sqrt(0.8),
                1e-12);                         // eq. 5 with h = 1; the paper prints 1.79
    EXPECT_NEAR(m.tau_s, 0.505 / 0.25, 1e-12);  // slope of eq. 6 over the crosshead's speed
  }
  EXPECT_EQ(model.materials.find("pulp")->second.voigt.stiffness_n_per_mm, 0.0);
  EXPECT_EQ(model.materials.find("pulp")->second.voigt.damping_n_s_per_mm, 0.0);
}

TEST(ForceModel, TheConsistentSetIsCriticallyDampedAt45Grams) {
  const Material m = shipped_model("consistent").materials.find("dentin")->second;
  const double critical_n_s_per_m = 2 * std::sqrt(m.voigt.stiffness_n_per_mm * 1000 * 0.045);
  EXPECT_NEAR(m.voigt.damping_n_s_per_mm * 1000, critical_n_s_per_m, 0.01);
}

/// Where a shipped set in which `from` reads `to` is wrong.
std::string broken(const std::string& set, const std::string& from, const std::string& to) {
  std::string text = read_text_file(data_path("materials/" + set + ".toml"));
  const auto at = text.find(from);
  if (at == std::string::npos) return "no '" + from + "' in it";
  text.replace(at, from.size(), to);
  return place_of(thrown_by([&] { (void)parse_force_model(text, "m.toml"); }));
}

TEST(ForceModel, TheClinicalSetCutsByPressureAndTellsTissuesApart) {
  const ForceModel model = shipped_model("clinical"), felt = shipped_model("consistent");
  EXPECT_EQ(model.law, CuttingLaw::pressure);
  EXPECT_EQ(felt.law, CuttingLaw::penetration);
  const auto wear = [&](const char* tissue) {
    return model.materials.find(tissue)->second.wear_mm3_per_n_m;
  };
  EXPECT_NEAR(wear("dentin") / wear("enamel"), 274.8 / 65.6, 0.05) << "the ratio of hardness";
  EXPECT_EQ(wear("pulp"), 0.0);
  for (const auto& [name, m] : felt.materials) {
    EXPECT_EQ(model.materials.find(name)->second.voigt.stiffness_n_per_mm,
              m.voigt.stiffness_n_per_mm)
        << name;
    EXPECT_EQ(model.materials.find(name)->second.voigt.damping_n_s_per_mm,
              m.voigt.damping_n_s_per_mm)
        << name;
  }
}

TEST(ForceModel, BrokenFilesAreErrorsWithLineAndColumn) {
  const std::pair<const char*, const char*> of_paper[] = {
      {"rpm_ref = 200000.0", "rpm_ref = 0"},
      {"k_n_per_mm = 0.8", "k_n_per_mm = -0.8"},
      {"k_n_per_mm = 0.8", "k_n_per_mm = nan"},
      {"k_n_per_mm = 0.8", "k_n_per_m = 800"},
      {"c_n_s_per_mm = 1.7888543819998317", "c_n_s_per_mm = \"1.79\""},
      {"[materials.enamel]", "[material.enamel]"},
      {"[cutting]", "[cuting]"},
      {"[cutting]", "[handpiece]\ntorque_n_mm = 1.0\nslip_rpm = 1.0\n[cutting]"},
      {"tau_s = 2.02", "wear_mm3_per_n_m = 0.005"},
      {"speed_filter_s = 0.005", ""},
      {"name = \"paper\"", "name = paper"}};
  const std::pair<const char*, const char*> of_clinical[] = {
      {"law = \"pressure\"", "law = \"force\""},
      {"law = \"pressure\"", "law = \"penetration\""},
      {"law = \"pressure\"", "law = \"pressure\"\nrpm_ref = 200000.0"},
      {"force_ratio = 0.4", "force_ratio = -0.4"},
      {"force_ratio = 0.4", ""},
      {"torque_n_mm = 1.4", "torque_n_mm = 0"},
      {"slip_rpm = 400000.0 ", "slip = 400000.0 "},
      {"wear_mm3_per_n_m = 0.005", "tau_s = 2.02"},
      {"wear_mm3_per_n_m = 0.005", "wear_mm3_per_n_m = -0.005"},
      {"wear_mm3_per_n_m = 0.005", "wear_mm3_per_n_m = 1e-300"}};
  const std::regex place("m\\.toml:[0-9]+:[0-9]+");
  for (const auto& [from, to] : of_paper)
    EXPECT_TRUE(std::regex_match(broken("paper", from, to), place)) << to;
  for (const auto& [from, to] : of_clinical)
    EXPECT_TRUE(std::regex_match(broken("clinical", from, to), place)) << to;
}

}  // namespace
}  // namespace cavum
