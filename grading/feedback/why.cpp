#include "grading/feedback/why.h"

#include <algorithm>

#include "engine/base/error.h"
#include "grading/feedback/loss_finder.h"
#include "grading/result/mark.h"

namespace cavum::grading {

Why why(const GradeInput& input, const Result& result, const scenarios::RubricSpec& rubric,
        const std::string& criterion_id) {
  Why w;
  List known;
  for (std::size_t i = 0; i < rubric.criteria.size(); ++i) {
    known.items.emplace_back(Name{rubric.criteria[i].id});
    if (rubric.criteria[i].id != criterion_id) continue;
    w.criterion = result.criteria.at(i);
    const scenarios::CriterionSpec spec = as_marked(rubric.criteria[i], result);
    w.full = spec.full;
    w.zero = spec.zero;
    LossFinder finder(input, result, spec, w);
    finder.find();
    std::stable_sort(w.items.begin(), w.items.end(),
                     [](const WhyItem& a, const WhyItem& b) { return a.tick < b.tick; });
    return w;
  }
  throw Error("--why", msg("the rubric has no criterion '{}'", criterion_id),
              msg("use one of: {}", known));
}

}  // namespace cavum::grading
