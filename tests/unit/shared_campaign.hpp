#pragma once
#include <cstdio>
#include <filesystem>
#include <optional>
#include <string>

#include "tools/campaign/trial_recording.hpp"
#include "tools/terrain/campaign_analysis.hpp"

namespace sandhopper {

// A ready campaign whose recordings are not in this source tree. Prints a warning and returns nothing if they
// are missing.
inline std::optional<Campaign> shared_campaign(const std::string& name) {
  try {
    return load_campaign(std::filesystem::path(SANDHOPPER_SOURCE_DIR) / "config/campaigns" / name);
  } catch (const ConfigError& error) {
    if (error.problems().front().key != "data") throw;
    std::printf("*** SKIPPED: %s ***\n", error.what());
    return std::nullopt;
  }
}

// The "conclusions" that `hop terrain` writes; null if the recordings are missing.
inline nlohmann::ordered_json shared_conclusions(const std::string& name) {
  const auto campaign = shared_campaign(name);
  if (!campaign) return nullptr;
  return report_on(analyse_campaign(*campaign, {.threads = 2})).json.at("conclusions");
}

}  // namespace sandhopper
