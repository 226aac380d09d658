#pragma once
#include <optional>
#include <string>
#include <vector>

#include "tools/diagnose/fit/fit.hpp"
#include "tools/diagnose/fit/problem.hpp"

// The residual of the best fit, compared with the noise that the sensors should have. The noise model is
// estimated from residuals, so it may have absorbed a missing effect; the deviance cannot show that.
namespace sandhopper::diagnose {

// Ratio of a channel's fitted noise to the sensor's own noise below which it is no sign of missing physics.
// Set by hand; with nothing missing at most 1.45 (see noisiest_channel).
inline constexpr double kQuietChannel = 1.3;

// Key of nominal.toml that states the channel's noise; empty if there is none.
std::string noise_key(const std::string& channel);
// Standard deviation of the channel's noise as stated in the belief, in the channel's unit; 0 if not stated.
double believed_noise(const Belief& belief, const std::string& channel);

// Ratio of the fitted noise to the sensors' own noise (estimated from fast fluctuations): geometric mean over
// the channels.
double noise_over_sensors(const Problem& problem);

// Limit of LeftOver::after above which more than noise is left. Measured with nothing missing: at most 1.13.
inline constexpr double kMoreThanNoise = 1.35;

// RMS of the residual / RMS of noise and model error, without whitening, because whitening hides slow
// deviations: median over the trials, for the channel with a stated noise in which most is left. 0 if no
// noise is stated or if there are fewer than three trials.
struct LeftOver {
  double before = 0.0;  // without the effects
  double after = 0.0;   // with them
  // Part of the excess over the noise that the effects leave: (after^2 - 1) / (before^2 - 1), from 0 to 1.
  double share() const;
  bool is_more_than_noise() const { return after > kMoreThanNoise; }
};
LeftOver left_over_noise(const Problem& problem, const Fit& without, const Fit& with);

// A channel whose fitted noise far exceeds the stated noise of its sensor. A disturbance that does not repeat
// in time, depth or speed is fitted as noise.
struct NoisyChannel {
  std::string channel;
  double times = 1.0;  // ratio to the sensor's own noise
  std::string port;    // The channel if only its sensor is noisy, else the plant's first port.
};
// The channel with the largest ratio, among those with a stated noise; empty if none exceeds the limit of
// 4.5. Ratios measured with nothing missing or with the right names: at most 1.45 with two other programs, up
// to 3.2 with heights that drift. With hum or ringing: at least 5.6.
std::optional<NoisyChannel> noisiest_channel(const Problem& problem);

// Mean offset of a nuisance parameter over all trials.
struct CommonShift {
  std::string nuisance, port;
  double z = 0.0;  // mean(value / sd) * sqrt(min(trials, 12))
};
// Offsets of all nuisance parameters, largest |z| first. A nuisance should scatter around its prior mean. If
// all trials move it the same way, an effect is missing, and the deviance does not show it. The number of
// trials counts as at most 12: with 100 trials even the error of a simulation would be significant.
std::vector<CommonShift> common_shifts(const Problem& problem, const Point& point);
// The offset with the largest |z|; z = 0 if there is none.
CommonShift largest_common_shift(const Problem& problem, const Point& point);

// RMS difference of two noise models: logarithms of the standard deviation and of the innovation's standard
// deviation, weighted by samples.
double noise_change(const NoiseModel& before, const NoiseModel& now);

}  // namespace sandhopper::diagnose
