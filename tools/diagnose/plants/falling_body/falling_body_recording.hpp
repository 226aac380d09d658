#pragma once
#include <optional>

#include "tools/diagnose/plants/inputs.hpp"

// Features of a recorded fall that need no simulation: release, speed and stop. Times in s, heights in m over
// any zero, accelerations in m/s^2 as an accelerometer reads them.
namespace sandhopper::diagnose {

// Release of a held body: the last loss of weight before the hardest shock. It may take some tenths of a
// second if a rope is paid out. A body at its terminal speed feels its whole weight, too, but does not lose
// it again.
std::optional<double> release_before_shock_s(const Samples& accels, double gravity_mps2);

// Release of a body that hangs at rest when the recording begins: midway between the last sample with the
// body's weight and the first without it. The weight is felt in at least three samples, and as long after
// the release as before it, half of it is not felt again. Empty if the first sample is already in the fall.
std::optional<double> loss_of_weight_s(const Samples& accels, double gravity_mps2);

// End of an initial rest, counted from the first height: the heights stay within 4 standard deviations of
// their noise and then fall. Empty if the rest is no longer than a body that is released at the first height,
// with the acceleration `fall_mps2`, would seem to rest.
std::optional<double> end_of_rest_s(const Samples& heights, double believed_noise_m, double fall_mps2);

// Time of the last sample before the heights stand still at the end although the body was falling. It then
// lies on the ground, whatever height the sensor reads.
std::optional<double> landed_after_s(const Samples& heights, double believed_noise_m);

// Release of a body by hand in a slow recording: the release from rest that fits the first second best, with
// any constant acceleration. Earlier heights show the motion of the hand.
std::optional<double> release_by_hand_s(const Samples& heights);

// Time of the last sample before a gap near `about_s`. Clipped samples at the impact on the bed leave such a
// gap.
std::optional<double> gap_around_s(const Samples& accels, double about_s);

// Standard deviation of the age of a sample at its row, s. A sensor with its own clock, whose samples come
// sometimes after two rows and sometimes after three, is up to one row old. 0 if the number of rows is always
// the same.
double jitter_s(const std::vector<double>& sampled_s, double row_s);

// True if the body still moves further than `noise_m` below 0: it does not lie there. One that lies a little
// below 0 has nearly all of these heights in its place of rest.
bool goes_on_below_zero(const Samples& heights, double noise_m);

// Greatest mean speed over a tenth of the samples; 0 without heights.
double fastest_mps(const Samples& heights);

// Time at which the reading first exceeds 85 % of its peak. Empty if the peak is below 3 g.
std::optional<double> hardest_deceleration_s(const Samples& accels, double gravity_mps2);

// Entry of a falling body into a liquid: the last sample before the first sharp rise after an accelerometer
// has read nearly 0. Empty if no free fall was recorded.
std::optional<double> liquid_entry_s(const Samples& accels, double gravity_mps2);

// Impact of a body whose height and release are unknown, so that a simulated fall cannot predict its time.
// The stop starts at the onset of the recorded deceleration, with the speed that the accelerometer integrates
// to. The fall starts from its own state after the release.
struct Impact {
  double time_s;
  double speed_mps;  // upward, as h'
  double fall_from_s;
  double fall_speed_mps;
};
std::optional<Impact> find_impact(const Samples& accels, double peak_s, double release_s,
                                  double gravity_mps2);

}  // namespace sandhopper::diagnose
