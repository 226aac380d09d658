#pragma once
#include <optional>
#include <string>
#include <vector>

#include "firmware/log/csv_import.hpp"
#include "tools/campaign/plant_kind.hpp"

// Plant of a foreign table, guessed from the names and units of its columns.
namespace sandhopper {

std::optional<CampaignPlant> guess_plant(const CsvTable& table);

// "because a time and a height ("y_cm") alone fit no other plant" if the table has one height or acceleration
// besides times, counters of rows, ticks of a clock and one speed, with its unit; else empty.
std::string why_falling_body(const CsvTable& table);

// Lines for the user who must name the plant: the line of the names, each column with its unit and first
// value, and the columns that each plant needs.
std::vector<std::string> describe_columns(const CsvTable& table);

}  // namespace sandhopper
