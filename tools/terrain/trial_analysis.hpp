#pragma once
#include <nlohmann/json.hpp>
#include <span>
#include <string>
#include <vector>

#include "tools/report/study.hpp"
#include "tools/terrain/trial_result.hpp"

namespace sandhopper {

// What the trials of one sort say together.
struct CampaignConclusions {
  std::string answer{};              // one sentence, with which the page begins; empty: the first line
  std::vector<std::string> lines{};  // for the terminal
  nlohmann::ordered_json json = nlohmann::ordered_json::object();
  std::vector<StudySection> sections{};                       // of the page
  std::vector<std::pair<std::string, std::string>> tables{};  // name and text of CSV files: "profile"
};

// One sort of trial: what a single recording says, and what all of them say together. A new sort is one class
// and a line in trial_analysis.cpp.
class TrialAnalysis {
 public:
  TrialAnalysis() = default;
  virtual ~TrialAnalysis() = default;
  TrialAnalysis(const TrialAnalysis&) = delete;
  TrialAnalysis& operator=(const TrialAnalysis&) = delete;

  virtual std::string_view name() const = 0;  // "hops": key in the JSON
  virtual bool takes(CampaignPlant plant, TrialKind kind) const = 0;
  // Fills in what the recording tells; `result` holds set-up and findings already. From several threads at
  // once.
  virtual void analyse(const CampaignTrial& trial, const TrialRecording& recording,
                       TrialResult& result) const = 0;
  // From the results alone, in the order of the campaign: usable ones of the kinds it takes. Empty where they
  // hold nothing for it.
  virtual CampaignConclusions conclude(std::span<const TrialResult* const> results) const = 0;
};

// In the order in which their conclusions stand in the report. Several may take the same trial; each keeps to
// quantities and series of its own names.
std::span<const TrialAnalysis* const> all_analyses();

}  // namespace sandhopper
