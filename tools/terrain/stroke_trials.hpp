#pragma once
#include "tools/terrain/trial_analysis.hpp"

namespace sandhopper {

// Analysis of intrusions with speed: the depth-speed map with added mass over all trials of one plate, a
// straight line and the joint fit for each trial, and unloading. Speed and acceleration are used as recorded,
// or fused from camera and accelerometer (estimation/motion_smoother.hpp), or derived from the depth alone.
class StrokeTrials : public TrialAnalysis {
 public:
  std::string_view name() const override { return "strokes"; }
  bool takes(CampaignPlant plant, TrialKind kind) const override;
  void analyse(const CampaignTrial& trial, const TrialRecording& recording,
               TrialResult& result) const override;
  CampaignConclusions conclude(std::span<const TrialResult* const> results) const override;
};

CampaignConclusions conclude_strokes(std::span<const TrialResult* const> results);  // stroke_conclusions.cpp

}  // namespace sandhopper
