// How wrong a speed taken from fine positions can be: a smoother that lets the speed walk at random
// doubts a smooth motion too much.
#pragma once

#include <span>
#include <vector>

namespace cavum::explain {

/// Speed at a row and how far off it may be, mm/s; an infinite error where the positions do not
/// say.
struct Slope {
  double mm_s = 0, error_mm_s = 0;
};

/// Slope of the polynomial through the five nearest positions. Its error, from those through three
/// and seven within three rows: where the motion is smooth what five and seven differ by, where its
/// acceleration jumps twice what three and five do, infinite where its speed jumps (or nothing but
/// noise is there). `t_s` ascending; both of one length, which the result has. Source: a difference
/// of two orders estimates the error of the lower (Dahlquist and Björck, Numerical Methods in
/// Scientific Computing, 2008, 3.3).
[[nodiscard]] std::vector<Slope> slopes(std::span<const double> t_s, std::span<const double> x_mm);

}  // namespace cavum::explain
