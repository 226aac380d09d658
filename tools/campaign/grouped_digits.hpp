#pragma once
#include <string>
#include <vector>

#include "tools/campaign/text_rows.hpp"

namespace sandhopper {

// Finds columns of whole numbers whose thousands are divided by the sign that is read as the decimal one:
// 987, 1.004, 1.023. Evidence in one column: some cells bear the mark, always with exactly three digits
// behind it and one to three digits, not beginning with 0, before it; the others have at most three digits.
// Numbers with three decimals bear the mark in every cell, and numbers without final zeros have one or two
// decimals in every tenth cell.
class GroupedDigits {
 public:
  explicit GroupedDigits(const CsvTable& table);

  void take(const TextRow& row);
  // For each column a cell that may be read in two ways, or an empty text.
  std::vector<std::string> cells() const;

 private:
  struct Column {
    std::string marked;  // the first cell with the mark
    bool has_unmarked = false;
    bool is_decided = false;  // a cell can only be read in one way
  };
  void take(Column& column, std::string_view text);

  const CsvTable& table_;
  std::vector<Column> columns_;
  bool is_clear_ = false;  // the file shows both signs in one number (6,064.4), or the owner states them
};

}  // namespace sandhopper
