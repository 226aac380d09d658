#pragma once
#include <string>

#include "firmware/log/csv_import.hpp"

namespace sandhopper {

// Advice for an issue of the table reader. For a cell that is not a number it depends on the text: a unit
// behind the number, a decimal comma, thousands, or a negative number in brackets. `separator`: of the cells.
std::string cure_for_cells(const CsvIssue& issue, char separator);

}  // namespace sandhopper
