#include "engine/tooth/import/thresholds.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "engine/base/error.h"
#include "engine/base/order.h"
#include "engine/tooth/import/import_error.h"

namespace cavum {
namespace {

constexpr int k_bins = 256;

struct Peak {
  int bin;
  double height, mass;
};

std::vector<double> smoothed(std::vector<double> h) {
  for (int pass = 0; pass < 3; ++pass) {
    std::vector<double> out(h.size(), 0.0);
    for (int i = 0; i < k_bins; ++i)
      for (int d = -2; d <= 2; ++d)
        out[static_cast<std::size_t>(i)] +=
            h[static_cast<std::size_t>(std::clamp(i + d, 0, k_bins - 1))] / 5;
    h = out;
  }
  return h;
}

/// Peaks that stand clear: the valley to a higher neighbour is under 80 % of the peak, and it holds
/// at least 0.3 % of all.
std::vector<Peak> clear_peaks(const std::vector<double>& h) {
  double all = 0.0;
  for (const double v : h) all += v;
  std::vector<int> tops;
  for (int i = 0; i < k_bins; ++i) {
    const double left = i > 0 ? h[static_cast<std::size_t>(i - 1)] : -1.0,
                 right = i + 1 < k_bins ? h[static_cast<std::size_t>(i + 1)] : -1.0;
    if (h[static_cast<std::size_t>(i)] > left && h[static_cast<std::size_t>(i)] >= right &&
        h[static_cast<std::size_t>(i)] > 0)
      tops.push_back(i);
  }
  const auto valley = [&](int a, int b) {
    int low = a;
    for (int i = a; i <= b; ++i)
      if (h[static_cast<std::size_t>(i)] < h[static_cast<std::size_t>(low)]) low = i;
    return low;
  };
  for (bool merged = true; merged && tops.size() > 1;) {  // the least distinct pair first
    merged = false;
    std::size_t worst = 0;
    double highest = 0.8;
    for (std::size_t i = 0; i + 1 < tops.size(); ++i) {
      const double low = h[static_cast<std::size_t>(valley(tops[i], tops[i + 1]))];
      const double ratio = low / std::min(h[static_cast<std::size_t>(tops[i])],
                                          h[static_cast<std::size_t>(tops[i + 1])]);
      if (ratio > highest) {
        highest = ratio;
        worst = i;
        merged = true;
      }
    }
    if (merged)
      tops.erase(tops.begin() +
                 static_cast<std::ptrdiff_t>(h[static_cast<std::size_t>(tops[worst])] <
                                                     h[static_cast<std::size_t>(tops[worst + 1])]
                                                 ? worst
                                                 : worst + 1));
  }
  std::vector<Peak> peaks;
  for (std::size_t i = 0; i < tops.size(); ++i) {
    const int from = i == 0 ? 0 : valley(tops[i - 1], tops[i]),
              to = i + 1 == tops.size() ? k_bins - 1 : valley(tops[i], tops[i + 1]);
    Peak p{tops[i], h[static_cast<std::size_t>(tops[i])], 0.0};
    for (int b = from; b <= to; ++b) p.mass += h[static_cast<std::size_t>(b)];
    if (p.mass >= 0.003 * all) peaks.push_back(p);
  }
  return peaks;
}

/// Gray of the border of the volume: the medium around the tooth.
double medium_gray(const Volume& v) {
  std::vector<float> border;
  for (std::int32_t z = 0; z < v.size.z; ++z)
    for (std::int32_t y = 0; y < v.size.y; ++y)
      for (std::int32_t x = 0; x < v.size.x; ++x)
        if (x == 0 || y == 0 || z == 0 || x == v.size.x - 1 || y == v.size.y - 1 ||
            z == v.size.z - 1)
          border.push_back(v.gray[v.index({x, y, z})]);
  return quantile(std::move(border), 0.5);
}

}  // namespace

GrayLevels find_gray_levels(const Volume& volume, const ThresholdOptions& options,
                            const std::string& where) {
  GrayLevels out;
  if (options.dentin && options.enamel) {
    if (!(*options.dentin < *options.enamel))
      throw Error(ImportError::bad_option, Name{"--enamel-threshold"},
                  msg("is not above --dentin-threshold"), msg("enamel is the brighter tissue"));
    out.hard = out.enamel_surface = out.pulp_surface = *options.dentin;
    out.enamel = *options.enamel;
    return out;
  }
  const double low = quantile(volume.gray, 0.0005), high = quantile(volume.gray, 0.9995);
  if (!(high > low))
    throw Error(ImportError::no_tooth, Name{where}, msg("every voxel has the same gray"),
                msg("give a volume that shows a tooth"));
  // Never narrower than one step of whole-numbered gray, or the histogram would be a comb.
  const bool whole_gray = std::all_of(volume.gray.begin(), volume.gray.end(),
                                      [](float g) { return g == std::floor(g); });
  const double bin_width = std::max((high - low) / k_bins, whole_gray ? 1.0 : 0.0),
               alike = 0.12 * (high - low);
  std::vector<double> histogram(k_bins, 0.0);
  const IVec3 steps[3] = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
  for (std::int32_t z = 1; z + 1 < volume.size.z; ++z)
    for (std::int32_t y = 1; y + 1 < volume.size.y; ++y)
      for (std::int32_t x = 1; x + 1 < volume.size.x; ++x) {
        const IVec3 at{x, y, z};
        bool flat = true;
        for (const IVec3 s : steps)
          flat = flat && std::fabs(volume.gray[volume.index(at + s)] -
                                   volume.gray[volume.index(at - s)]) < alike;
        if (!flat) continue;
        const double bin = (volume.gray[volume.index(at)] - low) / bin_width;
        histogram[static_cast<std::size_t>(std::clamp(bin, 0.0, k_bins - 1.0))] += 1;
      }
  const auto peaks = clear_peaks(smoothed(histogram));
  const auto gray = [&](const Peak& p) { return low + (p.bin + 0.5) * bin_width; };
  const double border = medium_gray(volume);
  const auto medium =
      std::min_element(peaks.begin(), peaks.end(), [&](const Peak& a, const Peak& b) {
        return std::fabs(gray(a) - border) < std::fabs(gray(b) - border);
      });
  const auto hard_peaks = peaks.end() - medium - 1;
  if (peaks.empty() || hard_peaks < 2)
    throw Error(
        ImportError::no_tooth, Name{where},
        msg("no tooth found: fewer than two tissues stand out brighter than the medium (gray {})",
            static_cast<int>(border)),
        msg("check the volume, or give --dentin-threshold and --enamel-threshold"));
  const Peak& enamel = peaks.back();
  const auto dentin = std::max_element(
      medium + 1, peaks.end() - 1, [](const Peak& a, const Peak& b) { return a.mass < b.mass; });
  // The pulp's own gray, where it is darker than the medium (dry teeth); otherwise it looks like
  // the medium.
  const double pulp =
      medium != peaks.begin()
          ? gray(*std::max_element(peaks.begin(), medium,
                                   [](const Peak& a, const Peak& b) { return a.mass < b.mass; }))
          : gray(*medium);
  out.hard = options.dentin.value_or((gray(*medium) + gray(*dentin)) / 2);
  out.enamel = options.enamel.value_or((gray(*dentin) + gray(enamel)) / 2);
  if (!(out.hard < out.enamel))
    throw Error(ImportError::bad_option, Name{"--enamel-threshold"},
                msg("is not above the dentin threshold {}", as_number(out.hard)),
                msg("enamel is the brighter tissue"));
  out.enamel_surface = options.dentin ? out.hard : (gray(*medium) + gray(enamel)) / 2;
  out.pulp_surface = options.dentin ? out.hard : (pulp + gray(*dentin)) / 2;
  if (medium != peaks.begin()) out.dark = (pulp + gray(*medium)) / 2;
  out.peaks = GrayPeaks{gray(*medium), pulp, gray(*dentin), gray(enamel)};
  return out;
}

}  // namespace cavum
