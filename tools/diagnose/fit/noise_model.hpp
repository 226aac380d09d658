#pragma once
#include <Eigen/Core>
#include <cstdint>
#include <span>
#include <vector>

#include "tools/diagnose/model/plant.hpp"

namespace sandhopper::diagnose {

// Over successive samples: w_k = (e_k - a_1 e_{k-1} - … - a_p e_{k-p}) / s, w white of unit variance.
struct Autoregression {
  std::vector<double> coefficients;  // a
  double innovation_sd = 1.0;        // s
};

// What is left when nothing is missing: per channel and phase a standard deviation and an autoregression of
//   e_k = r_k / (relative_sd_k sd).
struct ChannelNoise {
  std::vector<double> sd_of_phase;
  std::vector<Autoregression> correlation_of_phase;

  double sd() const;  // of all phases together
  std::vector<double> samples_of_phase;
};

class NoiseModel {
 public:
  NoiseModel() = default;
  explicit NoiseModel(std::vector<ChannelNoise> channels) : channels_(std::move(channels)) {}

  // Whitens residuals or derivatives of them, one a column, in place. Rows that are not `used` become zero
  // and break the chain.
  void whiten(const TrialModel& trial, const std::vector<std::uint8_t>& used,
              Eigen::Ref<Eigen::MatrixXd> values) const;
  const ChannelNoise& channel(std::size_t i) const { return channels_[i]; }
  // Standard deviation of one row, as whitening takes it.
  double sd(const TrialModel& trial, const Row& row) const;
  void fix(std::size_t channel, double sd);  // white, the same in all phases
  // All standard deviations times this: what a fit took up belongs to the noise, too.
  void widen(double factor);
  std::size_t channels() const { return channels_.size(); }

 private:
  std::vector<ChannelNoise> channels_;
};

// From residuals of all trials (Levinson's recursion on their autocorrelation within channel and block). A
// phase with few samples has the autoregression of all of them. `floor_sd` bounds each channel's standard
// deviation from below.
NoiseModel estimate_noise(const std::vector<const TrialModel*>& trials,
                          const std::vector<std::vector<std::uint8_t>>& used,
                          const std::vector<Eigen::VectorXd>& residuals, std::size_t phases,
                          std::span<const double> floor_sd);

// White noise of these levels in every phase.
NoiseModel white_noise(std::span<const double> sd, std::size_t phases);

}  // namespace sandhopper::diagnose
