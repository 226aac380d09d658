#pragma once
#include <optional>
#include <string>

#include "firmware/log/csv_import.hpp"
#include "tools/campaign/campaign.hpp"

namespace sandhopper {

// The finding of a column that two channels of different units take: a column holds one quantity. Two
// channels of one unit may share one, as left and right of a robot with one motor do.
std::optional<Finding> shared_column(const CsvTable& table, const CampaignTrial& trial,
                                     const std::string& campaign_file);

}  // namespace sandhopper
