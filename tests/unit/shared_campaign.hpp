#pragma once
#include <cstdio>
#include <filesystem>
#include <optional>
#include <string>

#include "tools/campaign/trial_recording.hpp"

namespace sandhopper {

// A ready campaign over recordings that are not part of this tree; none, said loudly, where they are missing.
inline std::optional<Campaign> shared_campaign(const std::string& name) {
  try {
    return load_campaign(std::filesystem::path(SANDHOPPER_SOURCE_DIR) / "config/campaigns" / name);
  } catch (const ConfigError& error) {
    if (error.problems().front().key != "data") throw;
    std::printf("*** SKIPPED: %s ***\n", error.what());
    return std::nullopt;
  }
}

}  // namespace sandhopper
