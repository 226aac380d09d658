#pragma once
#include "tools/terrain/trial_analysis.hpp"

namespace sandhopper {

// Intrusions with speed: the depth-speed map with added mass over all trials of one plate, a straight line
// and the joint fit trial by trial, unloading. Speed and acceleration as recorded, or from camera and
// accelerometer together (estimation/motion_smoother.hpp), or from the depth alone.
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
