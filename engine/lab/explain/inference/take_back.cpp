#include "engine/lab/explain/inference/take_back.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <string_view>
#include <utility>

#include "engine/lab/explain/inference/heldout.h"
#include "engine/lab/explain/inference/intervals.h"
#include "engine/lab/explain/inference/probability.h"

namespace cavum::explain {
namespace {

constexpr double k_likely_enough =
    0.75;  // less is no claim: of what would be named below it, two in five are false
constexpr double k_min_gain_percent =
    1.0;  // of the error on sessions left out: less is of no use to anybody

const Interval& parameter(const Cause& c, const char* name) {
  return std::find_if(c.parameters.begin(), c.parameters.end(),
                      [&](const auto& p) { return p.first == name; })
      ->second;
}

/// Way that the positions show, mm; 0 when a speed was measured beside them.
double resolved_mm(const Motion& m) {
  return m.speed_sd_mm_s > 0.0 ? 0.0 : std::max(m.quantum_mm, std::sqrt(12.0) * m.noise_mm);
}

/// A cause that a careful person would sign: its parameters have an end, leave out that nothing is
/// there, do not lie at the edge of what was looked at, and are no way that the positions do not
/// show.
bool is_signed(const Cause& c, const Scene& scene) {
  const Mechanism& m = mechanism_of(c.term);
  for (const auto& [name, i] : c.parameters)
    if (!std::isfinite(i.low) || !std::isfinite(i.high)) return false;
  const std::vector<ShapeRange> ranges = ranges_of(m, scene);
  for (std::size_t i = 0; i < ranges.size(); ++i) {
    const ShapeRange& range = ranges[i];
    if (!range.fitted || c.term.shape[i] == 0.0 || std::string_view(range.name) == "v0_mm_s")
      continue;  // a sign has no width
    const double edge =
        range.logarithmic ? 1e-3 * c.term.shape[i] : 1e-6 * (range.high - range.low);
    if (c.term.shape[i] < range.low + edge || c.term.shape[i] > range.high - edge) return false;
  }
  if (m.way != nullptr && parameter(c, m.way).value < resolved_mm(*scene.motion)) return false;
  if (m.must_exceed.first != nullptr &&
      parameter(c, m.must_exceed.first).low <= parameter(c, m.must_exceed.second).value)
    return false;
  return std::any_of(c.parameters.begin(), c.parameters.end(), [&](const auto& p) {
    const bool counts = &p == &c.parameters.front() || m.from_residual || m.several;
    const double nothing = p.first == "m" || p.first == "n" ? 1.0 : 0.0;
    return counts && (p.second.low > nothing || p.second.high < nothing);
  });
}

/// Cause `i` said with fewer numbers, and all causes' penalised chi² then.
struct Plainer {
  Term term;
  double chi2 = 1e300;
};

/// The plainer law that it becomes at an end of its range, another name of its shape, or its own
/// law with fewer numbers: whichever fits best. None for those that have none.
std::optional<Plainer> plainer_of(const CauseSearch& search, std::size_t i) {
  const View& v = search.step.view;
  const Term& term = search.causes[i];
  const Mechanism& m = mechanism_of(term);
  std::vector<Term> begin;
  const auto add_law = [&](const char* name) {
    const int at = name != nullptr ? known_mechanism(name) : -1;
    for (std::size_t c = 0; c < search.causes.size(); ++c)
      if (at < 0 || (c != i && law_of(search.causes[c].mechanism) == law_of(at))) return;
    for (auto& shape : starts(mechanism_at(at), *v.scene)) begin.push_back({at, shape});
  };
  add_law(m.plainer);
  add_law(m.same_as ? m.same_as(term.shape) : nullptr);
  if (m.simpler)
    if (auto shape = m.simpler(term.shape); !shape.empty())
      begin.push_back({term.mechanism, std::move(shape)});
  TermFits fits(v);
  std::optional<Plainer> best;
  for (const auto& start : begin) {
    auto causes = search.causes;
    causes[i] = start;
    if (const double chi2 = penalised_chi2(fits, causes); !best || chi2 < best->chi2)
      best = Plainer{start, chi2};
  }
  if (!best) return best;
  auto causes = search.causes;
  causes[i] = best->term;
  causes = refine(fits, causes, 1);
  return Plainer{causes[i], penalised_chi2(fits, causes)};
}

/// Puts it in the place of cause `i`, for good.
void put_plainer(CauseSearch& search, std::size_t i, const Plainer& plainer) {
  if (search.causes[i].mechanism != plainer.term.mechanism)
    search.barred.push_back(search.causes[i].mechanism);
  search.causes[i] = plainer.term;
}

void take_out(CauseSearch& search, std::vector<Cause>& causes, std::size_t i) {
  // worse by it: it is there in some sessions only
  search.doubted_percent =
      std::max(search.doubted_percent, std::fabs(causes[i].gain_percent.value));
  const auto at = static_cast<std::ptrdiff_t>(i);
  causes.erase(causes.begin() + at);
  search.causes.erase(search.causes.begin() + at);
  search.p_values.erase(search.p_values.begin() + at);
  look_again(search);
  for (std::size_t c = 0; c < causes.size(); ++c) causes[c].term = search.causes[c];
}

}  // namespace

bool prefer_plainer(CauseSearch& search) {
  bool changed = false;
  for (std::size_t i = 0; i < search.causes.size(); ++i) {
    if (mechanism_of(search.causes[i]).plainer == nullptr) continue;
    const auto plainer = plainer_of(search, i);
    if (!plainer) continue;
    auto others = search.causes;
    others.erase(others.begin() + static_cast<std::ptrdiff_t>(i));
    TermFits fits(search.step.view);
    const double own = penalised_chi2(fits, search.causes),
                 earned = penalised_chi2(fits, others) - own;
    if (plainer->chi2 - own > within_alias(earned, search.step.judgement.inflation)) continue;
    put_plainer(search, i, *plainer);
    changed = true;
  }
  return changed;
}

bool take_back(CauseSearch& search, std::vector<Cause>& causes, const Step& first,
               bool by_plainer) {
  bool changed = false;
  while (!causes.empty()) {
    Explanation now;
    now.causes = causes;
    set_parameters(now, search.step.view, search.step.null, search.step.judgement.inflation);
    const auto gains = gain_of_each(first.view, search.causes, search.step.view.spread);
    std::size_t worst = causes.size();
    std::optional<Plainer> plainer;
    for (std::size_t i = 0; i < causes.size(); ++i) {
      now.causes[i].gain_percent = gains[i].percent;
      now.causes[i].by_fold_percent = gains[i].by_fold_percent;
      if (is_signed(now.causes[i], *search.step.view.scene) &&
          gains[i].percent.low > k_min_low_percent && gains[i].percent.value > k_min_gain_percent)
        continue;
      if (auto in_place = plainer || !by_plainer ? std::nullopt : plainer_of(search, i))
        worst = i, plainer = in_place;  // what stands in its place may need the others
      if (!plainer &&
          (worst == causes.size() || gains[i].percent.value < gains[worst].percent.value))
        worst = i;
    }
    causes = now.causes;
    if (worst == causes.size()) break;
    if (plainer) {
      put_plainer(search, worst, *plainer);
      look_again(search);
      for (std::size_t i = 0; i < causes.size(); ++i) causes[i].term = search.causes[i];
      causes[worst].aliases.clear();
      changed = true;
      continue;
    }
    take_out(search, causes, worst);
  }
  return changed;
}

bool drop_unlikely(CauseSearch& search, Explanation& e) {
  set_probabilities(e);
  const auto rank = [](const Cause& c) {
    return std::pair(c.set_probability, c.gain_percent.value);
  };  // of equals, what helps least
  const auto least =
      std::min_element(e.causes.begin(), e.causes.end(),
                       [&](const Cause& a, const Cause& b) { return rank(a) < rank(b); });
  if (least == e.causes.end() || least->set_probability >= k_likely_enough) return false;
  take_out(search, e.causes, static_cast<std::size_t>(least - e.causes.begin()));
  return true;
}

bool is_doubted(const CauseSearch& search) { return search.doubted_percent > k_min_gain_percent; }

}  // namespace cavum::explain
