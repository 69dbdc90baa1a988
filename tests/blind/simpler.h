// What simpler methods say of the same recording: sequentially thresholded least squares, and
// forward selection by BIC. Both regress the frozen residual F − F_sim on a library with one column
// (or two) per mechanism at a typical shape, with k and c beside it: no twins, no joint fit of
// shapes, no aliases.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace cavum::blind {

struct SimplerAnswers {
  std::vector<std::string>
      thresholded;  ///< mechanisms named by sequentially thresholded least squares
  std::vector<std::string> forward_bic;  ///< mechanisms named by forward selection
};

/// Reads `folder`/recording.csv and `folder`/rig.toml as this test writes them.
[[nodiscard]] SimplerAnswers ask_simpler(const std::filesystem::path& folder);

}  // namespace cavum::blind
