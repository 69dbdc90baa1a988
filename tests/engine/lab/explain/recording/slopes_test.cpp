#include "engine/lab/explain/recording/slopes.h"

#include <gtest/gtest.h>

#include <cmath>

namespace cavum::explain {
namespace {

struct Path {
  std::vector<double> t, x;
};

/// 60 instants 0.01 s apart, each of them early or late by `jitter_s` at most, as a recorder's.
Path path(const std::function<double(double)>& x, double jitter_s = 0.0) {
  Path p;
  for (int i = 0; i < 60; ++i) {
    p.t.push_back(0.01 * i + jitter_s * std::sin(1.7 * i));
    p.x.push_back(x(p.t.back()));
  }
  return p;
}

TEST(Slopes, FindsNothingWrongWithAParabolaAtUnevenInstants) {
  const Path p = path([](double t) { return t * t; }, 0.002);
  const auto s = slopes(p.t, p.x);
  for (std::size_t i = 0; i < s.size(); ++i) {
    EXPECT_NEAR(s[i].mm_s, 2.0 * p.t[i], 1e-9);
    EXPECT_LT(s[i].error_mm_s, 1e-9);
  }
}

TEST(Slopes, GivesTheErrorOfTheFivePointFormulaWhereTheMotionIsSmooth) {
  const double w = 60.0;  // ten rows in a turn: the formula is off by x^(5) h^4/30
  const Path p = path([&](double t) { return std::sin(w * t); });
  const double off = std::pow(w, 5.0) * std::pow(0.01, 4.0) / 30.0;
  for (std::size_t i = 10; i < 50; ++i) {
    const double e = slopes(p.t, p.x)[i].error_mm_s;
    EXPECT_GT(e, off) << i;
    EXPECT_LT(e, 3.0 * off) << i;
  }
}

TEST(Slopes, CoversWhatAJumpOfTheAccelerationDoesToASlope) {
  // at rest, then 1 mm/s²: from a row on, or from between two
  const double h = 0.01;
  const auto error = [](double from) {
    const Path p = path([&](double t) { return t < from ? 0.0 : 0.5 * (t - from) * (t - from); });
    return slopes(p.t, p.x);
  };
  EXPECT_GT(error(0.3)[30].error_mm_s, 0.14 * h) << "a cubic spline";
  EXPECT_LT(error(0.3)[30].error_mm_s, 0.5 * h);
  EXPECT_GT(error(0.305)[30].error_mm_s, h / 96.0) << "five points";
  EXPECT_LT(error(0.305)[30].error_mm_s, 0.5 * h);
  EXPECT_LT(error(0.3)[20].error_mm_s, 1e-9);
}

TEST(Slopes, SaysNothingWhereTheSpeedJumps) {
  const Path p = path([](double t) { return std::fabs(t - 0.3); });
  const auto e = slopes(p.t, p.x);
  for (std::size_t i = 27; i <= 33; ++i) EXPECT_TRUE(std::isinf(e[i].error_mm_s)) << i;
  EXPECT_LT(e[20].error_mm_s, 1e-9);
}

TEST(Slopes, SaysNothingOfSixRows) {
  const std::vector<double> t{0.0, 0.1, 0.2, 0.3, 0.4, 0.5};
  for (const auto& s : slopes(t, t)) EXPECT_TRUE(std::isinf(s.error_mm_s));
}

}  // namespace
}  // namespace cavum::explain
