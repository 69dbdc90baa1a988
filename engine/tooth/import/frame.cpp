#include "engine/tooth/import/frame.h"

#include <cmath>

#include "engine/base/det_math.h"
#include "engine/base/error.h"
#include "engine/tooth/import/import_error.h"

namespace cavum {
namespace {

Vec3 unit(Vec3 v, const char* name) {
  if (!is_finite(v) || !(length(v) > 1e-9))
    throw Error(ImportError::bad_option, Name{name}, msg("is not a direction"),
                msg("give three numbers, not all zero, such as 0,0,1"));
  return normalized(v);
}

}  // namespace

ToothAxes tooth_axes(Vec3 dentin_centroid, Vec3 enamel_centroid, const FrameOptions& options) {
  ToothAxes out;
  if (!options.occlusal_axis && !(length(enamel_centroid - dentin_centroid) > 1e-6))
    throw Error(msg("frame"),
                msg("enamel and dentin have the same centroid, so there is no occlusal direction"),
                msg("give --occlusal-axis x,y,z"));
  const Vec3 z = options.occlusal_axis ? unit(*options.occlusal_axis, "--occlusal-axis")
                                       : normalized(enamel_centroid - dentin_centroid);
  const bool x_is_upright = std::fabs(z.x) > 0.9;
  const Vec3 wish = options.mesial_axis ? unit(*options.mesial_axis, "--mesial-axis")
                    : x_is_upright      ? Vec3{0, 1, 0}
                                        : Vec3{1, 0, 0};
  const Vec3 across = wish - z * dot(z, wish);
  if (!(length(across) > 0.05))
    throw Error(ImportError::bad_option, Name{"--mesial-axis"}, msg("runs along the occlusal axis"),
                msg("give a direction across the tooth"));
  Vec3 x = normalized(across);
  const auto turn = det_sincos(options.rotate_deg * k_pi / 180.0);
  if (!std::isfinite(options.rotate_deg) || std::fabs(options.rotate_deg) > 3600)
    throw Error("--rotate-deg", msg("is not an angle"), msg("give degrees"));
  x = normalized(x * turn.cos + cross(z, x) * turn.sin);
  using By = SourceFrame::Mesial;
  out.source = {options.occlusal_axis.has_value(), z,
                options.mesial_axis ? By::given
                : x_is_upright      ? By::file_y
                                    : By::file_x,
                x};
  const Vec3 y = cross(z, x);
  out.axes = {x, options.mirror ? -y : y, z};
  return out;
}

}  // namespace cavum
