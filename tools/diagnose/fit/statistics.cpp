#include "tools/diagnose/fit/statistics.hpp"

#include <algorithm>
#include <boost/math/distributions/normal.hpp>
#include <boost/math/distributions/students_t.hpp>
#include <cmath>
#include <cstdint>
#include <random>

namespace sandhopper::diagnose {
namespace {

using StudentT = boost::math::students_t;

double sum(const std::vector<double>& values) {
  double s = 0.0;
  for (const double v : values) s += v;
  return s;
}

}  // namespace

double student_t_two_sided(double t, double nu) {
  if (std::isnan(t)) return 1.0;  // no evidence
  return 2.0 * cdf(complement(StudentT(nu), std::abs(t)));
}

double student_t_quantile(double two_sided, double nu) {
  return quantile(complement(StudentT(nu), 0.5 * two_sided));
}

double normal_quantile(double two_sided) {
  return quantile(complement(boost::math::normal(), 0.5 * two_sided));
}

TrialScatter with_noise(const TrialScatter& between) {
  const double all = kModelTrials + between.degrees_of_freedom;
  return {(kModelTrials + between.degrees_of_freedom * between.ratio) / all, all};
}

TrialScatter scatter_between(std::span<const double> scores, std::span<const double> variances,
                             const Eigen::MatrixXd& covariance) {
  // Scores of trials that determine the estimate alone are zero but for rounding.
  constexpr double kRounding = 1e-9;
  double squares = 0.0, expected = 0.0;
  Eigen::VectorXd weight = Eigen::VectorXd::Zero(covariance.rows());
  for (std::size_t t = 0; t < scores.size(); ++t) {
    const auto i = static_cast<Eigen::Index>(t);
    if (!(covariance(i, i) > kRounding * variances[t])) continue;
    weight[i] = variances[t] / covariance(i, i);
    squares += weight[i] * scores[t] * scores[t];
    expected += variances[t];
  }
  const double spread = weight.dot(covariance.cwiseAbs2() * weight);
  return spread > 0.0 ? TrialScatter{squares / expected, expected * expected / spread} : TrialScatter{};
}

double TrialEvidence::total_information() const { return sum(information); }

double TrialEvidence::size() const {
  const double information_sum = sum(information);
  return information_sum > 0.0 ? sum(score) / information_sum : 0.0;
}

TrialScatter TrialEvidence::scatter() const {
  const auto trials = static_cast<Eigen::Index>(score.size());
  const double information_sum = sum(information), b = size();
  const auto of_trial = Eigen::Map<const Eigen::VectorXd>(information.data(), trials);
  // Scores u_t - b I_t after the fit of b alone.
  std::vector<double> left;
  for (std::size_t t = 0; t < score.size(); ++t) left.push_back(score[t] - b * information[t]);
  Eigen::MatrixXd covariance = of_trial.asDiagonal();
  if (information_sum > 0.0) covariance -= of_trial * of_trial.transpose() / information_sum;
  return with_noise(scatter_between(left, information, covariance));
}

double TrialEvidence::dispersion() const {
  const double b = size();
  double squares = 0.0, trials = 0.0;
  for (std::size_t t = 0; t < score.size(); ++t) {
    if (!(information[t] > 0.0)) continue;
    squares += std::pow(score[t] - b * information[t], 2) / information[t];
    ++trials;
  }
  return (kModelTrials + squares) / (kModelTrials + std::max(0.0, trials - 1.0));
}

double TrialEvidence::standard_error() const {
  const double information_sum = sum(information);
  return information_sum > 0.0 ? std::sqrt(scatter().ratio / information_sum) : 1e300;
}

double TrialEvidence::effective_trials() const {
  double squares = 0.0;
  for (const double i : information) squares += i * i;
  return squares > 0.0 ? std::pow(sum(information), 2) / squares : 0.0;
}

double TrialEvidence::held_out_drop() const {
  const double score_sum = sum(score), information_sum = sum(information);
  double drop = 0.0;
  for (std::size_t t = 0; t < score.size(); ++t) {
    const double others = information_sum - information[t];
    if (others <= 0.0) continue;
    const double size = (score_sum - score[t]) / others;
    drop += size * (2.0 * score[t] - size * information[t]);
  }
  return std::max(0.0, drop);
}

double TrialEvidence::p_value() const {
  const double information_sum = sum(information);
  if (information_sum <= 0.0) return 1.0;
  const TrialScatter of_trials = scatter();
  const double t = size() * std::sqrt(information_sum / of_trials.ratio);
  return student_t_two_sided(t, of_trials.degrees_of_freedom);
}

double sign_flip_p_value(const std::vector<TrialEvidence>& candidates, std::size_t chosen, unsigned seed) {
  const std::size_t trials = candidates[chosen].score.size();
  const auto statistic = [](const TrialEvidence& e, auto&& sign) {
    double s = 0.0;
    for (std::size_t t = 0; t < e.score.size(); ++t) s += sign(t) * e.score[t];
    const double information_sum = sum(e.information);
    return information_sum > 0.0 ? std::abs(s) / std::sqrt(information_sum) : 0.0;
  };
  const double observed = statistic(candidates[chosen], [](std::size_t) { return 1.0; }) * (1.0 - 1e-9);
  constexpr std::size_t kAllUpTo = 12;
  const bool all = trials <= kAllUpTo;
  const std::uint64_t flips = all ? std::uint64_t{1} << (trials - 1) : 2000;
  std::mt19937_64 engine(seed);
  std::uint64_t reached = 0;
  for (std::uint64_t f = 0; f < flips; ++f) {
    const std::uint64_t bits = all || f == 0 ? f : engine();
    const auto sign = [bits](std::size_t t) { return (bits >> (t % 64)) & 1u ? -1.0 : 1.0; };
    double most = 0.0;
    for (const auto& e : candidates) most = std::max(most, statistic(e, sign));
    reached += most >= observed;
  }
  return static_cast<double>(reached) / static_cast<double>(flips);
}

double signed_rank_p_value(const std::vector<double>& values) {
  std::vector<double> sorted = values;
  std::ranges::stable_sort(sorted, {}, [](double v) { return std::abs(v); });
  std::size_t positive = 0, all = 0;
  std::vector<double> ways{1.0};  // probability of each sum of ranks
  for (std::size_t i = 0; i < sorted.size(); ++i) {
    const std::size_t rank = i + 1;
    all += rank;
    if (sorted[i] > 0.0) positive += rank;
    std::vector<double> next(all + 1, 0.0);
    for (std::size_t s = 0; s < ways.size(); ++s) {
      next[s] += 0.5 * ways[s];
      next[s + rank] += 0.5 * ways[s];
    }
    ways = std::move(next);
  }
  double p = 0.0;
  for (std::size_t s = positive; s <= all; ++s) p += ways[s];
  return p;
}

std::vector<bool> rejected_at_false_discovery_rate(const std::vector<double>& p_values, double rate) {
  std::vector<double> sorted = p_values;
  std::ranges::sort(sorted);
  double limit = -1.0;
  for (std::size_t i = 0; i < sorted.size(); ++i)
    if (sorted[i] <= rate * static_cast<double>(i + 1) / static_cast<double>(sorted.size()))
      limit = sorted[i];
  std::vector<bool> rejected;
  for (const double p : p_values) rejected.push_back(p <= limit);
  return rejected;
}

double median(std::vector<double> values) {
  if (values.empty()) return 0.0;
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

}  // namespace sandhopper::diagnose
