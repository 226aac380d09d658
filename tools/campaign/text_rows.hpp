#pragma once
#include <cstdint>
#include <functional>
#include <iosfwd>
#include <string>
#include <vector>

#include "firmware/log/csv_import.hpp"

namespace sandhopper {

// A line of a table's file as text.
struct TextRow {
  std::uint64_t line = 0;          // from 1
  std::string_view text{};         // the whole line
  std::vector<TableCell> cells{};  // of a line below the names; empty above them
  bool is_remark = false;
};

// Calls `look` for every line that is not blank, remarks included.
void for_each_text_row(std::istream& in, const CsvLayout& layout, const CsvFormat& format,
                       const std::function<void(const TextRow&)>& look);

// Text of the table's column `i` in that row; empty if the row has no such cell.
std::string_view text_of_column(const TextRow& row, const CsvTable& table, std::size_t i);

}  // namespace sandhopper
