#pragma once
#include <optional>

#include "tools/experiment/recorded_stride.hpp"
#include "tools/terrain/hop_frames.hpp"

namespace sandhopper {

// First stance as measured by load cell and camera, in the form of the firmware's estimates, so that the same
// windows and fits apply. Contact force and direct force are the load cell's, without its stated latency
// (sensors.load_cell_latency_s). Depth and speed come from
// motion capture smoothed with the foot's accelerometer (estimation/motion_smoother.hpp).
struct MeasuredStride {
  RecordedStride stride;  // one sample per row from `first_row` on
  std::size_t first_row = 0;
  bool phases_known = false;  // false: stance from loading to unloading, without a switch
};

// Needs load_cell_force_N and mocap_foot_z_m. If they are missing the result is empty and `missing` names
// them.
std::optional<MeasuredStride> measured_stride(const CampaignTrial& trial, const TrialRecording& recording,
                                              const StiffnessConfig& config, std::string& missing);

}  // namespace sandhopper
