#include "grading/cohort/sit_forms.h"

#include <fmt/core.h>

#include <algorithm>
#include <filesystem>
#include <memory>
#include <mutex>

#include "engine/base/error.h"
#include "engine/base/independent_runs.h"
#include "engine/base/random.h"
#include "engine/base/scratch_folder.h"
#include "grading/marking/grade.h"
#include "grading/marking/session_input.h"
#include "scenarios/operators/simulated_exam.h"

namespace cavum::cohort {
namespace {

/// The session is not sealed: nobody keeps it.
grading::Result result_of(const scenarios::ExamSetup& form, int level, std::uint64_t seed,
                          const std::string& session, grading::ExamContexts& grounds) {
  auto hands = scenarios::make_simulated_candidate(form, fmt::format("student-{}", level), seed,
                                                   OmniModel{});
  const auto exam = scenarios::Exam::start(form, session, hands.start_mm());
  scenarios::run_exam(*exam, hands);
  exam->recorder().flush();
  const auto graded = grading::load_for_grading(SessionReader(exam->recorder().image(), session),
                                                exam->tooth_now(), grounds);
  return grading::grade(graded->input(), graded->rubric);
}

/// One task on another tooth has a target of the same bodies, whatever their sizes.
bool is_one_task(const scenarios::Scenario& a, const scenarios::Scenario& b) {
  return std::equal(a.zones.target.begin(), a.zones.target.end(), b.zones.target.begin(),
                    b.zones.target.end(),
                    [](const scenarios::ShapeSpec& x, const scenarios::ShapeSpec& y) {
                      return x.kind == y.kind && x.outline.kind == y.outline.kind;
                    });
}

std::vector<std::unique_ptr<scenarios::ExamSetup>> prepared(const std::vector<std::string>& files,
                                                            FormsSat& sat) {
  std::vector<std::unique_ptr<scenarios::ExamSetup>> forms;
  for (const auto& file : files) {
    scenarios::ExamOptions options;
    options.candidate = "simulated student";
    forms.push_back(scenarios::prepare_exam(file, options));
    const scenarios::Scenario& s = forms.back()->scenario;
    if (std::find(sat.ids.begin(), sat.ids.end(), s.id) != sat.ids.end())
      throw Error(file, msg("its id '{}' is that of another form", s.id),
                  msg("name each form once"));
    const bool first = sat.ids.empty();
    if (!first && s.rubric.pass_percent != sat.pass_percent)
      throw Error(file,
                  msg("its pass mark is {}, that of {} is {}",
                      as_percent(s.rubric.pass_percent, k_as_needed), sat.ids[0],
                      as_percent(sat.pass_percent, k_as_needed)),
                  msg("forms of one exam have one pass mark"));
    if (!first && !is_one_task(s, forms.front()->scenario))
      throw Error(file, msg("its target is made of other bodies than that of {}", sat.ids[0]),
                  msg("forms of one exam are one task on several teeth"));
    sat.pass_percent = s.rubric.pass_percent;
    sat.borderline_percent = first ? s.rubric.borderline_percent
                                   : std::min(sat.borderline_percent, s.rubric.borderline_percent);
    sat.ids.push_back(s.id);
  }
  return forms;
}

}  // namespace

FormsSat sit_forms(const FormsWanted& wanted, const std::function<void(int)>& done) {
  FormsSat sat;
  const auto forms = prepared(wanted.scenarios, sat);
  const auto n = static_cast<std::size_t>(wanted.candidates), k = forms.size();
  Random random(wanted.seed);
  for (std::size_t i = 0; i < n; ++i) {
    sat.level.push_back(static_cast<int>((2 * i + 1) * 50 / n));
    sat.seed.push_back(random.next() >> 1);
  }
  sat.percent.assign(n, std::vector<double>(k));
  sat.passed.assign(k, 0);

  const ScratchFolder scratch;
  std::mutex one;  // of what follows, and of `sat`
  int ended = 0;
  grading::ExamContexts grounds;  // of all
  independent_runs(
      n * k,
      [&](std::size_t i) {
        const std::size_t form = i / n, student = i % n;
        const std::string session = scratch.file(fmt::format("{}.cavum", i));
        const auto r =
            result_of(*forms[form], sat.level[student], sat.seed[student], session, grounds);
        std::error_code ignored;
        std::filesystem::remove(session, ignored);
        const std::lock_guard lock(one);
        sat.percent[student][form] = r.max_points > 0 ? 100.0 * r.points / r.max_points : 0.0;
        sat.passed[form] += r.verdict == grading::Verdict::pass ? 1 : 0;
        done(++ended);
      },
      static_cast<std::size_t>(std::clamp(wanted.at_once, 1, 16)));
  return sat;
}

}  // namespace cavum::cohort
