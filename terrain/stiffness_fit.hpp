#pragma once
#include <array>
#include <cstdint>
#include <optional>

#include "config/fields.hpp"
#include "terrain/joint_config.hpp"
#include "terrain/profile_config.hpp"

// Stiffness of the ground from force and depth: F = F0 + k z by (weighted) least squares. The cycle
// accumulates it recursively in bounded memory; it is solved afterwards. The standard error accounts for the
// residuals' autocorrelation without choosing a bandwidth. With the scores s_i = w_i x_i e_i, whose sum is
// zero,
//   S = -(1/n) sum_ij |i - j| s_i s_j^T
// (Bartlett kernel over the whole sample; Kiefer, Vogelsang & Bunzel 2000), and the interval uses that
// statistic's own distribution instead of the normal one.
namespace sandhopper {

// Samples of a stance that are used.
enum class SampleWindow : std::uint8_t {
  penetrating,   // contact to greatest depth, foot faster than min_speed downward
  new_depth,     // only samples at a depth never reached before
  to_max_depth,  // everything from contact to greatest depth
  whole_stance,  // everything from contact to liftoff
  compression    // everything from contact to the stance switch
};
template <>
struct EnumNames<SampleWindow> {
  static constexpr std::array<std::string_view, 5> value{"penetrating", "new_depth", "to_max_depth",
                                                         "whole_stance", "compression"};
};

// Acceleration weights: s = 1/(1 + exp(-slope (|zdd| - threshold))), sigma = good + (bad - good) s, w =
// 1/sigma^2.
struct WeightConfig {
  double sigma_good_N = 1.0;
  double sigma_bad_N = 10.0;
  double threshold_mps2 = 6.0;  // a0, at which s = 1/2
  double slope_s2_per_m = 1.0;  // k

  template <class Self, class Visitor>
  static constexpr void fields(Self& self, Visitor&& visit) {
    visit("sigma_good_N", self.sigma_good_N, Range{1e-3, 1e3});
    visit("sigma_bad_N", self.sigma_bad_N, Range{1e-3, 1e4});
    visit("threshold_mps2", self.threshold_mps2, Range{0.0, 1e3});
    visit("slope_s2_per_m", self.slope_s2_per_m, Range{1e-3, 1e3});
  }
};

double acceleration_weight(const WeightConfig& config, double accel_magnitude_mps2) noexcept;

struct StiffnessConfig {
  SampleWindow window = SampleWindow::penetrating;
  bool free_intercept = true;
  double min_speed_mps = 0.03;
  double contact_force_N = 1.5;  // direct force above which first contact is detected
  int min_samples = 30;
  double min_depth_span_m = 0.005;
  double max_depth_m = 0.050;  // height of the foot: if it is deeper, sand flows over it
  WeightConfig weights{};
  JointConfig joint{};
  std::optional<ProfileConfig> profile{};  // defaults if it is left out

  ProfileConfig profile_or_default() const noexcept { return profile ? *profile : ProfileConfig{}; }

  template <class Self, class Visitor>
  static constexpr void fields(Self& self, Visitor&& visit) {
    visit("window", self.window);
    visit("free_intercept", self.free_intercept);
    visit("min_speed_mps", self.min_speed_mps, Range{0.0, 1.0});
    visit("contact_force_N", self.contact_force_N, Range{0.1, 100.0});
    visit("min_samples", self.min_samples, Range{3, 10000});
    visit("min_depth_span_m", self.min_depth_span_m, Range{0.0, 1.0});
    visit("max_depth_m", self.max_depth_m, Range{0.001, 1.0});
    visit("weights", self.weights);
    visit("joint", self.joint);
    visit("profile", self.profile);
  }
};

// Sums of one regression. Every residual score is a combination of the five products a = w [F, 1, z, z F,
// z^2]; `spread` is sum_i a_i (sum_{j<i} (i - j) a_j)^T.
struct RegressionSums {
  double w = 0.0, wz = 0.0, wzz = 0.0, wf = 0.0, wzf = 0.0;
  double depth_min_m = 0.0, depth_max_m = 0.0;
  std::array<double, 25> spread{};
  std::int32_t samples = 0;
};

struct FitSample {
  double depth_m;
  double force_N;
  double weight;
};

// Adds samples to the sums at constant cost. Never allocates.
class RecursiveRegression {
 public:
  void add(const FitSample& sample) noexcept;
  const RegressionSums& sums() const noexcept { return sums_; }
  void reset() noexcept { *this = {}; }

 private:
  using Products = std::array<double, 5>;
  RegressionSums sums_{};
  Products total_{};     // sum_{j<i} a_j
  Products distance_{};  // sum_{j<i} (i - j) a_j
};

// Reason why a stiffness must not be used; `valid` if there is none.
enum class Validity : std::uint8_t {
  valid,
  no_new_penetration,
  too_few_samples,
  too_shallow,
  deeper_than_foot,
  interval_unbounded,
  not_positive,
  interval_includes_zero,
  saturated
};
template <>
struct EnumNames<Validity> {
  static constexpr std::array<std::string_view, 9> value{
      "valid",        "no_new_penetration",     "too_few_samples",
      "too_shallow",  "deeper_than_foot",       "interval_unbounded",
      "not_positive", "interval_includes_zero", "saturated"};
};

struct StiffnessEstimate {
  double value_N_per_m = 0.0;
  double standard_error_N_per_m = 0.0;
  double ci95_low_N_per_m = 0.0;
  double ci95_high_N_per_m = 0.0;
  double intercept_N = 0.0;
  std::int32_t samples = 0;
  Validity validity = Validity::too_few_samples;

  template <class Self, class Visitor>
  static constexpr void fields(Self& self, Visitor&& visit) {
    visit("value_N_per_m", self.value_N_per_m);
    visit("standard_error_N_per_m", self.standard_error_N_per_m);
    visit("ci95_low_N_per_m", self.ci95_low_N_per_m);
    visit("ci95_high_N_per_m", self.ci95_high_N_per_m);
    visit("intercept_N", self.intercept_N);
    visit("samples", self.samples);
    visit("validity", self.validity);
  }
};

// Two-sided 95 % critical value of |k_est - k| / standard error, with and without an intercept. It holds for
// a depth that increases steadily through the sample and residuals correlated over 1/15 of the sample, which
// is the least correlation in a stance. From a simulation of 40,000 runs, which the unit test repeats. White
// residuals would need 5.84 and 5.75, a normal statistic 1.96.
inline constexpr double kCriticalValueFreeIntercept = 8.11;
inline constexpr double kCriticalValueThroughOrigin = 8.00;

StiffnessEstimate solve_stiffness(const RegressionSums& sums, const StiffnessConfig& config) noexcept;

}  // namespace sandhopper
