// Whether a scan shows the tooth that it is laid upon: what of its surface lies on the tooth, and
// what beside it.
#pragma once

#include <string>
#include <vector>

#include "engine/base/named_enum.h"
#include "engine/lab/scan/outer_surface.h"
#include "engine/lab/scan/rigid.h"

namespace cavum {

#define CAVUM_SCAN_ERRORS(ERROR) ERROR(another_tooth) ERROR(crown_not_seen)
CAVUM_NAMED_ENUM(ScanError, CAVUM_SCAN_ERRORS)

/// Shares are of area, 0..1. `within_mm`: three standard deviations of the noise, 0.03 mm at least.
struct ScanFit {
  double noise_mm = 0.0;   ///< standard deviation of the distance where it fits, by the median
  double rms_mm = 0.0;     ///< of the distance where it fits
  double form_mm = 0.0;    ///< the same of the mean distances of patches of 0.7 mm, in which noise
                           ///< averages out: how far the form differs
  double within_mm = 0.0;  ///< up to which a place fits
  double fits = 0.0;       ///< of the scan: on the tooth's surface
  double beyond = 0.0;     ///< of the scan: outside the tooth, where no drill leaves a surface
  double shallow = 0.0;  ///< of the scan: inside, no deeper than 0.3 mm: the rim of a cavity has a
                         ///< little of it, another tooth much
  double deep = 0.0;  ///< of the scan: deeper inside, or facing another way: cavity, or where the
                      ///< scan was closed or cut off
  double crown_seen = 0.0;  ///< of the tooth's enamel surface: the scan lies there
};

/// `scan`: its points, in any frame.
[[nodiscard]] ScanFit fit_of(const std::vector<SurfacePoint>& scan, const Rigid& to_tooth,
                             const OuterSurface& tooth);

/// Of the surface that should fit, the share that does: what lies deep inside is left out.
[[nodiscard]] inline double agreement(const ScanFit& f) noexcept {
  const double all = f.fits + f.beyond + f.shallow;
  return all > 0 ? f.fits / all : 0.0;
}

/// Whether the surface that should fit does.
[[nodiscard]] bool fits_tooth(const ScanFit& fit) noexcept;

/// Throws Error(`where`, ...) saying what was found when the scan cannot be of this tooth, or shows
/// too little of its crown.
void require_same_tooth(const ScanFit& fit, const std::string& where);

}  // namespace cavum
