#pragma once
#include <vector>

#include "estimation/leg.hpp"
#include "tools/calibrate/outcome.hpp"
#include "tools/calibrate/recording.hpp"

namespace sandhopper::calibrate {

// The leg in its known pose, then shortened by hand, standing still in both.
struct PosePair {
  Recording known;
  Recording shortened;
};

// Known pose, and the widest accepted interval of a zero.
struct EncoderSetup {
  double known_length_m;     // from hip axis to toe joint
  double length_accuracy_m;  // half of the 95 % interval of known_length_m
  double max_ci95_rad = 0.02;
};

// Recordings in this order: the leg in its known pose, then shortened, several times; then moved to and fro
// by hand.
struct EncoderRecordings {
  std::vector<PosePair> pairs;
  std::vector<Recording> moved;
};

// Finds zero and sign of every motor's encoder. With u the drive's position divided by the gear ratio:
//   sign' = sign(u_shortened - u_known)  (the link's angle grows as the leg shortens),
//   zero' = angle(known length) - sign' . u_known,  mean over the pairs.
// The interval is Student's t over the pairs, with the scatter at least the resolution of the position field.
// The accuracy of the length is added in quadrature.
//
// Refusals: too_few_points (fewer than three pairs); a pose that moves, drifts or slips; saturated (a
// position at the end of its field); moved_too_little (the leg was hardly shortened); sides_disagree (the
// sides moved by different angles); repeats_disagree, interval_too_wide (the pairs differ in sign or zero);
// velocity_range_wrong (reported velocity against position, see velocity_range.hpp).
Outcome calibrate_encoders(const EncoderRecordings& recordings, const MotorConfigs& before, const Leg& leg,
                           const EncoderSetup& setup);

}  // namespace sandhopper::calibrate
