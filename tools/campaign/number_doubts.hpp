#pragma once
#include <optional>
#include <string>
#include <vector>

#include "tools/campaign/read_table.hpp"

namespace sandhopper {

// Findings about the numbers of a column as the file holds them, before any unit: a fill value such as -999,
// and the numbers of the time. A fill value is only noted if the mapping states unit and scale.
std::vector<Finding> doubts_of_numbers(const CsvTable& table, const std::string& file,
                                       const CampaignTrial& trial, std::size_t column, bool is_stated);

// Finding about an unused column whose name is that of a channel in another unit; empty for another name.
std::optional<Finding> misnamed_column(const CsvTable& table, const std::string& file, CampaignPlant plant,
                                       const CampaignTrial& trial, std::size_t column);

}  // namespace sandhopper
