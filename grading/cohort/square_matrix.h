// Small matrices with rows of any scale, for the linear models of a class: rows that depend on one
// another to 1 in 10¹⁰ do.
#pragma once

#include <Eigen/LU>
#include <optional>

namespace cavum::cohort {

class ScaledRows {
 public:
  explicit ScaledRows(const Eigen::MatrixXd& a)
      : scale_(a.cwiseAbs().rowwise().maxCoeff().unaryExpr(
            [](double v) { return v > 0 ? 1 / v : 1.0; })),
        lu_(scale_.asDiagonal() * a) {
    lu_.setThreshold(1e-10);
  }
  [[nodiscard]] Eigen::Index rank() const { return lu_.rank(); }
  /// Of a square matrix; nothing when its rows depend on one another.
  [[nodiscard]] std::optional<Eigen::MatrixXd> inverse() const {
    return lu_.isInvertible() ? std::optional<Eigen::MatrixXd>(lu_.inverse() * scale_.asDiagonal())
                              : std::nullopt;
  }

 private:
  Eigen::VectorXd scale_;
  Eigen::FullPivLU<Eigen::MatrixXd> lu_;
};

}  // namespace cavum::cohort
