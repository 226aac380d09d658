#pragma once
#include <cstddef>
#include <functional>
#include <iosfwd>
#include <string>
#include <vector>

#include "tools/terrain/trial_analysis.hpp"

namespace sandhopper {

// Results of every trial in the order of the campaign, and their origin. If the campaign is analysed in
// parts, each part contains only its own trials.
struct CampaignResults {
  std::string campaign;
  CampaignPlant plant{};
  std::size_t trials = 0;  // number of trials in campaign.toml
  std::size_t part = 1, parts = 1;
  std::vector<Finding> findings{};  // about campaign.toml
  std::vector<TrialResult> results{};
};

struct AnalysisOptions {
  std::size_t part = 1, parts = 1;  // this part analyses the trials part-1, part-1+parts, …
  unsigned threads = 1;
  std::function<void(std::size_t done, std::size_t total)> progress{};  // called from one thread at a time
};

// Reads and analyses the trials on all threads. Each thread holds one recording at a time.
CampaignResults analyse_campaign(const Campaign& campaign, const AnalysisOptions& options);

// Combines the parts of one campaign. Throws std::invalid_argument if they are of different campaigns,
// overlap, or lack a trial.
CampaignResults merge_parts(std::vector<CampaignResults> parts);

// Without the trials' own results, which are many; write_results writes them one by one.
nlohmann::ordered_json to_json(const CampaignResults& results);
// Writes one document: `head`, and as its last key "trials" every trial's result. Only one trial is converted
// at a time.
void write_results(std::ostream& out, const nlohmann::ordered_json& head, const CampaignResults& results);
// Throws nlohmann::json::exception if `json` was not written by write_results.
CampaignResults campaign_results_from_json(const nlohmann::ordered_json& json);

// Groups equal findings of many trials (such as those on a shared file). Points into `results`.
struct FindingGroup {
  const Finding* first;
  std::size_t trials = 0;
};
std::vector<FindingGroup> all_findings(const CampaignResults& results);

// A conclusion that some trials do not allow, with their number.
struct RuledOut {
  std::string reason;
  std::size_t trials = 0;
};
std::vector<RuledOut> all_ruled_out(const CampaignResults& results);

// Pools the results and draws conclusions. The JSON contains the pooled values and the conclusions of each
// analysis, not the trials.
struct CampaignReport {
  std::vector<std::string> lines{};
  nlohmann::ordered_json json = nlohmann::ordered_json::object();
  Study study{};
  std::vector<std::pair<std::string, std::string>> tables{};  // name and content of CSV files
};
CampaignReport report_on(const CampaignResults& results);

}  // namespace sandhopper
