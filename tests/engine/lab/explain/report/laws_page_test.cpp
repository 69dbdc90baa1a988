#include "engine/lab/explain/report/laws_page.h"

#include <gtest/gtest.h>

#include "engine/base/file.h"

namespace cavum::explain {
namespace {

TEST(LawsPage, IsTheOneInTheManual) {
  EXPECT_EQ(laws_page(), read_text_file(CAVUM_SOURCE_DIR "/docs/laws.md"))
      << "write it anew: cavum explain --laws > docs/laws.md";
}

TEST(LawsPage, NamesTheParametersOfEveryForm) {
  const auto names = [](const char* law) {
    return parameter_names(mechanism_at(known_mechanism(law)));
  };
  EXPECT_EQ(names("drift"), (std::vector<std::string>{"rate_n_per_s", "amplitude_n", "tau_s"}));
  EXPECT_EQ(names("relaxation"),
            (std::vector<std::string>{"k1_n_per_mm", "tau1_s", "k2_n_per_mm", "tau2_s"}));
  EXPECT_EQ(names("series_compliance"),
            (std::vector<std::string>{"softening_force_n", "ks_n_per_mm"}));
  for (const auto& m : mechanisms()) EXPECT_FALSE(parameter_names(m).empty()) << m.name;
}

TEST(LawsPage, AForceTermHasEveryParameterThatItsLawIsFoundAs) {
  // a cause must be writable as a term: each number that is found has a place in the term, but a
  // mass or a spring in series has none of its own
  for (const auto& m : mechanisms()) {
    if (m.term == nullptr) continue;
    std::size_t there = 0;
    for (const auto& name : parameter_names(m))
      for (const auto& p : m.term->parameters) there += name == p.name;
    EXPECT_GT(there, 0u) << m.name;
  }
}

}  // namespace
}  // namespace cavum::explain
