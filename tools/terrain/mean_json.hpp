#pragma once
#include <cmath>
#include <nlohmann/json.hpp>

#include "terrain/trial_statistics.hpp"

namespace sandhopper {

// JSON has neither NaN nor infinity; they become null.
inline nlohmann::ordered_json number_or_null(double value) {
  return std::isfinite(value) ? nlohmann::ordered_json(value) : nlohmann::ordered_json(nullptr);
}

inline nlohmann::ordered_json mean_json(const TrialMean& mean) {
  return {{"value", number_or_null(mean.value)},
          {"ci95", {number_or_null(mean.ci95_low), number_or_null(mean.ci95_high)}},
          {"trials", mean.trials}};
}

}  // namespace sandhopper
