#pragma once
#include <optional>
#include <string>

#include "firmware/log/csv_import.hpp"
#include "tools/campaign/finding.hpp"
#include "tools/campaign/plant_kind.hpp"

namespace sandhopper {

// The reason why no column of a table became a channel of the campaign's plant.
struct PlantDoubt {
  FindingKind kind{};
  std::optional<std::size_t> first{};  // the first column that belongs to another plant
  std::string channel{};
  std::string what{};
  std::string cure{};
};

PlantDoubt doubt_plant(const CsvTable& table, CampaignPlant plant);

}  // namespace sandhopper
