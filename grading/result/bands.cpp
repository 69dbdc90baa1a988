#include "grading/result/bands.h"

#include <cmath>

#include "grading/result/loss.h"

namespace cavum::grading {

void put_in_band(const Result& r, const scenarios::CriterionSpec& spec, CriterionResult& c) {
  if (spec.band_limits.empty() || r.bands.empty()) return;
  const scenarios::Measure measure = scenarios::known_measure(spec.metric);
  const bool judged = c.value && c.work_share >= 1;
  const double worse = spec.zero < spec.full ? -1 : 1;
  std::size_t band = 0;
  while (band < spec.band_limits.size() &&
         (!judged || worse * (*c.value - spec.band_limits[band]) > 0))
    ++band;
  c.band = band;
  using Kind = FindingKind;
  const Authored name{r.bands[band].name};
  const auto limit = [&](std::size_t i) { return value_text(measure, spec.band_limits[i], 0, 2); };
  c.facts.push_back(!judged && c.value ? finding<Kind::in_band_for_part>(name)
                    : judged && band > 0 && measure.reads != scenarios::Reads::yes_no
                        ? finding<Kind::in_band_beyond>(name, limit(band - 1))
                        : finding<Kind::in_band>(name));
  if (!judged) return;
  for (std::size_t i = 0; i < spec.band_limits.size(); ++i)
    if (c.bound > 0 && std::fabs(*c.value - spec.band_limits[i]) <= c.bound)
      c.facts.push_back(finding<Kind::band_limit_in_bound>(limit(i)));
}

Findings count_bands(Result& r) {
  for (auto& b : r.bands) b.criteria = 0;
  for (const auto& c : r.criteria)
    if (c.band) ++r.bands[*c.band].criteria;
  Findings failed;
  for (std::size_t i = 0; i < r.bands.size(); ++i) {
    if (!r.bands[i].most) continue;
    List which;
    for (const auto& c : r.criteria)
      if (c.band && *c.band >= i) which.items.push_back(msg("{}", Authored{c.title}));
    const int count = static_cast<int>(which.items.size()), most = *r.bands[i].most;
    if (count <= most) continue;
    const Authored band{r.bands[i].name};
    failed.push_back(i + 1 < r.bands.size()
                         ? finding<FindingKind::bands_too_full>(count, band, most, which)
                         : finding<FindingKind::band_too_full>(count, band, most, which));
  }
  return failed;
}

}  // namespace cavum::grading
