#include "tools/campaign/text_rows.hpp"

#include <algorithm>

namespace sandhopper {

void for_each_text_row(std::istream& in, const CsvLayout& layout, const CsvFormat& format,
                       const std::function<void(const TextRow&)>& look) {
  TextLines lines(in, layout.encoding, lines_ahead(format));
  const auto names = std::max(layout.header_line, layout.units_line);
  TextRow row;
  for (std::string line; lines.next(line);) {
    ++row.line;
    row.text = line;
    row.cells.clear();
    row.is_remark = is_remark(line);
    if (trimmed_cell(line).empty()) continue;
    std::string mark;
    if (row.line > names) split_csv_cells(without_mark(line, mark), layout.separator, row.cells);
    if (layout.rows_are_counted && row.cells.size() == layout.row_cells) row.cells.erase(row.cells.begin());
    look(row);
  }
}

std::string_view text_of_column(const TextRow& row, const CsvTable& table, std::size_t i) {
  const auto number = table.numbers[i];
  return number >= 1 && number <= row.cells.size() ? row.cells[number - 1].text : std::string_view{};
}

}  // namespace sandhopper
