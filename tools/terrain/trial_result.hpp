#pragma once
#include <cstddef>
#include <limits>
#include <map>
#include <nlohmann/json_fwd.hpp>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "tools/campaign/trial_recording.hpp"

// Results of one trial on the ground, small enough to keep thousands of them. All conclusions of a campaign
// are made from these results alone, so a campaign analysed in parts and merged gives the same numbers.
namespace sandhopper {

// One value of a trial. Its name ends in its unit: "stiffness_observer_wls_N_per_m".
struct TrialQuantity {
  std::string name;
  double value = std::numeric_limits<double>::quiet_NaN();
  double standard_error = std::numeric_limits<double>::quiet_NaN();  // NaN if a single trial does not
                                                                     // determine it
  std::string invalid{};  // reason why it must not be used; such values are shown but not pooled
};

// Arrays of numbers, such as mean force on a grid of depths, or the sums of a regression.
using TrialSeries = std::map<std::string, std::vector<double>, std::less<>>;

struct TrialResult {
  std::size_t index = 0;  // index in the campaign
  std::string trial;      // its file as written in the campaign
  std::string kind;
  bool usable = false;
  std::vector<std::pair<std::string, double>> setup{};  // numeric values of the set-up
  std::vector<Finding> findings{};
  std::vector<std::string> ruled_out{};  // conclusions that this recording does not allow, with the reason
  std::vector<TrialQuantity> quantities{};
  TrialSeries series{};

  const TrialQuantity* find(std::string_view name) const;
  double value(std::string_view name) const;        // NaN if there is none or it must not be used
  double setup_number(std::string_view key) const;  // NaN if there is none
};

TrialResult result_of(const CampaignTrial& trial, const TrialRecording& recording);

// Numbers are kept exactly.
nlohmann::ordered_json to_json(const TrialResult& result);
nlohmann::ordered_json to_json(const Finding& finding);
// Both throw nlohmann::json::exception if `json` was not written by to_json.
Finding finding_from_json(const nlohmann::ordered_json& json);
TrialResult trial_result_from_json(const nlohmann::ordered_json& json);

// One quantity pooled over trials: mean and 95 % interval from the spread between trials. Trials that lack
// it, or whose value must not be used, are ignored.
struct PooledQuantity {
  std::string name;
  std::size_t trials = 0;
  double value = 0.0;
  double ci95_low = 0.0, ci95_high = 0.0;
  double standard_deviation = 0.0;
};
// In the order in which the names first appear.
std::vector<PooledQuantity> pool_quantities(std::span<const TrialResult* const> results);
std::vector<double> values_of(std::span<const TrialResult* const> results, std::string_view name);

}  // namespace sandhopper
