#pragma once
#include <Eigen/Core>
#include <cstdint>
#include <span>
#include <vector>

#include "tools/diagnose/model/plant.hpp"

namespace sandhopper::diagnose {

// Autoregression over successive samples of e:
//   w_k = (e_k - a_1 e_{k-1} - … - a_p e_{k-p}) / s,   w white of unit variance
struct Autoregression {
  std::vector<double> coefficients;  // a
  double innovation_sd = 1.0;        // s
};

// Noise of one channel: per phase a standard deviation sd and an autoregression of
//   e_k = r_k / hypot(relative_sd_k sd, numerical_sd_k),   r_k the residual of a row
struct ChannelNoise {
  std::vector<double> sd_of_phase;
  std::vector<Autoregression> correlation_of_phase;

  double sd() const;  // root mean square over the phases, weighed by their samples
  std::vector<double> samples_of_phase;
};

class NoiseModel {
 public:
  NoiseModel() = default;
  explicit NoiseModel(std::vector<ChannelNoise> channels) : channels_(std::move(channels)) {}

  // Whitens residuals, or derivatives of them, in place; one per column. Rows that are not `used` become 0,
  // and the autoregression starts anew after them.
  void whiten(const TrialModel& trial, const std::vector<std::uint8_t>& used,
              Eigen::Ref<Eigen::MatrixXd> values) const;
  // ln|W| of this linear map W over the used rows: what the noise adds to a log likelihood.
  double log_determinant(const TrialModel& trial, const std::vector<std::uint8_t>& used) const;
  const ChannelNoise& channel(std::size_t i) const { return channels_[i]; }
  // Standard deviation of one row, as whitening uses it.
  double sd(const TrialModel& trial, const Row& row) const;
  void fix(std::size_t channel, double sd);  // white, the same in all phases
  // Multiplies all standard deviations, to correct for the degrees of freedom that a fit took up.
  void widen(double factor);
  std::size_t channels() const { return channels_.size(); }

 private:
  std::vector<ChannelNoise> channels_;
};

// Estimates the noise from the residuals of all trials, by Levinson's recursion on their autocorrelation
// within channel and block. A phase with few samples takes the values of the whole channel. `floor_sd`: lower
// bound of each channel's standard deviation.
NoiseModel estimate_noise(const std::vector<const TrialModel*>& trials,
                          const std::vector<std::vector<std::uint8_t>>& used,
                          const std::vector<Eigen::VectorXd>& residuals, std::size_t phases,
                          std::span<const double> floor_sd);

// White noise of these levels in every phase.
NoiseModel white_noise(std::span<const double> sd, std::size_t phases);

}  // namespace sandhopper::diagnose
