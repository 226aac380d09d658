#pragma once
#include <optional>
#include <string>
#include <string_view>

#include "tools/campaign/plant_kind.hpp"

namespace sandhopper {

// A column that bears a channel's name in another unit: "load_cell_force_kN", "foot_z [mm]".
struct MisnamedUnit {
  std::string channel;            // the channel it seems to be
  std::string unit;               // as written
  std::optional<double> scale{};  // to the channel's unit, where the unit is known
};

std::optional<MisnamedUnit> misnamed_unit(std::string_view column, CampaignPlant plant);

}  // namespace sandhopper
