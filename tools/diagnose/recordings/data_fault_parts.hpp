#pragma once
#include <string>
#include <vector>

#include "tools/diagnose/recordings/data_faults.hpp"

// The kinds of data fault, each found and taken out on its own.
namespace sandhopper::diagnose {

// Finite samples of one channel in one trial.
struct SampledChannel {
  Trial* trial = nullptr;
  std::vector<std::size_t> rows;
  std::vector<double> value, time_s;
};
std::vector<SampledChannel> sampled(std::vector<Trial>& trials, const std::string& channel);

// Least step between values that differ.
double value_grid(const std::vector<SampledChannel>& channel);
// Robust root mean square of a sample's own fluctuation, over all trials.
double own_noise(const std::vector<SampledChannel>& channel);

// Stretches where a channel falls to a value of its own (zero, or one far off all others) and comes back to
// where it was; or where only this channel's cells are empty, or whole rows, again and again in most trials.
void find_dropouts(std::vector<Trial>& trials, const std::string& channel, std::vector<DataFault>& faults);
void find_lost_rows(const std::vector<Trial>& trials, std::vector<DataFault>& faults);

// Stretches of equal values where the quantity went on: a channel that held a value. Their samples after the
// first are emptied.
void find_stuck(std::vector<Trial>& trials, const std::string& channel, std::vector<DataFault>& faults);

// Samples that pile up exactly on the end of what the channel ever shows although noise would spread them.
// Those at the limit, and those that noise may have lifted off it, are emptied.
void find_clipping(std::vector<Trial>& trials, const std::string& channel, std::vector<DataFault>& faults);

}  // namespace sandhopper::diagnose
