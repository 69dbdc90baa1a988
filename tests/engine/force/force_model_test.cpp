#include "engine/force/force_model.h"

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
    EXPECT_NEAR(m.voigt.damping_n_s_per_mm, 2 * std::sqrt(0.8), 1e-12);  // eq. 5 with h = 1; the paper prints 1.79
    EXPECT_NEAR(m.tau_s, 0.505 / 0.25, 1e-12);                           // slope of eq. 6 over the crosshead's speed
  }
  EXPECT_EQ(model.materials.find("pulp")->second.voigt.stiffness_n_per_mm, 0.0);
  EXPECT_EQ(model.materials.find("pulp")->second.voigt.damping_n_s_per_mm, 0.0);
}

TEST(ForceModel, TheConsistentSetIsCriticallyDampedAt45Grams) {
  const Material m = shipped_model("consistent").materials.find("dentin")->second;
  const double critical_n_s_per_m = 2 * std::sqrt(m.voigt.stiffness_n_per_mm * 1000 * 0.045);
  EXPECT_NEAR(m.voigt.damping_n_s_per_mm * 1000, critical_n_s_per_m, 0.01);
}

TEST(ForceModel, BrokenFilesAreErrorsWithLineAndColumn) {
  const std::string good = read_text_file(data_path("materials/paper.toml"));
  const std::pair<const char*, const char*> edits[] = {{"rpm_ref = 200000.0", "rpm_ref = 0"},
                                                       {"k_n_per_mm = 0.8", "k_n_per_mm = -0.8"},
                                                       {"k_n_per_mm = 0.8", "k_n_per_mm = nan"},
                                                       {"k_n_per_mm = 0.8", "k_n_per_m = 800"},
                                                       {"c_n_s_per_mm = 1.7888543819998317", "c_n_s_per_mm = \"1.79\""},
                                                       {"[materials.enamel]", "[material.enamel]"},
                                                       {"[cutting]", "[cuting]"},
                                                       {"speed_filter_s = 0.005", ""},
                                                       {"name = \"paper\"", "name = paper"}};
  for (const auto& [from, to] : edits) {
    std::string text = good;
    const auto at = text.find(from);
    ASSERT_NE(at, std::string::npos) << from;
    text.replace(at, std::string(from).size(), to);
    const std::string error = error_of([&] { (void)parse_force_model(text, "m.toml"); });
    EXPECT_TRUE(std::regex_search(error, std::regex("^m\\.toml:[0-9]+:[0-9]+: .+; .+"))) << to << ": '" << error << "'";
  }
}

}  // namespace
}  // namespace cavum
