#include "engine/lab/explain/model/white_table.h"

#include <stdexcept>

namespace cavum::explain {

Eigen::Index WhiteTable::add_exact(const Eigen::ArrayXd& column) {
  if (!coarse_.empty()) throw std::logic_error("exact columns come first");
  exact_.emplace_back(column.cast<float>());
  return columns() - 1;
}

Eigen::Index WhiteTable::add(const Eigen::ArrayXd& column) {
  constexpr double k_most = 32767.0;
  const double largest = column.size() > 0 ? column.abs().maxCoeff() : 0.0;
  const double step = largest / k_most;
  coarse_.push_back(
      {static_cast<float>(step), step > 0.0 ? Steps((column / step).round().cast<std::int16_t>())
                                            : Steps::Zero(column.size())});
  return columns() - 1;
}

Eigen::MatrixXf WhiteTable::rows(Eigen::Index begin, Eigen::Index count) const {
  Eigen::MatrixXf out(count, columns());
  Eigen::Index at = 0;
  for (const auto& c : exact_) out.col(at++) = c.segment(begin, count).matrix();
  for (const auto& c : coarse_)
    out.col(at++) = (c.steps.segment(begin, count).cast<float>() * c.step).matrix();
  return out;
}

}  // namespace cavum::explain
