#pragma once
#include <span>
#include <string>
#include <vector>

#include "tools/diagnose/model/plant.hpp"
#include "tools/diagnose/model/signal.hpp"

// Functions that all plants share: they turn recorded channels into rows and inputs.
namespace sandhopper::diagnose {

// Stands for a standard deviation of 0, in any unit: the elimination of a nuisance parameter divides by it.
inline constexpr double kExact = 1e-9;
// Standard deviation between trials as [spread] states it, else `unstated`.
inline double spread_of(const Belief& belief, const std::string& key, double unstated) {
  return belief.has(key) ? std::max(belief.value(key), kExact) : unstated;
}

// Samples of a channel, empty cells left out.
struct Samples {
  std::vector<double> time_s;
  std::vector<double> value;
  bool empty() const { return value.empty(); }
};
Samples samples_of(const Trial& trial, const std::string& channel);

// Robust standard deviation of a channel's white noise, from third divided differences of successive samples:
// a parabola adds nothing to it, also where rows are missing. 0 with fewer than 8 samples.
double fluctuation_rms(const Samples& samples);

// Local fit of a polynomial (degree 2) over `half_width` samples to each side: value, first and second
// derivative at each sample.
struct Smoothed {
  std::vector<double> value, rate, curvature;
};
Smoothed smooth(const Samples& samples, std::size_t half_width);

// Per sample, the position of the last reversal: the last extreme from which the motion came back by more
// than `least`. Before the first reversal it is the first position.
std::vector<double> last_turns(std::span<const double> position, double least);

// Median time step, at least 1e-6 s; 1e-3 s for fewer than two samples.
double median_step_s(std::span<const double> time_s);

// Removes the repeats of a slow sensor whose values a faster log holds. Other channels are returned
// unchanged.
Samples without_repeats(const Samples& samples);

// Age of each sample, s: the time from its sampling to its row, for a sensor whose own clock is slower than
// the rows. Rows with and without a fresh sample give the rate r (within 12 % of the believed `rate_Hz`,
// because clocks of converters are 10 % off) and the phase p of the sampling instants (k + p) / r. All r and
// p that match most rows are averaged. Empty if the rate is unknown or not slower than the rows, or if no r
// and p match.
std::vector<double> ages_s(const Trial& trial, const std::string& channel, double rate_Hz);
// Prior of the share of that age by which a row's value is older than its row: mean, standard deviation. The
// share may be 1 or one half.
inline constexpr double kAgeShare = 0.75, kAgeShareUnknown = 0.5;

// In median steps: a longer interval is a gap, over which nothing is averaged.
inline constexpr double kGapSteps = 2.5;

// Means of groups of successive samples, about `least_step_s` apart. It reduces the rows of a slow motion.
// Groups that a gap cuts short are left out.
Samples averaged(const Samples& samples, double least_step_s);

// Groups of up to `most` successive samples. A group ends earlier if the signal moves by more than `step`
// within it, or at a gap.
struct Group {
  std::size_t first, count;
};
std::vector<Group> slow_groups(const Samples& samples, std::size_t most, double step);
// Mean time and mean value of each group.
Samples means(const Samples& samples, const std::vector<Group>& groups);

// Samples on a uniform grid of `count` points. `hold`: a value holds until the next sample, but not across a
// gap of 3.5 steps. Otherwise, linear interpolation. Outside the samples the end values hold.
Signal on_grid(const Samples& samples, double start_s, double step_s, std::size_t count, bool hold);

// A cut-off frequency or a sampling rate above this shows nothing in rows of 1 ms; it counts as not there.
inline constexpr double kAsGoodAsNone_Hz = 4000.0;

// Sensor model of the belief, from keys like `sensors.height_bandwidth_Hz` with the prefix "height". `unit`
// is that of the range.
SensorBelief sensor_belief(const Belief& belief, const std::string& prefix, const std::string& unit);

// Largest minus smallest value of a set-up key over the trials; a trial without the key counts as 0.
double range_of_setup(const std::vector<Trial>& trials, const std::string& key);

}  // namespace sandhopper::diagnose
