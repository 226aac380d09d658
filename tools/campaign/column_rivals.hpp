#pragma once
#include <optional>
#include <string>
#include <vector>

#include "firmware/log/csv_import.hpp"
#include "tools/campaign/plant_kind.hpp"
#include "tools/campaign/written_unit.hpp"

namespace sandhopper {

// Unit of a column: from the row of units, else from its name.
std::optional<WrittenUnit> unit_of_column(const CsvTable& table, std::size_t column);

// Columns that fit `channel` by name or unit as `taken` does, in the order of the table.
std::vector<std::size_t> rivals_of_column(const CsvTable& table, CampaignPlant plant,
                                          const std::string& channel, std::size_t taken);

// The same for the time: columns that are called a time or are in a unit of time.
std::vector<std::size_t> rivals_of_time(const CsvTable& table, std::size_t taken);

// Two angles and two currents: both sides of a hopper's leg.
bool has_two_motors(const CsvTable& table);

// `column "F2 (N)" fits as well; to take it, name it in [columns]`; empty without rivals.
std::string rivals_in_words(const CsvTable& table, const std::vector<std::size_t>& rivals);

}  // namespace sandhopper
