#pragma once
#include <cstdint>
#include <map>
#include <string>
#include <vector>

#include "tools/campaign/text_rows.hpp"

namespace sandhopper {

// A column that marks rows as bad, by its name and by its cells.
struct FlagColumn {
  std::size_t column = 0;
  std::uint64_t rows = 0, marked = 0;  // with a cell; of these marked as bad
  std::uint64_t first_line = 0;        // the first one
  std::vector<std::string> texts{};    // of the marked cells, in lower case
  bool is_number = false;              // all cells are numbers: `select` can take the other rows
  double good = 1.0;                   // the number in the most other rows
};

// Finds them among the columns that are called valid, ok, invalid, error, fault, status, quality or flag. Of
// valid and ok the bad rows hold 0 or false; of invalid, error and fault anything but 0, false, none and ok;
// of the others a word such as ERR, or that one of 0 and 1 (false and true) which is rarer. A column of other
// numbers than whole ones is a measurement.
class FlagColumns {
 public:
  explicit FlagColumns(const CsvTable& table);

  void take(const TextRow& row);
  std::vector<FlagColumn> found() const;

 private:
  enum class Meaning : std::uint8_t { none, good, bad, either };
  struct Cells {
    std::uint64_t rows = 0, first_line = 0;
  };
  struct Column {
    Meaning meaning = Meaning::none;
    std::map<std::string, Cells> cells{};
  };
  static Meaning meaning_of(std::string_view name);
  static bool is_marked(const Column& column, const std::string& text);

  const CsvTable& table_;
  std::vector<Column> columns_;
};

}  // namespace sandhopper
