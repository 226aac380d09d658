#pragma once
#include <cstddef>
#include <functional>
#include <iosfwd>
#include <string>
#include <vector>

#include "tools/terrain/trial_analysis.hpp"

namespace sandhopper {

// Every trial's result, in the order of the campaign, and where they come from. One of several parts holds
// only its own.
struct CampaignResults {
  std::string campaign;
  CampaignPlant plant{};
  std::size_t trials = 0;  // that campaign.toml names
  std::size_t part = 1, parts = 1;
  std::vector<Finding> findings{};  // about campaign.toml
  std::vector<TrialResult> results{};
};

struct AnalysisOptions {
  std::size_t part = 1, parts = 1;  // this part takes trials part-1, part-1+parts, …
  unsigned threads = 1;
  std::function<void(std::size_t done, std::size_t total)> progress{};  // from one thread at a time
};

// Reads and analyses one trial after the other on every thread; at any time each thread holds one recording.
CampaignResults analyse_campaign(const Campaign& campaign, const AnalysisOptions& options);

// Parts of one campaign put together. Throws std::invalid_argument where they are not of the same campaign,
// overlap, or leave a trial out.
CampaignResults merge_parts(std::vector<CampaignResults> parts);

// Without the trials' own results, which are many: they follow one by one (write_results).
nlohmann::ordered_json to_json(const CampaignResults& results);
// `head` and, as its last key "trials", every trial's result: one document, of which only one trial is in
// memory at a time.
void write_results(std::ostream& out, const nlohmann::ordered_json& head, const CampaignResults& results);
// Throws nlohmann::json::exception where `json` is not what write_results writes.
CampaignResults campaign_results_from_json(const nlohmann::ordered_json& json);

// The same finding of many trials (a file they share) is one. Points into `results`.
struct FindingGroup {
  const Finding* first;
  std::size_t trials = 0;
};
std::vector<FindingGroup> all_findings(const CampaignResults& results);

// A conclusion that some trials do not allow, and how many.
struct RuledOut {
  std::string reason;
  std::size_t trials = 0;
};
std::vector<RuledOut> all_ruled_out(const CampaignResults& results);

// Pools and concludes; the JSON has the pooled figures and each analysis' own conclusions, not the trials.
struct CampaignReport {
  std::vector<std::string> lines{};
  nlohmann::ordered_json json = nlohmann::ordered_json::object();
  Study study{};
  std::vector<std::pair<std::string, std::string>> tables{};  // name and text of CSV files
};
CampaignReport report_on(const CampaignResults& results);

}  // namespace sandhopper
