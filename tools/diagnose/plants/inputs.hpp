#pragma once
#include <span>
#include <string>
#include <vector>

#include "tools/diagnose/model/plant.hpp"
#include "tools/diagnose/model/signal.hpp"

// What the plants share: recorded channels made into rows and inputs.
namespace sandhopper::diagnose {

// Samples of a channel, empty cells left out.
struct Samples {
  std::vector<double> time_s;
  std::vector<double> value;
  bool empty() const { return value.empty(); }
};
Samples samples_of(const Trial& trial, const std::string& channel);

// Root mean square of a channel's own fast fluctuation: third differences of successive samples, robust.
double fluctuation_rms(const Samples& samples);

// Local fit of a polynomial (degree 2) over `half_width` samples to each side: value, first and second
// derivative at each sample.
struct Smoothed {
  std::vector<double> value, rate, curvature;
};
Smoothed smooth(const Samples& samples, std::size_t half_width);

// Where the motion last turned, at each sample: the last extreme from which it came back by more than
// `least`; before the first one, where it began.
std::vector<double> last_turns(std::span<const double> position, double least);

double median_step_s(std::span<const double> time_s);

// Held values of a slow sensor logged again and again count once; the rest is returned.
Samples without_repeats(const Samples& samples);

// How long each sample of a sensor with a clock of its own, slower than the rows, had waited for its row.
// Rows with and without a fresh sample tell rate r (within 12 % of what is believed: converters' clocks are
// 10 % off) and phase p of ticks at (k + p) / r: those that suit most rows. Empty where the rate is not known
// or not slower, or the pattern is another one.
std::vector<double> ages_s(const Trial& trial, const std::string& channel, double rate_Hz);
// The share of that age by which a row's value is older than its row: all of it, or half; believed so.
inline constexpr double kAgeShare = 0.75, kAgeShareUnknown = 0.5;

inline constexpr double kGapSteps = 2.5;  // over a longer one no mean is taken, nothing known between

// Means over successive samples, so that no two are closer than `least_step_s`: what a slow motion shows is
// kept, the number of rows is not.
Samples averaged(const Samples& samples, double least_step_s);

// Successive samples, up to `most` together, fewer where the signal moves by more than `step` within them and
// none across a gap.
struct Group {
  std::size_t first, count;
};
std::vector<Group> slow_groups(const Samples& samples, std::size_t most, double step);
Samples means(const Samples& samples, const std::vector<Group>& groups);

// Samples on a uniform grid; before the first and after the last the end values hold.
Signal on_grid(const Samples& samples, double start_s, double step_s, std::size_t count, bool hold);

// What the belief says about the sensor of a channel, from keys like `height_bandwidth_Hz`.
SensorBelief sensor_belief(const Belief& belief, const std::string& prefix, const std::string& unit);

// Largest less smallest value of a set-up's key over the trials; where it is not written down it is 0.
double range_of_setup(const std::vector<Trial>& trials, const std::string& key);

}  // namespace sandhopper::diagnose
