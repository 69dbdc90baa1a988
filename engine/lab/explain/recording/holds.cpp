#include "engine/lab/explain/recording/holds.h"

#include <algorithm>
#include <cmath>

namespace cavum::explain {
namespace {

constexpr double k_hold_s = 0.3;
constexpr double k_longer = 1.5;  // than the readings before and after

struct Run {
  Eigen::Index begin = 0, end = 0;
  double lasts_s = 0;
};

std::vector<Run> runs_of(const Recording& r, const SessionRows& s, double q) {
  std::vector<Run> runs;
  for (Eigen::Index i = s.begin, end = i; i < s.end; i = end) {
    while (end < s.end && std::fabs(r.x_mm[end] - r.x_mm[i]) < 0.5 * q) ++end;
    runs.push_back({i, end, r.t_s[end - 1] - r.t_s[i]});
  }
  return runs;
}

/// Longest common subsequence of two programmes over the longer one.
double share_common(const std::vector<long>& a, const std::vector<long>& b) {
  if (a.empty() || b.empty()) return 0.0;
  std::vector<std::size_t> common(b.size() + 1, 0);
  for (const long cell : a) {
    std::size_t diagonal = 0;
    for (std::size_t j = 0; j < b.size(); ++j) {
      const std::size_t above = common[j + 1];
      common[j + 1] = cell == b[j] ? diagonal + 1 : std::max(above, common[j]);
      diagonal = above;
    }
  }
  return static_cast<double>(common.back()) / static_cast<double>(std::max(a.size(), b.size()));
}

}  // namespace

Holds find_holds(const Recording& r, double q) {
  Holds out;
  std::vector<std::vector<long>> programmes;  // cells of the holds in contact, in order
  std::vector<long> cell_of_hold, all;
  for (const auto& s : r.sessions) {
    auto& programme = programmes.emplace_back();
    const auto runs = runs_of(r, s, q);
    for (std::size_t i = 0; i < runs.size(); ++i) {
      const double before_s = i > 0 ? runs[i - 1].lasts_s : 0.0,
                   after_s = i + 1 < runs.size() ? runs[i + 1].lasts_s : 0.0;
      if (runs[i].lasts_s < k_hold_s || runs[i].lasts_s <= k_longer * std::max(before_s, after_s))
        continue;
      const long cell = std::lround(r.x_mm[runs[i].begin] / q);
      out.holds.push_back({runs[i].begin, runs[i].end, 0});
      cell_of_hold.push_back(cell);
      all.push_back(cell);
      if (cell > 0) programme.push_back(cell);
    }
  }
  std::sort(all.begin(), all.end());
  all.erase(std::unique(all.begin(), all.end()), all.end());
  std::vector<std::size_t> place_of(all.size());
  for (std::size_t i = 0; i < all.size();) {
    const bool two = i + 1 < all.size() && all[i + 1] == all[i] + 1;
    for (std::size_t j = i; j <= i + (two ? 1 : 0); ++j) place_of[j] = out.positions_mm.size();
    out.positions_mm.push_back((static_cast<double>(all[i]) + (two ? 0.5 : 0.0)) * q);
    i += two ? 2 : 1;
  }
  for (std::size_t h = 0; h < out.holds.size(); ++h)
    out.holds[h].place = place_of[static_cast<std::size_t>(
        std::lower_bound(all.begin(), all.end(), cell_of_hold[h]) - all.begin())];
  for (std::size_t i = 1; i < programmes.size(); ++i)
    out.repeated +=
        share_common(programmes[i - 1], programmes[i]) / static_cast<double>(programmes.size() - 1);
  return out;
}

Series replaced_holds(const Recording& r, const Series& x_mm, const Holds& holds, double q,
                      Random& random) {
  const double start = random.uniform(0.0, 1.0), step = random.uniform(-0.5, 0.5);
  std::vector<double> at_mm;
  const double span =
      holds.positions_mm.size() > 1 ? holds.positions_mm.back() - holds.positions_mm.front() : 1.0;
  for (const double x : holds.positions_mm) {
    const double turns = start + step * static_cast<double>(holds.positions_mm.size() - 1) *
                                     (x - holds.positions_mm.front()) / span;
    at_mm.push_back(x + q * (turns - std::round(turns)));
  }
  Series out = x_mm;
  std::size_t next = 0;
  for (const auto& s : r.sessions) {
    const bool any = next < holds.holds.size() && holds.holds[next].begin < s.end;
    if (!any) continue;
    const auto off_at = [&](const Hold& h, Eigen::Index row) { return at_mm[h.place] - x_mm[row]; };
    Eigen::Index from = s.begin;
    double off = off_at(holds.holds[next], holds.holds[next].begin);
    while (true) {
      const bool more = next < holds.holds.size() && holds.holds[next].begin < s.end;
      const Eigen::Index to = more ? holds.holds[next].begin : s.end;
      const double off_to = more ? off_at(holds.holds[next], to) : off;
      double way = 0.0, gone = 0.0;
      const auto stride = [&](Eigen::Index i) {
        return i > s.begin && i < s.end ? std::fabs(x_mm[i] - x_mm[i - 1]) : 0.0;
      };
      for (Eigen::Index i = from; i <= to; ++i) way += stride(i);
      for (Eigen::Index i = from; i < to; ++i) {
        gone += stride(i);
        out[i] += way > 0.0 ? off + (off_to - off) * gone / way : off;
      }
      if (!more) break;
      const Hold& h = holds.holds[next++];
      for (Eigen::Index i = h.begin; i < h.end; ++i) out[i] = at_mm[h.place];
      from = h.end;
      off = off_at(h, h.end - 1);
    }
  }
  return out;
}

}  // namespace cavum::explain
