#include "engine/physics/force/term_kinds.h"

#include <gtest/gtest.h>

#include <regex>

#include "engine/base/file_error.h"
#include "tests/engine/support/engine_testing.h"

namespace cavum {
namespace {

using namespace testing_engine;

std::string paper() { return read_text_file(data_path("materials/paper.toml")); }

int lines(const std::string& text) {
  return static_cast<int>(std::count(text.begin(), text.end(), '\n'));
}

TEST(ForceTerms, AreReadInTheOrderOfTheFile) {
  const std::string text =
      paper() +
      "\n[[terms]]\nkind = \"coulomb_friction\"\nfc_n = 0.26\nv0_mm_s = 1\n\n[[terms]]\nkind = \"run_out\"\neccentricity_um = 5\n";
  const ForceModel model = parse_force_model(text, "m.toml");
  ASSERT_EQ(model.terms.size(), 2u);
  TermMemory memory{};
  TermInput in;
  in.speed_mm_s = 1.0;
  EXPECT_NEAR(model.terms[0]->evaluate(in, memory).drag_n, 0.26 * std::tanh(1.0), 1e-12);
  EXPECT_TRUE(parse_force_model(paper(), "m.toml").terms.empty());
  std::string softer = text;
  softer.replace(softer.find("speed_filter_s"), 0, "drag_n_per_mm = 0.3\n");
  EXPECT_EQ(parse_force_model(softer, "m.toml").rendering.drag_n_per_mm, 0.3);
  EXPECT_EQ(model.rendering.drag_n_per_mm, 0.7);
}

TEST(ForceTerms, MistakesAreErrorsAtTheirPlaceAndNameWhatThereIs) {
  const struct {
    const char* term;
    FileError code;
    const char* tells;
    int line;
  } cases[] = {
      {"kind = \"columb_friction\"\nfc_n = 0.26\n", FileError::unknown, "series_compliance", 2},
      {"kind = \"coulomb_friction\"\nfc_n = 0.26\nv0 = 1\nv0_mm_s = 1\n", FileError::unknown,
       "v0_mm_s", 4},
      {"kind = \"coulomb_friction\"\nfc_n = 0.26\n", FileError::missing, "v0_mm_s", 1},
      {"kind = \"coulomb_friction\"\nfc_n = -0.26\nv0_mm_s = 1\n", FileError::out_of_range, "fc_n",
       3},
      {"kind = \"coulomb_friction\"\nfc_n = nan\nv0_mm_s = 1\n", FileError::out_of_range, "fc_n",
       3},
      {"kind = \"series_compliance\"\nks_n_per_mm = \"2\"\n", FileError::wrong_type, "ks_n_per_mm",
       3},
      {"kind = \"run_out\"\n", FileError::missing, "kind", 2},
      {"kind = 3\n", FileError::wrong_type, "kind", 2},
      {"fc_n = 0.26\n", FileError::missing, "kind", 1},
  };
  for (const auto& c : cases) {
    const std::string text = paper() + "\n[[terms]]\n" + c.term;
    const auto error = thrown_by([&] { (void)parse_force_model(text, "m.toml"); });
    EXPECT_EQ(code_of(error), c.code) << c.term;
    EXPECT_TRUE(
        place_of(error).starts_with("m.toml:" + std::to_string(lines(paper()) + 1 + c.line) + ":"))
        << c.term << place_of(error);
    EXPECT_TRUE(tells(error, c.tells)) << c.term;
  }
  EXPECT_EQ(code_of([&] { (void)parse_force_model("terms = [3]\n" + paper(), "m.toml"); }),
            FileError::wrong_type);
  std::string many = paper();
  for (std::size_t i = 0; i <= k_max_terms; ++i)
    many += "\n[[terms]]\nkind = \"run_out\"\namplitude_n = 0.001\n";
  EXPECT_EQ(code_of([&] { (void)parse_force_model(many, "m.toml"); }), FileError::too_large);
}

TEST(ForceTerms, WrittenTextReadsBackToTheLastBit) {
  for (const auto& kind : term_kinds()) {
    std::vector<std::pair<std::string, double>> parameters;
    for (const auto& p : kind.parameters)
      parameters.emplace_back(p.name, std::min(p.high, std::max(p.low, 0.1) * 1.1 + 1e-9));
    const std::string text = paper() + "\n" + force_term_toml(kind.name, parameters);
    const ForceTermPtr back = parse_force_model(text, "m.toml").terms.at(0),
                       direct = make_force_term(kind.name, parameters, "test");
    TermMemory a{}, b{};
    for (int i = 0; i < 50; ++i) {
      const TermInput in{true, 0.01 * i, 0.1 * i, 0.1 * i, 0.8, 1.79, 0.3, 1000.0 * i, i, 0.001};
      const TermForce one = back->evaluate(in, a), two = direct->evaluate(in, b);
      ASSERT_EQ(one.tissue_n, two.tissue_n);
      ASSERT_EQ(one.drag_n, two.drag_n);
      ASSERT_EQ(a, b);
    }
  }
  EXPECT_EQ(
      place_of(thrown_by([] { (void)make_force_term("gravity", {}, "here"); })).rfind("here", 0),
      0u);
}

}  // namespace
}  // namespace cavum
