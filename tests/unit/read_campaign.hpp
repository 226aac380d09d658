#pragma once
#include "campaign_folder.hpp"

namespace sandhopper {

struct Told {
  TrialRecording recording;
  std::string text;  // all findings
};

// Reads a campaign of one trial: `head` of campaign.toml, and the table of its recording.
inline Told read_campaign(const std::string& head, const std::string& csv) {
  CampaignFolder folder;
  folder.write("campaign.toml", head + "\n[[trial]]\nfile = \"a.csv\"\n").write("a.csv", csv);
  const auto campaign = load_campaign(folder.path());
  Told told{read_trial(campaign, campaign.trials.at(0)), ""};
  for (const auto& finding : told.recording.findings) told.text += to_string(finding) + "\n";
  return told;
}

}  // namespace sandhopper
