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

// What one trial says about the ground, small enough to keep for thousands of them. Everything a campaign
// concludes is made from these alone, so that a campaign analysed in parts and merged gives the same numbers.
namespace sandhopper {

// One figure of a trial. The name ends in its unit: "stiffness_observer_wls_N_per_m".
struct TrialQuantity {
  std::string name;
  double value = std::numeric_limits<double>::quiet_NaN();
  double standard_error = std::numeric_limits<double>::quiet_NaN();  // NaN: the trial alone does not say
  std::string invalid{};  // why it must not be used; such figures are shown and not pooled
};

// Numbers that belong together, e.g. mean force on a grid of depths, or the sums of a regression.
using TrialSeries = std::map<std::string, std::vector<double>, std::less<>>;

struct TrialResult {
  std::size_t index = 0;  // place in the campaign
  std::string trial;      // its file as written
  std::string kind;
  bool usable = false;
  std::vector<std::pair<std::string, double>> setup{};  // its numbers
  std::vector<Finding> findings{};
  std::vector<std::string> ruled_out{};  // conclusions that this recording does not allow, and why
  std::vector<TrialQuantity> quantities{};
  TrialSeries series{};

  const TrialQuantity* find(std::string_view name) const;
  double value(std::string_view name) const;        // NaN where there is none or it must not be used
  double setup_number(std::string_view key) const;  // NaN where there is none
};

TrialResult result_of(const CampaignTrial& trial, const TrialRecording& recording);

// Numbers survive to the last bit.
nlohmann::ordered_json to_json(const TrialResult& result);
nlohmann::ordered_json to_json(const Finding& finding);
// Both throw nlohmann::json::exception where `json` is not what to_json writes.
Finding finding_from_json(const nlohmann::ordered_json& json);
TrialResult trial_result_from_json(const nlohmann::ordered_json& json);

// One figure over trials: mean and 95 % interval from the spread between trials. Trials without it, or whose
// figure must not be used, do not count.
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
