#pragma once
#include <cstdio>
#include <filesystem>
#include <optional>
#include <string>

#include "tools/campaign/trial_recording.hpp"

namespace sandhopper {

// A ready campaign over recordings that are not part of this tree; none, said loudly, where they are missing.
inline std::optional<Campaign> shared_campaign(const std::string& name) {
  auto campaign = load_campaign(std::filesystem::path(SANDHOPPER_SOURCE_DIR) / "config/campaigns" / name);
  for (const auto& trial : campaign.trials)
    if (!std::filesystem::exists(trial.file)) {
      std::printf("*** SKIPPED: %s is not there; put the recordings beside this repository ***\n",
                  trial.file.lexically_normal().c_str());
      return std::nullopt;
    }
  return campaign;
}

}  // namespace sandhopper
