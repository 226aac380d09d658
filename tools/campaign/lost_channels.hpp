#pragma once
#include <map>
#include <string>

#include "tools/campaign/campaign.hpp"
#include "tools/campaign/trial_recording.hpp"

namespace sandhopper {

// Counts the usable trials that lack a channel which campaign.toml maps, or which a finding rules out.
class LostChannels {
 public:
  explicit LostChannels(CampaignPlant plant) : plant_(plant) {}

  void add(const CampaignTrial& trial, const TrialRecording& recording);

  // Number of trials without each channel.
  const std::map<std::string, std::size_t>& trials() const { return trials_; }
  // ", without accel_mps2 in 9 trials"; empty if no channel is lost.
  std::string words() const;

 private:
  CampaignPlant plant_;
  std::map<std::string, std::size_t> trials_;
};

}  // namespace sandhopper
