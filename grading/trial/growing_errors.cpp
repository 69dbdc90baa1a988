#include "grading/trial/growing_errors.h"

#include <fmt/core.h>

#include "engine/base/text.h"

namespace cavum::grading {
namespace {

/// The criterion whose points rose most from one result to the next, by its place in the rubric.
std::size_t most_risen(const Result& less, const Result& more) {
  std::size_t best = 0;
  double most = 0;
  for (std::size_t i = 0; i < more.criteria.size() && i < less.criteria.size(); ++i)
    if (const double by = more.criteria[i].points - less.criteria[i].points; by > most) {
      most = by;
      best = i;
    }
  return best;
}

/// The criterion that failed the one and not the other by a critical limit; else the one whose
/// points rose most.
std::size_t let_go(const Result& less, const Result& more) {
  for (std::size_t i = 0; i < more.criteria.size() && i < less.criteria.size(); ++i)
    if (less.criteria[i].critical_failed && !more.criteria[i].critical_failed) return i;
  return most_risen(less, more);
}

}  // namespace

std::vector<scenarios::Problem> judge_growth(const scenarios::Scenario& scenario,
                                             const Ladder& ladder, const Result& honest,
                                             const std::vector<Result>& grown) {
  std::vector<scenarios::Problem> problems;
  const auto amount = [&](std::size_t i) {
    return msg("{}", as_unit(ladder.amount[i], ladder.unit));
  };
  const auto at = [&](std::size_t criterion) {
    return fmt::format("rubric/criteria/{}/metric", criterion);
  };
  const Result* before = &honest;
  Message before_text = msg("none of it");
  bool failed = false, told = false;
  Message failed_at;
  const Result* failing = nullptr;
  for (std::size_t i = 0; i < grown.size(); ++i) {
    const Result& r = grown[i];
    if (failed && r.verdict == Verdict::pass && !told) {
      const std::size_t c = let_go(*failing, r);
      problems.push_back(scenarios::problem_at(
          scenario, at(c),
          msg("more of an error passes and less of it fails ({}): {} fails, {} passes with {} points",
              ladder.what, failed_at, amount(i), as_number(r.points, 1)),
          msg("see what '{}' measures there, and let another criterion fail it", r.criteria[c].id),
          scenarios::Mistake::faulty_preparations));
      told = true;
    }
    if (r.points > before->points + r.points_bound + 1e-9) {
      const std::size_t c = most_risen(*before, r);
      problems.push_back(scenarios::problem_at(
          scenario, at(c),
          msg("more of an error gains points ({}): {} gets {}, {} gets {}", ladder.what,
              before_text, as_number(before->points, 1), amount(i), as_number(r.points, 1)),
          msg("'{}' gives {} there and {} before: measure a largest value or a volume in its place",
              r.criteria[c].id, as_number(r.criteria[c].points, 1),
              as_number(before->criteria[c].points, 1)),
          scenarios::Mistake::faulty_preparations));
      problems.back().warning = true;
    }
    if (r.verdict == Verdict::fail && !failed) {
      failed = true;
      failing = &r;
      failed_at = amount(i);
    }
    before = &r;
    before_text = amount(i);
  }
  return problems;
}

}  // namespace cavum::grading
