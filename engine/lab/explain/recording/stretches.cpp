#include "engine/lab/explain/recording/stretches.h"

#include <fmt/core.h>

namespace cavum::explain {
namespace {

/// The row in air nearest to `row`, not further than `reach`; `row` itself where there is none.
Eigen::Index cut_near(const Series& x_mm, Eigen::Index row, Eigen::Index reach) {
  for (Eigen::Index off = 0; off <= reach; ++off)
    for (const Eigen::Index at : {row - off, row + off})
      if (x_mm[at] < 0.0) return at;
  return row;
}

}  // namespace

std::optional<Recording> in_stretches(const Recording& r) {
  if (r.sessions.size() != 1 || r.rows() < k_stretches * k_min_stretch_rows) return {};
  Recording out = r;
  const std::string name = r.sessions[0].name;
  out.sessions.clear();
  Eigen::Index begin = 0;
  for (Eigen::Index i = 1; i <= k_stretches; ++i) {
    const Eigen::Index even = i * r.rows() / k_stretches;
    const Eigen::Index end =
        i == k_stretches ? r.rows() : cut_near(r.x_mm, even, r.rows() / (4 * k_stretches));
    out.sessions.push_back({fmt::format("{}, stretch {}", name, i), begin, end});
    begin = end;
  }
  out.notes.emplace_back(
      "stretches", std::vector{"stretches"},
      msg("one session alone: {} stretches of it are taken as sessions; several sessions tell more",
          k_stretches));
  return out;
}

}  // namespace cavum::explain
