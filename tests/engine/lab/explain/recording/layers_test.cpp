#include "engine/lab/explain/recording/layers.h"

#include <gtest/gtest.h>

#include "engine/lab/explain/inference/explain.h"
#include "tests/engine/lab/explain/made_recording.h"

namespace cavum::explain {
namespace {

/// Sessions 4 to 6 in a tissue of half the stiffness and damping.
Recording two_layers() {
  Recording r = made::recording({});
  Series layer = Series::Zero(r.rows());
  for (std::size_t s = 3; s < 6; ++s) {
    const auto& a = r.sessions[s];
    layer.segment(a.begin, a.end - a.begin) = 1.0;
  }
  const Recording same = made::recording({}, [](const made::Row& q) { return -0.5 * q.base_n; });
  const Eigen::Index half = r.sessions[3].begin;
  r.f_n.tail(r.rows() - half) = same.f_n.tail(r.rows() - half);
  r.columns.emplace_back("layer", layer);
  return r;
}

TEST(Layers, EachHasItsOwnStiffness) {
  Recording r = two_layers();
  set_layers(r);
  ASSERT_EQ(r.relative_k.size(), r.rows());
  const double ratio = r.relative_k.minCoeff() / r.relative_k.maxCoeff();
  EXPECT_NEAR(ratio, 0.5, 0.02);
  EXPECT_NEAR(r.relative_c.minCoeff() / r.relative_c.maxCoeff(), 0.5, 0.05);
  const Explanation e = explain(r);
  EXPECT_EQ(e.verdict, Verdict::clean) << english_text(to_text(e));
}

TEST(Layers, WithoutThemTheSameRecordingIsNotClean) {
  const Explanation e = explain(two_layers());
  EXPECT_NE(e.verdict, Verdict::clean) << english_text(to_text(e));
}

TEST(Layers, AlikeLayersAndNoLayersChangeNothing) {
  Recording r = made::recording({});
  set_layers(r);
  EXPECT_EQ(r.relative_k.size(), 0);
  Series layer = Series::Zero(r.rows());
  layer.tail(r.rows() / 2) = 1.0;
  r.columns.emplace_back("layer", layer);
  set_layers(r);
  EXPECT_EQ(r.relative_k.size(), 0);
}

}  // namespace
}  // namespace cavum::explain
