#pragma once
#include <cstddef>
#include <span>
#include <vector>

// Fuses several accelerometers of different range on one body and axis into one specific force. Each has its
// own bias, scale, noise and saturation.
namespace sandhopper {

struct AccelerometerCalibration {
  double scale = 1.0;  // calibrated = scale x raw + bias
  double bias_mps2 = 0.0;
  double noise_mps2 = 0.0;       // standard deviation of the sample-to-sample noise
  double saturation_mps2 = 0.0;  // largest magnitude in the record; samples at and near saturation are not
                                 // used
  std::size_t saturated_samples = 0;
};

struct FusedAcceleration {
  std::vector<double> specific_force_mps2;
  std::vector<std::size_t> source;  // index of the channel that gave each sample
  std::vector<AccelerometerCalibration> calibration;
  std::size_t reference = 0;
};

struct FusionOptions {
  std::size_t average_samples = 21;  // moving average before channels are compared, so that noise in one does
                                     // not reduce the other's scale
  std::size_t guard_samples = 20;    // samples before and after saturation that are not used, because the
                                     // filter still responds to it
  std::size_t fewest_saturated = 8;  // least length of a run of extreme values, equal within a quarter of the
                                     // noise, that counts as saturation
  double outlier_sigma = 8.0;        // a sample farther from the reference is not used
};

// The reference is the quietest channel that never saturates. The others are regressed on it over their
// unsaturated samples. At each instant the result comes from the quietest channel that is neither near
// saturation nor far from the reference. All channels must have the same length. Throws std::invalid_argument
// if there is no channel or if every channel saturates.
FusedAcceleration fuse_accelerometers(std::span<const std::span<const double>> channels_mps2,
                                      const FusionOptions& options);

// Standard deviation of the noise from sample to sample, from the median of the second differences, which
// hold neither the signal's level nor its slope (normal noise: root 6 sigma). `used`: samples in whose place
// one is taken; empty: all. Infinite without any.
double sample_noise(std::span<const double> values, const std::vector<bool>& used = {});

// Centred moving average over an odd number of samples; the window is shorter at the ends.
std::vector<double> moving_average(std::span<const double> values, std::size_t samples);

}  // namespace sandhopper
