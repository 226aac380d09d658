#pragma once
#include <vector>

#include "estimation/leg.hpp"
#include "tools/calibrate/outcome.hpp"
#include "tools/calibrate/recording.hpp"

namespace sandhopper::calibrate {

// The leg in its known pose, and the same leg shortened by hand afterwards; both standing still.
struct PosePair {
  Recording known;
  Recording shortened;
};

struct EncoderSetup {
  double known_length_m;     // hip axis to toe joint
  double length_accuracy_m;  // 95 %
  double max_ci95_rad = 0.02;
};

// What the person does: the leg in its known pose, then shortened, several times; then moved to and fro.
struct EncoderRecordings {
  std::vector<PosePair> pairs;
  std::vector<Recording> moved;
};

// Zero and sign of every motor's encoder. With u the drive's position over the gear ratio:
//   sign' = sign of u_shortened - u_known (the link's angle grows as the leg shortens),
//   zero' = angle(known length) - sign' . u_known, mean over the pairs.
// The interval is Student's t over the pairs, the scatter no smaller than the position field's resolution,
// and the accuracy of the length added in quadrature.
//
// Refused: fewer than three pairs (too_few_points), a pose that moves, drifts or slips, a position at the end
// of its field (saturated), a leg that was hardly shortened (moved_too_little), sides that moved differently
// (sides_disagree), pairs that disagree about sign or zero (repeats_disagree, interval_too_wide), and a drive
// whose velocity is not what its position does (velocity_range_wrong, see velocity_range.hpp).
Outcome calibrate_encoders(const EncoderRecordings& recordings, const MotorConfigs& before, const Leg& leg,
                           const EncoderSetup& setup);

}  // namespace sandhopper::calibrate
