#include "grading/cohort/form_difficulty.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "engine/base/error.h"
#include "engine/base/order.h"
#include "engine/base/random.h"

namespace cavum::cohort {
namespace {

constexpr int k_draws = 1999;
constexpr double k_sure = 0.95;

/// A candidate's marks less the mean of them: what the forms differ by, without how able the
/// candidate is.
Matrix without_candidates(const Matrix& marks) {
  Matrix rest = marks;
  for (auto& row : rest) {
    const double own = mean(row);
    for (double& v : row) v -= own;
  }
  return rest;
}

struct Estimate {
  std::vector<double> value, error;  // of each column, over rows
};
Estimate columns(const Matrix& rows) {
  const std::size_t n = rows.size(), k = rows[0].size();
  Estimate e{std::vector<double>(k), std::vector<double>(k)};
  for (const auto& row : rows)
    for (std::size_t f = 0; f < k; ++f) e.value[f] += row[f] / static_cast<double>(n);
  for (const auto& row : rows)
    for (std::size_t f = 0; f < k; ++f) e.error[f] += (row[f] - e.value[f]) * (row[f] - e.value[f]);
  for (double& s : e.error) s = std::sqrt(s / static_cast<double>(n * (n - 1)));
  return e;
}

double largest_ratio(const Estimate& e) {
  double most = 0;
  for (std::size_t f = 0; f < e.value.size(); ++f)
    if (e.error[f] > 0) most = std::max(most, std::fabs(e.value[f]) / e.error[f]);
  return most;
}

/// Wild bootstrap: each candidate's row, centred, keeps or changes its sign. Gives the largest
/// ratios of all columns: their share `k_sure` is half an interval that holds in all columns at
/// once, whatever the spread of each candidate and form (Wu, Annals of Statistics 14 (1986) 1261;
/// Westfall and Young 1993). Marks shuffled within each candidate would be exact only for forms
/// that scatter alike.
std::vector<double> chance_ratios(Matrix rows, Random& random) {
  const Estimate own = columns(rows);
  for (auto& row : rows)
    for (std::size_t f = 0; f < row.size(); ++f) row[f] -= own.value[f];
  std::vector<double> largest;
  Matrix drawn = rows;
  for (int d = 0; d < k_draws; ++d) {
    for (std::size_t c = 0; c < rows.size(); ++c) {
      const double sign = random.below(2) == 0 ? 1.0 : -1.0;
      for (std::size_t f = 0; f < rows[c].size(); ++f) drawn[c][f] = sign * rows[c][f];
    }
    largest.push_back(largest_ratio(columns(drawn)));
  }
  return largest;
}

double critical_ratio(const Matrix& rows, Random& random) {
  return quantile(chance_ratios(rows, random), k_sure);
}

FormVerdict verdict_of(const FormDifficulty& f, double limit) {
  if (f.low > limit) return FormVerdict::too_easy;
  if (f.high < -limit) return FormVerdict::too_hard;
  return f.low >= -limit && f.high <= limit ? FormVerdict::alike : FormVerdict::doubtful;
}

void check_marks(const Matrix& marks, std::span<const double> skill, double limit) {
  if (marks.size() < k_fewest_candidates)
    throw Error(msg("difficulty"), msg("needs ten candidates at least"),
                msg("let more of them sit the forms"));
  if (marks[0].size() < 2)
    throw Error(msg("difficulty"), msg("needs two forms at least"), msg("name more scenarios"));
  for (const auto& row : marks)
    if (row.size() != marks[0].size())
      throw Error(msg("difficulty"), msg("needs a mark of each candidate on each form"),
                  msg("leave out who did not sit all"));
  if (skill.size() != marks.size())
    throw Error(msg("difficulty"), msg("needs the skill of each candidate"),
                msg("give one for each row of marks"));
  if (!(limit > 0))
    throw Error(msg("difficulty"), msg("needs a limit above 0"),
                msg("say from how many percent on forms count as unequal"));
}

}  // namespace

const char* form_verdict_name(FormVerdict verdict) {
  switch (verdict) {
    case FormVerdict::alike:
      return "alike";
    case FormVerdict::too_easy:
      return "too easy";
    case FormVerdict::too_hard:
      return "too hard";
    case FormVerdict::doubtful:
      break;
  }
  return "doubtful";
}

FormsJudged judge_forms(const Matrix& marks, std::span<const double> skill, double limit,
                        std::uint64_t seed) {
  check_marks(marks, skill, limit);
  Random random(seed);
  FormsJudged out;
  out.candidates = marks.size();
  out.limit = limit;
  const Matrix rest = without_candidates(marks);
  const Estimate all = columns(marks), easier = columns(rest);
  const std::vector<double> by_chance = chance_ratios(rest, random);
  out.critical = quantile(by_chance, k_sure);
  const double found = largest_ratio(easier);
  const auto as_much = std::count_if(by_chance.begin(), by_chance.end(),
                                     [&](double r) { return r >= found * (1 - 1e-12); });
  out.chance = (static_cast<double>(as_much) + 1.0) / (k_draws + 1.0);

  std::vector<std::size_t> by_skill(marks.size());
  std::iota(by_skill.begin(), by_skill.end(), std::size_t{0});
  std::stable_sort(by_skill.begin(), by_skill.end(),
                   [&](std::size_t a, std::size_t b) { return skill[a] < skill[b]; });
  const std::size_t half = by_skill.size() / 2;
  Matrix weak, able, apart;  // of an odd number the middle one is in neither half
  for (std::size_t i = 0; i < half; ++i) {
    weak.push_back(rest[by_skill[i]]);
    able.push_back(rest[by_skill[by_skill.size() - half + i]]);
    auto& row = apart.emplace_back(weak.back());
    for (std::size_t f = 0; f < row.size(); ++f) row[f] -= able.back()[f];
  }
  const Estimate for_weak = columns(weak), for_able = columns(able), halves = columns(apart);
  const double critical_of_halves = critical_ratio(apart, random);

  const auto forms = marks[0].size();
  const auto k = static_cast<double>(forms);
  double between = 0, within = 0;
  for (std::size_t f = 0; f < forms; ++f) {
    FormDifficulty form;
    form.mean = all.value[f];
    form.mean_error = all.error[f];
    form.easier = easier.value[f];
    form.easier_error = easier.error[f];
    form.low = form.easier - out.critical * form.easier_error;
    form.high = form.easier + out.critical * form.easier_error;
    form.easier_for_weak = for_weak.value[f];
    form.easier_for_able = for_able.value[f];
    form.depends_on_skill =
        std::fabs(halves.value[f]) > std::max(limit, critical_of_halves * halves.error[f]);
    form.verdict = verdict_of(form, limit);
    form.constant = -form.easier;
    out.forms.push_back(form);
    between += form.easier * form.easier / (k - 1);
    within += form.easier_error * form.easier_error /
              (k - 1);  // of k forms k - 1 are free: their mean is taken out
  }
  out.spread = std::sqrt(std::max(0.0, between - within));
  return out;
}

std::size_t candidates_needed(const FormsJudged& judged) {
  double widest = 0;
  for (const auto& f : judged.forms) widest = std::max(widest, 0.5 * (f.high - f.low));
  const double ratio = widest / (0.5 * judged.limit);
  return static_cast<std::size_t>(
      std::ceil(static_cast<double>(judged.candidates) * ratio * ratio));
}

}  // namespace cavum::cohort
