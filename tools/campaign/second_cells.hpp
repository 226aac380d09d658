#pragma once
#include <optional>

#include "tools/campaign/read_table.hpp"

namespace sandhopper {

// Columns of a further load cell that no trial uses: in the force's unit, and loaded with it. If all of them
// carry the foot their readings must be added. Not meant are copies of the same reading (linear in it within
// their digits), filtered ones, set-points, the axes of a vector, and cells with less than 1 % of the force.
// Cells whose names differ in one number, letter or side make the trial unusable until the user decides;
// others give a note.
std::optional<Finding> second_cell(const CsvTable& table, const std::string& file, const Campaign& campaign,
                                   const CampaignTrial& trial);

// True for names that differ in one number, single letter or side: "Load cell A (N)" and "Load cell B (N)".
bool are_named_alike(std::string_view one, std::string_view other);

}  // namespace sandhopper
