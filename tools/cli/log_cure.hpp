#pragma once
#include <fmt/format.h>

#include <filesystem>
#include <string>

#include "firmware/log/mcap_damage.hpp"

namespace sandhopper::cli {

// Cure for a log that cannot be read: of a damaged one the rest can be saved.
inline std::string cure_of(const mcap::Error& error, const std::filesystem::path& log,
                           const char* otherwise) {
  if (dynamic_cast<const mcap::Damaged*>(&error) == nullptr) return otherwise;
  return fmt::format("save what can be read of it: hop recover '{}'", log.string());
}

}  // namespace sandhopper::cli
