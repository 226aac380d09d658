#pragma once
#include <string>
#include <vector>

#include "tools/diagnose/recordings/data_faults.hpp"

// Detectors of data faults, one for each kind. They empty the samples that are no measurements.
namespace sandhopper::diagnose {

// Finite samples of one channel in one trial.
struct SampledChannel {
  Trial* trial = nullptr;
  std::vector<std::size_t> rows;
  std::vector<double> value, time_s;
};
std::vector<SampledChannel> sampled(std::vector<Trial>& trials, const std::string& channel);

// A jump away and back: its least size, in changes of the neighbours; the largest difference of the samples
// before and after it, as a share of the jump; the neighbours looked at on each side.
inline constexpr double kOutlying = 8.0, kAlike = 0.5;
inline constexpr std::size_t kJumpNeighbours = 6;

// Smallest change between successive samples: the resolution.
double value_grid(const std::vector<SampledChannel>& channel);
// Standard deviation of a sample's noise: fluctuation_rms, median over the trials.
double own_noise(const std::vector<SampledChannel>& channel);

// Stretches in which a channel jumps to a fixed value (zero, or one isolated from all others) and back.
void find_dropouts(std::vector<Trial>& trials, const std::string& channel, std::vector<DataFault>& faults);
// One or two samples of a position that jump far away and back. They are emptied; DataFault::limit is the
// largest jump.
void find_spikes(std::vector<Trial>& trials, const std::string& channel, std::vector<DataFault>& faults);
// Whole rows that are missing again and again in most trials.
void find_lost_rows(const std::vector<Trial>& trials, std::vector<DataFault>& faults);

// Stretches in which a channel holds one value although the quantity changes. Their samples after the first
// are emptied.
void find_stuck(std::vector<Trial>& trials, const std::string& channel, std::vector<DataFault>& faults);

// Samples that pile up exactly at the largest or smallest value of a channel, although noise would spread
// them. They and the samples that noise may have moved off the limit are emptied.
void find_clipping(std::vector<Trial>& trials, const std::string& channel, std::vector<DataFault>& faults);

}  // namespace sandhopper::diagnose
