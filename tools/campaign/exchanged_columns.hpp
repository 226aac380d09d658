#pragma once
#include <optional>
#include <string>

#include "firmware/log/csv_import.hpp"
#include "tools/campaign/campaign.hpp"
#include "tools/campaign/unit_check.hpp"

namespace sandhopper {

struct Exchange {
  std::string what;
  std::string cure;  // The two lines of [columns] the right way round.
};

// Two mappings with exchanged columns: the file states a unit for each of the two columns that only the other
// channel can have, as for force_N = "Depth (in)" beside foot_z_m = "Load (lbf)". Empty if `column` is not
// one of such a pair, or if both mappings state unit and scale.
std::optional<Exchange> find_exchange(const CsvTable& table, const CampaignTrial& trial, CampaignPlant plant,
                                      const ColumnUnits& column);

}  // namespace sandhopper
