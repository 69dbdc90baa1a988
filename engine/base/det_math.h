// Sine, cosine, arc tangent, exp, log, powers and tanh from arithmetic and square roots alone: libm
// gives different bits on different machines, and a replay must not. Used where the engine itself
// needs them (sampling of a bur, run-out, friction).
#pragma once

#include <bit>
#include <cmath>
#include <cstdint>

namespace cavum {

inline constexpr double k_pi = 3.14159265358979323846;

struct SinCos {
  double sin = 0.0, cos = 1.0;
};

/// sin and cos of `angle_rad`, |angle| up to 1e6; error below 1e-12 (Taylor polynomials on [-pi/4,
/// pi/4]).
[[nodiscard]] constexpr SinCos det_sincos(double angle_rad) noexcept {
  const double turns = angle_rad / (k_pi / 2);
  const auto quadrant = static_cast<std::int64_t>(turns + (turns >= 0 ? 0.5 : -0.5));
  // pi/2 in two parts, so that the reduction keeps its digits
  const double n = static_cast<double>(quadrant);
  const double a = (angle_rad - n * 1.57079632673412561417e+00) - n * 6.07710050650619224932e-11;
  const double a2 = a * a;
  const double s =
      a * (1 + a2 * (-1.0 / 6 +
                     a2 * (1.0 / 120 +
                           a2 * (-1.0 / 5040 + a2 * (1.0 / 362880 + a2 * (-1.0 / 39916800 +
                                                                          a2 / 6227020800.0))))));
  const double c =
      1 + a2 * (-0.5 + a2 * (1.0 / 24 +
                             a2 * (-1.0 / 720 +
                                   a2 * (1.0 / 40320 + a2 * (-1.0 / 3628800 + a2 / 479001600.0)))));
  switch (static_cast<std::uint64_t>(quadrant) & 3u) {
    case 0:
      return {s, c};
    case 1:
      return {c, -s};
    case 2:
      return {-s, -c};
    default:
      return {-c, s};
  }
}

/// e^x; x is clamped to -700..700, relative error below 1e-14 (x = n·ln 2 + r, Taylor polynomial
/// for |r| <= 0.35).
[[nodiscard]] constexpr double det_exp(double x) noexcept {
  x = x > 700.0 ? 700.0 : x > -700.0 ? x : -700.0;  // NaN gives e^-700
  const double turns = x * 1.44269504088896340736;
  const auto whole = static_cast<std::int64_t>(turns + (turns >= 0 ? 0.5 : -0.5));
  // ln 2 in two parts, so that the reduction keeps its digits
  const double n = static_cast<double>(whole);
  const double r = (x - n * 6.93147180369123816490e-01) - n * 1.90821492927058770002e-10;
  double e = 1.0;
  for (int i = 13; i > 0; --i) e = 1.0 + e * (r / i);
  return e * std::bit_cast<double>(static_cast<std::uint64_t>(whole + 1023) << 52);
}

/// ln x for x > 0, error below 1e-14 of max(1, |ln x|) (x = m·2^e with m in [1/√2, √2], series of
/// the inverse hyperbolic tangent). -745 for x <= 0 and below the smallest normal number.
[[nodiscard]] constexpr double det_log(double x) noexcept {
  if (!(x >= 2.2250738585072014e-308)) return -745.0;
  const auto bits = std::bit_cast<std::uint64_t>(x);
  auto exponent = static_cast<std::int64_t>((bits >> 52) & 0x7ff) - 1023;
  double m = std::bit_cast<double>((bits & 0xfffffffffffffULL) | (1023ULL << 52));
  if (m > 1.41421356237309504880) {
    m *= 0.5;
    ++exponent;
  }
  const double s = (m - 1.0) / (m + 1.0), s2 = s * s;
  double sum = 0.0;
  for (int i = 19; i > 0; i -= 2) sum = 1.0 / i + s2 * sum;
  const double n = static_cast<double>(exponent);
  return n * 6.93147180369123816490e-01 + (2.0 * s * sum + n * 1.90821492927058770002e-10);
}

/// x^p for x >= 0; 0 for x <= 0 (p > 0 is meant).
[[nodiscard]] constexpr double det_pow(double x, double p) noexcept {
  return x > 0.0 ? det_exp(p * det_log(x)) : 0.0;
}

/// tanh x, odd to the last bit, relative error below 1e-14 (Lambert's continued fraction up to 0.6,
/// exp beyond).
[[nodiscard]] constexpr double det_tanh(double x) noexcept {
  const double size = x < 0 ? -x : x;
  if (size <= 0.6) {
    const double x2 = x * x;
    double below = 17.0;
    for (int i = 15; i > 0; i -= 2) below = i + x2 / below;
    return x / below;
  }
  const double e = size < 20.0 ? det_exp(-2.0 * size) : 0.0;
  const double t = (1.0 - e) / (1.0 + e);
  return x < 0 ? -t : t;
}

/// Angle whose tangent is `t`, degrees; error below 1e-9. Halved three times, tan(a/2) = t / (1 +
/// sqrt(1 + t²)), then a series of few terms.
[[nodiscard]] inline double atan_deg(double t) noexcept {
  const double a = t < 0 ? -t : t;
  double x = a > 1 ? 1 / a : a;
  for (int i = 0; i < 3; ++i) x = x / (1 + std::sqrt(1 + x * x));
  const double q = x * x;
  double angle =
      8 * x * (1 - q * (1.0 / 3 - q * (1.0 / 5 - q * (1.0 / 7 - q * (1.0 / 9 - q / 11)))));
  if (a > 1) angle = k_pi / 2 - angle;
  return (t < 0 ? -angle : angle) * 180 / k_pi;
}

/// Direction of (x, y) from +x towards +y, -180 to 180 degrees; 0 for (0, 0).
[[nodiscard]] inline double direction_deg(double x, double y) noexcept {
  if (x > 0) return atan_deg(y / x);
  if (x < 0) return atan_deg(y / x) + (y < 0 ? -180 : 180);
  return y > 0 ? 90 : y < 0 ? -90 : 0;
}

}  // namespace cavum
