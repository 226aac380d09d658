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

// A recorded hop as the cycle would have seen it.
struct HopFrames {
  std::vector<SensorFrame> frames;   // one a row
  std::vector<double> phase;         // as recorded; NaN: outside of a hop. Empty: not recorded
  std::size_t release_row = 0;       // the first one free
  StaticCalibration calibration{};   // from the rows before the release
  bool rest_seen = false;            // false: the recording begins in the air, offsets are taken as zero
  bool speed_known = false;          // starts from rest, as recorded or as the set-up says
  std::vector<std::string> notes{};  // what stands in for channels that were not recorded
};

// Frames from the channels of RECORDING, every sample with the age that the belief gives its sensor. Needs
// motor positions and both IMUs; speeds are differenced, currents taken from the commands and a missing
// motor from the other one where they were not recorded. Without the needed channels the answer is empty and
// `missing` names them.
std::optional<HopFrames> hop_frames(const CampaignTrial& trial, const TrialRecording& recording,
                                    const Leg& leg, std::string& missing);

}  // namespace sandhopper
