#include "engine/lab/scan/rigid.h"

#include <Eigen/Dense>

namespace cavum {

std::optional<Rigid> PlaneSteps::solve() const {
  using Matrix = Eigen::Matrix<double, 6, 6>;
  if (!(weight_ > 0.0)) return std::nullopt;
  Matrix a;
  Eigen::Matrix<double, 6, 1> b;
  std::size_t k = 0;
  for (int i = 0; i < 6; ++i) {
    for (int j = 0; j <= i; ++j, ++k) a(i, j) = a(j, i) = normal_[k];
    b(i) = right_[static_cast<std::size_t>(i)];
  }
  // a motion that the planes leave open (a ball turns freely) stays where it is instead of running
  // away
  constexpr double k_held = 1e-6;
  a.diagonal().array() += k_held * weight_;
  const Eigen::LDLT<Matrix> factors(a);
  if (factors.info() != Eigen::Success || !factors.isPositive()) return std::nullopt;
  const Eigen::Matrix<double, 6, 1> x = factors.solve(b);
  if (!x.allFinite()) return std::nullopt;
  const Mat3 turn = rotation(normalized(Quat{1.0, 0.5 * x(0), 0.5 * x(1), 0.5 * x(2)}));
  const Vec3 along{x(3), x(4), x(5)};
  return Rigid{turn, middle_mm_ + along - turn * middle_mm_};
}

}  // namespace cavum
