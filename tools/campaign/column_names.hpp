#pragma once
#include <optional>
#include <string>
#include <string_view>

#include "tools/campaign/plant_kind.hpp"

namespace sandhopper {

// A column with the name of a channel but another unit: "load_cell_force_kN", "foot_z [mm]".
struct MisnamedUnit {
  std::string channel;            // The channel it seems to be.
  std::string unit;               // as written
  std::optional<double> scale{};  // Factor to the channel's unit; empty if the unit is unknown.
};

// Empty if the column is no channel's name with another unit.
std::optional<MisnamedUnit> misnamed_unit(std::string_view column, CampaignPlant plant);

}  // namespace sandhopper
