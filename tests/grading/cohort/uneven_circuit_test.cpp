// Circuits whose candidates have unequal numbers of exams and judges, or judges of their own:
// classes of known components, whose marks' errors are known because they were drawn. What is
// stated must be what is there.
#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>

#include "engine/base/statistics.h"
#include "grading/cohort/circuit_study.h"
#include "tests/engine/support/basics.h"
#include "tests/grading/cohort/drawn_class.h"

namespace cavum::cohort {
namespace {

using namespace drawn;

struct Design {
  const char* words;
  Allocation places;
  Truth truth;
};
const Design k_designs[] = {
    {"2 of 6 judges for each candidate", fixed_pairs, {}},
    {"2 of 6 judges for each work", drawn_pairs, {}},
    {"a quarter of the marks missing", a_quarter_missing, {}},
    {"8 of 40 candidates sat all exams",
     few_sat_all,
     {.exam = 25, .judge = 4, .candidate_exam = 36}},
    {"everybody by the same 2 judges", [](Random&) { return crossed(30, 3, 2); }, {}}};

TEST(UnevenCircuit, StatedErrorAndRangeAreThoseOfTheMarksThatCandidatesHave) {
  Random random(testing_basics::drawn_seed("UnevenCircuit"));
  const bool deep = std::getenv("CAVUM_DEEP") != nullptr;
  const int classes = deep ? 400 : 60, draws = deep ? 1000 : 200,
            drawn_for_truth = deep ? 20000 : 2000;
  for (const Design& d : k_designs) {
    std::vector<double> truth;
    for (int i = 0; i < drawn_for_truth; ++i)
      truth.push_back(draw(d.places(random), d.truth, random).squared_error);
    const double true_variance = mean(truth),
                 phi = d.truth.candidate / (d.truth.candidate + true_variance);
    std::vector<double> stated;
    int held = 0, crossed_bounds = 0;
    for (int i = 0; i < classes; ++i) {
      const DrawnClass c = draw(d.places(random), d.truth, random);
      const VarianceStudy study(crossed_design({"candidate", "exam", "judge"}), c.marks);
      std::vector<double> values;
      for (const auto& m : c.marks) values.push_back(m.value);
      const auto found = study.estimate(values);
      const std::vector<MarkShares> circuit{study.marking().as_given()};
      stated.push_back(
          dependability(study.design(), found, circuit[0], study.marking().persons()).absolute);
      const auto range = study_ranges(study, found, circuit, draws, random.next()).circuits[0];
      held += range.phi_low <= phi && phi <= range.phi_high;
      crossed_bounds += range.phi_low > range.g_low || range.phi_high > range.g_high;
    }
    const double error = std::sqrt(variance(stated) / classes + variance(truth) / drawn_for_truth);
    std::printf(
        "%-34s true error ± %.2f, stated ± %.2f (its square %.1f ± %.1f for %.1f); range of phi holds %.2f in %d of %d\n",
        d.words, std::sqrt(true_variance), std::sqrt(mean(stated)), mean(stated), error,
        true_variance, phi, held, classes);
    EXPECT_NEAR(mean(stated), true_variance, 4 * error + 0.05 * true_variance) << d.words;
    EXPECT_GE(held, 0.86 * classes) << d.words;
    EXPECT_EQ(crossed_bounds, 0) << d.words << ": phi never exceeds g";
  }
}

}  // namespace
}  // namespace cavum::cohort
