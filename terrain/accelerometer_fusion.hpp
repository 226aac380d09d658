#pragma once
#include <cstddef>
#include <span>
#include <vector>

// One specific force from several accelerometers of different range on one body and axis, each with its own
// bias, scale, noise and saturation.
namespace sandhopper {

struct AccelerometerCalibration {
  double scale = 1.0;  // calibrated = scale x raw + bias
  double bias_mps2 = 0.0;
  double noise_mps2 = 0.0;       // standard deviation of raw against the reference, sample to sample
  double saturation_mps2 = 0.0;  // greatest magnitude it reads; at and near it nothing is believed
  std::size_t saturated_samples = 0;
};

struct FusedAcceleration {
  std::vector<double> specific_force_mps2;
  std::vector<std::size_t> source;  // which channel gave it
  std::vector<AccelerometerCalibration> calibration;
  std::size_t reference = 0;
};

struct FusionOptions {
  std::size_t average_samples = 21;  // moving average before channels are compared, so that noise in one does
                                     // not shrink the other's scale
  std::size_t guard_samples = 20;    // before and after saturation: the filter's memory
  std::size_t fewest_saturated = 8;  // extreme values in a row, within a quarter of the noise of each other,
                                     // that count as saturation
  double outlier_sigma = 8.0;        // further from the reference than this is not believed
};

// The reference is the quietest channel that never saturates. The others are regressed on it where they do
// not saturate; at each instant the quietest channel that is neither near saturation nor far from the
// reference speaks. All channels have the same length. Throws std::invalid_argument when there is none, or
// when every one saturates.
FusedAcceleration fuse_accelerometers(std::span<const std::span<const double>> channels_mps2,
                                      const FusionOptions& options);

// Centred moving average over an odd number of samples, shorter at the ends.
std::vector<double> moving_average(std::span<const double> values, std::size_t samples);

}  // namespace sandhopper
