#include "tools/campaign/plant_doubt.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>

#include "tools/campaign/written_unit.hpp"

namespace sandhopper {
namespace {

// True for an axis that is recorded in metres.
bool is_linear_stage(const CsvTable& table, CampaignPlant plant) {
  if (plant != CampaignPlant::rotary_axis) return false;
  return std::any_of(table.names.begin(), table.names.end(), [](const auto& name) {
    const auto unit = unit_in_name(name);
    return unit && (unit->dimension == "length" || unit->dimension == "speed");
  });
}

}  // namespace

PlantDoubt doubt_plant(const CsvTable& table, CampaignPlant plant) {
  PlantDoubt doubt;
  std::vector<std::string> foreign;
  std::optional<CampaignPlant> other;
  for (std::size_t i = 0; i < table.names.size(); ++i) {
    const auto owner = plant_with_channel(table.names[i]);
    if (!owner || *owner == plant) continue;
    if (!other) doubt.first = i, other = owner;
    foreign.push_back(table.names[i]);
  }
  if (other) {
    doubt.kind = FindingKind::wrong_plant;
    doubt.channel = foreign.front();
    doubt.what =
        fmt::format("{} {} of plant \"{}\", the campaign's is \"{}\"", fmt::join(foreign, ", "),
                    foreign.size() == 1 ? "is a channel" : "are channels", name_of(*other), name_of(plant));
    doubt.cure = "correct plant in campaign.toml, or put this trial into a campaign of its own";
    return doubt;
  }
  doubt.kind = FindingKind::unknown_column;
  doubt.what = fmt::format("no column is a channel of plant \"{}\"; the columns are {}", name_of(plant),
                           fmt::join(table.names, ", "));
  doubt.cure =
      is_linear_stage(table, plant)
          ? "a linear stage obeys the equation of plant \"rotary_axis\" with m for rad, N for N m and kg "
            "for kg m^2: position_rad = { column = \"NAME\", unit = \"m\", scale = 1.0 } in [columns], "
            "inertia_kg_m2 = its mass"
          : "say in [columns] which column is which channel";
  return doubt;
}

}  // namespace sandhopper
