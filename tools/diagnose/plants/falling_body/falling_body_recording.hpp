#pragma once
#include <optional>

#include "tools/diagnose/plants/inputs.hpp"

// What the recording of a fall shows before anything is simulated: when the body was let go, how fast
// it fell and when it stopped. Times in s, heights in m over any zero, accelerations in m/s^2 as an
// accelerometer reads them.
namespace sandhopper::diagnose {

// Held, then let go, within some tenths of a second where a rope is paid out: the last loss of weight before
// the hardest shock. A body at its terminal speed feels its whole weight, too, but does not lose it again.
std::optional<double> release_before_shock_s(const Samples& accels, double gravity_mps2);

// Heights that stand still, within 4 standard deviations of their noise, and then fall: for longer than a
// body let go at their first would seem to, which speeds up by `fall_mps2`.
std::optional<double> end_of_rest_s(const Samples& heights, double believed_noise_m, double fall_mps2);

// The last sample before heights that stand still at the end although the body fell until then: it lies on
// the ground, whatever the sensor calls its height.
std::optional<double> landed_after_s(const Samples& heights, double believed_noise_m);

// A slow recording of a body let go by hand: the release at rest that suits its first second best, with any
// acceleration. What comes before is the hand's motion.
std::optional<double> release_by_hand_s(const Samples& heights);

// The last sample before a gap near `about_s`, where an accelerometer went to its limit and was not used:
// then the bed began.
std::optional<double> gap_around_s(const Samples& accels, double about_s);

// Root mean square of how long before its row a sample was taken, against the mean of that: a sensor with a
// clock of its own, whose samples come after now three rows, now two, is up to a row old. 0: always as many.
double jitter_s(const std::vector<double>& sampled_s, double row_s);

// Mean speed over a tenth of a trial, where that is fastest; 0 without heights.
double fastest_mps(const Samples& heights);

// Shortly before the peak of a deceleration of more than 3 g.
std::optional<double> hardest_deceleration_s(const Samples& accels, double gravity_mps2);

// The last sample before the first blow after an accelerometer has read next to nothing: a falling body meets
// a liquid. None where it was not seen to fall freely.
std::optional<double> liquid_entry_s(const Samples& accels, double gravity_mps2);

// Neither height nor release written down: how far the body fell is not known well enough to say when it
// meets the bed. The stop starts where the recorded deceleration begins, with the speed that the
// accelerometer has summed up; the fall starts with a state of its own once the release is over.
struct Impact {
  double time_s;
  double speed_mps;  // upward, as h'
  double fall_from_s;
  double fall_speed_mps;
};
std::optional<Impact> find_impact(const Samples& accels, double peak_s, double release_s,
                                  double gravity_mps2);

}  // namespace sandhopper::diagnose
