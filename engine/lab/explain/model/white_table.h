// The whitened columns of all hypotheses: hundreds of columns of as many rows as the recording has,
// which is most of the memory that explain takes.
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <vector>

namespace cavum::explain {

/// Columns are numbered from 0 as they are added. Exact ones are kept in single precision, the
/// others in 16 bits each: rounded to 1/65,000 of their range, which is noise far below that of any
/// recording.
class WhiteTable {
 public:
  /// Exact columns come before all others. Throws std::logic_error when they do not.
  Eigen::Index add_exact(const Eigen::ArrayXd& column);
  Eigen::Index add(const Eigen::ArrayXd& column);
  [[nodiscard]] Eigen::Index columns() const {
    return static_cast<Eigen::Index>(exact_.size() + coarse_.size());
  }
  /// Rows [begin, begin + count), shape [count, columns].
  [[nodiscard]] Eigen::MatrixXf rows(Eigen::Index begin, Eigen::Index count) const;

 private:
  using Steps = Eigen::Array<std::int16_t, Eigen::Dynamic, 1>;
  struct Coarse {
    float step = 0;
    Steps steps;
  };
  std::vector<Eigen::ArrayXf> exact_;
  std::vector<Coarse> coarse_;
};

/// Rows that are taken out at a time: few enough to stay in the cache, and for single precision to
/// sum up.
inline constexpr Eigen::Index k_white_rows = 512;

}  // namespace cavum::explain
