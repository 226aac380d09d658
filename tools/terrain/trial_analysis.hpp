#pragma once
#include <nlohmann/json.hpp>
#include <span>
#include <string>
#include <vector>

#include "tools/report/study.hpp"
#include "tools/terrain/trial_result.hpp"

namespace sandhopper {

// Conclusions from all trials of one kind.
struct CampaignConclusions {
  std::string answer{};              // one sentence at the top of the page; empty: use the first line
  std::vector<std::string> lines{};  // for the terminal
  nlohmann::ordered_json json = nlohmann::ordered_json::object();
  std::vector<StudySection> sections{};                       // of the page
  std::vector<std::pair<std::string, std::string>> tables{};  // name and content of CSV files, such as
                                                              // "profile"
};

// Analysis of one kind of trial: results of a single recording, and conclusions from all of them. A new kind
// needs one class and a line in trial_analysis.cpp.
class TrialAnalysis {
 public:
  TrialAnalysis() = default;
  virtual ~TrialAnalysis() = default;
  TrialAnalysis(const TrialAnalysis&) = delete;
  TrialAnalysis& operator=(const TrialAnalysis&) = delete;

  virtual std::string_view name() const = 0;  // key in the JSON, such as "hops"
  virtual bool takes(CampaignPlant plant, TrialKind kind) const = 0;
  // Fills in the results of one recording; `result` already contains set-up and findings. Called from several
  // threads at once.
  virtual void analyse(const CampaignTrial& trial, const TrialRecording& recording,
                       TrialResult& result) const = 0;
  // Uses only the results, in the order of the campaign: the usable ones of the kinds that it takes. Empty if
  // they contain nothing for it.
  virtual CampaignConclusions conclude(std::span<const TrialResult* const> results) const = 0;
};

// In the order in which their conclusions appear in the report. Several may take the same trial; each uses
// its own names of quantities and series.
std::span<const TrialAnalysis* const> all_analyses();

}  // namespace sandhopper
