#pragma once
#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "estimation/leg.hpp"
#include "firmware/robot_estimator.hpp"
#include "firmware/sensor_frame.hpp"
#include "tools/campaign/trial_recording.hpp"

namespace sandhopper {

// A recorded hop in the form of the cycle's input.
struct HopFrames {
  std::vector<SensorFrame> frames;   // one per row
  std::vector<double> phase;         // as recorded; NaN: outside of a hop. Empty: not recorded
  std::size_t release_row = 0;       // first row after the release
  StaticCalibration calibration{};   // from the rows before the release
  bool rest_seen = false;            // false: the recording begins in the air, and offsets are taken as zero
  bool speed_known = false;          // starts from rest, according to the recording or the set-up
  std::vector<std::string> notes{};  // replacements for channels that were not recorded
};

// Makes frames from the channels of RECORDING. Every sample gets the age that the belief states for its
// sensor. Needs motor positions and both IMUs. If they were not recorded, speeds are differences of
// positions, currents come from the commands, and a missing motor is replaced by the other one. Without the
// needed channels the result is empty and `missing` names them.
std::optional<HopFrames> hop_frames(const CampaignTrial& trial, const TrialRecording& recording,
                                    const Leg& leg, std::string& missing);

}  // namespace sandhopper
