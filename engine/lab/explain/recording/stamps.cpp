#include "engine/lab/explain/recording/stamps.h"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>

#include "engine/base/order.h"

namespace cavum::explain {
namespace {

constexpr double k_uneven = 0.02;   // scatter of the intervals, relative: below, stamps are even
constexpr double k_smoother = 0.5;  // of the roughness over the stamps as they are
constexpr double k_farthest_rows =
    4;  // from the even stamp, all but one row in a hundred: beyond it rows are missing
constexpr std::size_t k_one_late_in = 100;
constexpr Eigen::Index k_min_stamps = 50;

/// Straight line of the stamps over the number of the row.
Series even_stamps_s(const Recording& r, const SessionRows& rows) {
  const Eigen::Index n = rows.end - rows.begin;
  const Series t = r.t_s.segment(rows.begin, n),
               i = Series::LinSpaced(n, 0.0, static_cast<double>(n - 1)), line = i - i.mean();
  return t.mean() + line * ((line * t).sum() / line.square().sum());
}

/// How far all but one stamp in a hundred are off, at most: a late packet is no missing row.
double farthest_s(const Series& off) {
  std::vector<double> size;
  for (const double d : off) size.push_back(std::fabs(d));
  const std::size_t at = size.size() - 1 - size.size() / k_one_late_in;
  return in_order(std::move(size), at);
}

/// Change of speed from row to row, its median.
double roughness_mm_s(const Series& t, const Series& x) {
  std::vector<double> out;
  for (Eigen::Index i = 1; i + 1 < x.size(); ++i)
    out.push_back(
        std::fabs((x[i + 1] - x[i]) / (t[i + 1] - t[i]) - (x[i] - x[i - 1]) / (t[i] - t[i - 1])));
  return median(std::move(out));
}

}  // namespace

std::optional<Recording> with_even_stamps(const Recording& r) {
  Recording out = r;
  double rough = 0.0, smooth = 0.0, off = 0.0;
  for (const auto& rows : r.sessions) {
    const Eigen::Index n = rows.end - rows.begin;
    if (n < k_min_stamps) return std::nullopt;
    const Series t = r.t_s.segment(rows.begin, n), x = r.x_mm.segment(rows.begin, n),
                 even = even_stamps_s(r, rows);
    const Series dt = t.tail(n - 1) - t.head(n - 1);
    const double mean_s = dt.mean();
    if (std::sqrt((dt - mean_s).square().mean()) < k_uneven * mean_s ||
        farthest_s(t - even) > k_farthest_rows * mean_s)
      return std::nullopt;
    rough += roughness_mm_s(t, x);
    smooth += roughness_mm_s(even, x);
    off = std::max(off, std::sqrt((t - even).square().mean()));
    out.t_s.segment(rows.begin, n) = even;
  }
  if (smooth > k_smoother * rough) return std::nullopt;
  out.notes.emplace_back(
      "uneven_stamps", std::vector{"uneven_by"},
      msg("t_s is uneven by {}, and the motion is smooth only over even stamps: rows were taken as sampled evenly",
          as_unit(1e3 * off, cavum::Unit::ms, k_as_needed)));
  return out;
}

}  // namespace cavum::explain
