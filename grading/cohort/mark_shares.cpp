#include "grading/cohort/mark_shares.h"

#include <map>
#include <set>
#include <utility>

namespace cavum::cohort {
namespace {

using Pair = std::pair<std::uint32_t, std::uint32_t>;
using Weights = std::map<Pair, double>;

double sum_of_squares(const Weights& weights) {
  double sum = 0;
  for (const auto& [at, w] : weights) sum += w * w;
  return sum;
}

double share_of(double sum, double of) { return of > 0 ? sum / of : 0.0; }

/// Sums over the second of each pair: what a group has in all.
std::map<std::uint32_t, double> by_second(const Weights& weights) {
  std::map<std::uint32_t, double> sums;
  for (const auto& [at, w] : weights) sums[at.second] += w;
  return sums;
}

double sum_of_squares(const std::map<std::uint32_t, double>& sums) {
  double sum = 0;
  for (const auto& [at, w] : sums) sum += w * w;
  return sum;
}

}  // namespace

std::vector<std::uint32_t> groups_under(std::uint32_t effect, std::span<const StudyMark> marks) {
  std::map<std::vector<std::uint32_t>, std::uint32_t> number;
  std::vector<std::uint32_t> group;
  for (const StudyMark& m : marks) {
    std::vector<std::uint32_t> key;
    for (std::size_t f = 0; f < m.level.size(); ++f)
      if ((effect >> f & 1U) != 0) key.push_back(m.level[f]);
    group.push_back(number.try_emplace(std::move(key), static_cast<std::uint32_t>(number.size()))
                        .first->second);
  }
  return group;
}

Marking::Marking(const StudyDesign& design, std::span<const StudyMark> marks) {
  std::map<std::uint32_t, double> of_person, tasks_of_person, persons_of_task;
  std::map<Pair, double> of_both;
  for (const StudyMark& m : marks) {
    of_person[m.level[0]] += 1;
    if ((of_both[{m.level[0], m.level[1]}] += 1) > 1) continue;
    tasks_of_person[m.level[0]] += 1;
    persons_of_task[m.level[1]] += 1;
  }
  persons_ = static_cast<double>(of_person.size());
  // Pairs of marks that an average goes over: of one candidate, then of two; from two tasks, then
  // from one.
  double with_two_tasks = 0, same_pairs = 0, places = 0, squared_tasks = 0, own_pairs = 0;
  for (const auto& [p, n] : tasks_of_person)
    with_two_tasks += n > 1 ? 1 : 0, own_pairs += n * n - n, places += n;
  for (const auto& [t, n] : persons_of_task) same_pairs += n * n - n, squared_tasks += n * n;
  const double other_pairs = places * places - squared_tasks - own_pairs;
  for (const std::uint32_t effect : design.effects) {
    const auto group = groups_under(effect, marks);
    Weights given, of_task, of_person_sum;  // (person, group), (task, group), (person, group)
    std::map<std::pair<Pair, std::uint32_t>, double> at_task;  // ((person, task), group)
    for (std::size_t i = 0; i < marks.size(); ++i) {
      const std::uint32_t p = marks[i].level[0], t = marks[i].level[1];
      const double of_mark = 1 / of_person[p], of_place = 1 / of_both[{p, t}];
      given[{p, group[i]}] += of_mark;
      at_task[{{p, t}, group[i]}] += of_place;
      of_task[{t, group[i]}] += of_place;
      of_person_sum[{p, group[i]}] += of_place;
    }
    const double squares = sum_of_squares(given);
    as_given_.own.push_back(squares / persons_);
    as_given_.common.push_back(
        share_of(sum_of_squares(by_second(given)) - squares, persons_ * (persons_ - 1)));

    double same = 0, all_same = 0, own_other = 0, all_own_other = 0;
    std::map<std::uint32_t, double> same_of_person;
    for (const auto& [at, w] : at_task) same_of_person[at.first.first] += w * w, all_same += w * w;
    std::map<std::uint32_t, double> whole_of_person;
    for (const auto& [at, w] : of_person_sum) whole_of_person[at.first] += w * w;
    for (const auto& [p, n] : tasks_of_person) {
      same += same_of_person[p] / n / persons_;
      const double other = whole_of_person[p] - same_of_person[p];
      all_own_other += other;
      if (n > 1) own_other += other / (n * n - n) / with_two_tasks;
    }
    same_task_.own.push_back(same);
    other_task_.own.push_back(own_other);
    const double by_task = sum_of_squares(of_task);
    same_task_.common.push_back(share_of(by_task - all_same, same_pairs));
    other_task_.common.push_back(
        share_of(sum_of_squares(by_second(of_task)) - by_task - all_own_other, other_pairs));
  }
  count(design, marks);
}

void Marking::count(const StudyDesign& design, std::span<const StudyMark> marks) {
  std::map<std::uint32_t, std::set<std::uint32_t>> tasks;
  std::map<std::uint32_t, std::size_t> each;
  for (const StudyMark& m : marks) tasks[m.level[0]].insert(m.level[1]), each[m.level[0]] += 1;
  marks_each_ = static_cast<double>(marks.size()) / persons_;
  for (const auto& [p, n] : each) even_ = even_ && n == each.begin()->second;
  for (std::size_t f = 1; f < design.facets.size(); ++f) {
    bool alone = false;
    for (const std::uint32_t e : design.effects)
      alone = alone || ((e >> f & 1U) != 0 && (e & 2U) == 0);
    const bool nested = f > 1 && !alone;
    std::map<Pair, std::set<std::uint32_t>>
        different;  // of a candidate, and of a task of his where the facet is nested in it
    for (const StudyMark& m : marks)
      different[{m.level[0], nested ? m.level[1] : 0}].insert(m.level[f]);
    double sum = 0;
    for (const auto& [at, levels] : different)
      sum += static_cast<double>(levels.size()),
          even_ = even_ && levels.size() == different.begin()->second.size();
    nested_.push_back(nested);
    conditions_.push_back(sum / static_cast<double>(different.size()));
  }
}

MarkShares Marking::with_tasks(double n) const {
  MarkShares shares;
  for (std::size_t k = 0; k < as_given_.own.size(); ++k) {
    shares.own.push_back(same_task_.own[k] / n + (1 - 1 / n) * other_task_.own[k]);
    shares.common.push_back(same_task_.common[k] / n + (1 - 1 / n) * other_task_.common[k]);
  }
  return shares;
}

}  // namespace cavum::cohort
