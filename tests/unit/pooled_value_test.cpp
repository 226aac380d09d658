#include "terrain/pooled_value.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <random>
#include <vector>

#include "terrain/trial_statistics.hpp"

namespace sandhopper {
namespace {

TEST(PooledValue, WithoutErrorsOfTheirOwnIsStudentsInterval) {
  const std::vector<TrialValue> trials{{9.0}, {10.0}, {12.0}, {13.0}};
  const std::vector<double> plain{9.0, 10.0, 12.0, 13.0};
  const auto pooled = pool_trials(trials);
  const auto student = mean_over_trials(plain);
  EXPECT_NEAR(pooled.value, student.value, 1e-9);
  EXPECT_NEAR(pooled.mean_low, student.ci95_low, 1e-3);      // the numerical error of the grid is 4e-5
  EXPECT_GT(pooled.between_sd, student.standard_deviation);  // it is the median of a skewed posterior
  EXPECT_LT(pooled.between_sd, 1.2 * student.standard_deviation);
  const double half = student_t95(3) * student.standard_deviation * std::sqrt(1.25);
  EXPECT_NEAR(pooled.new_high, student.value + half, 1e-3);
}

TEST(PooledValue, OneTrialDoesNotTellOfAnother) {
  const std::vector<TrialValue> one{{5.0, 0.1}, {NAN, 0.1}};
  const auto pooled = pool_trials(one);
  EXPECT_EQ(pooled.trials, 1u);
  EXPECT_EQ(pooled.value, 5.0);
  EXPECT_TRUE(std::isinf(pooled.mean_high));
  EXPECT_TRUE(std::isinf(pooled.new_low));
  EXPECT_TRUE(std::isnan(pool_trials({}).value));
}

TEST(PooledValue, EqualTrialsHaveNoWidth) {
  const std::vector<TrialValue> equal{{4.0}, {4.0}, {4.0}};
  const auto pooled = pool_trials(equal);
  EXPECT_EQ(pooled.value, 4.0);
  EXPECT_EQ(pooled.mean_low, 4.0);
  EXPECT_EQ(pooled.new_high, 4.0);
}

TEST(PooledValue, AnErrorThatAllTrialsShareDoesNotAverageOut) {
  std::vector<TrialValue> many(100, TrialValue{10.0, 0.01});
  const auto pooled = pool_trials(many, 0.05);
  EXPECT_NEAR(pooled.mean_high - 10.0, 1.959964 * 0.5, 0.01);
}

// Share of 1,000 sets of trials whose interval contains the mean, and the true value of a further trial.
struct Coverage {
  double mean, further;
};
Coverage coverage(std::size_t trials, double between, double own) {
  std::mt19937_64 random(1);
  std::normal_distribution<double> normal;
  int held = 0, held_further = 0;
  constexpr int kSets = 1000;
  for (int set = 0; set < kSets; ++set) {
    std::vector<TrialValue> values;
    for (std::size_t i = 0; i < trials; ++i) {
      const double sd = own * (1.0 + static_cast<double>(i % 3));
      values.push_back({100.0 + between * normal(random) + sd * normal(random), sd});
    }
    const auto pooled = pool_trials(values);
    const double further = 100.0 + between * normal(random);
    held += pooled.mean_low <= 100.0 && 100.0 <= pooled.mean_high;
    held_further += pooled.new_low <= further && further <= pooled.new_high;
  }
  return {static_cast<double>(held) / kSets, static_cast<double>(held_further) / kSets};
}

// The standard deviation of such a share is 0.007.
TEST(PooledValue, IntervalsHoldWhatTheySayWhereTrialsDiffer) {
  for (const std::size_t trials : {3u, 12u})
    for (const double own : {0.0, 1.0}) {
      const auto held = coverage(trials, 10.0, own);
      EXPECT_NEAR(held.mean, 0.95, 0.025) << trials << " trials, own " << own;
      EXPECT_NEAR(held.further, 0.95, 0.025) << trials << " trials, own " << own;
    }
}

// If the errors of the trials are as large as the difference between trials, the interval of a new trial may
// be too wide, but never too narrow.
TEST(PooledValue, IntervalsStillHoldWhereTrialsAreUnsure) {
  for (const double own : {5.0, 10.0}) {
    const auto held = coverage(12, 10.0, own);
    EXPECT_GT(held.mean, 0.93) << own;
    EXPECT_GT(held.further, 0.93) << own;
    EXPECT_LT(held.mean, 0.995) << own;
  }
}

}  // namespace
}  // namespace sandhopper
