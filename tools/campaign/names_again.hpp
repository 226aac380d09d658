#pragma once
#include <cstdint>
#include <string>
#include <vector>

#include "tools/campaign/text_rows.hpp"

namespace sandhopper {

// A line below the first rows that names the columns again, or states their units again.
struct NamesLine {
  std::uint64_t line = 0;
  bool are_units = false;
  std::vector<std::string> texts{};  // index as in CsvTable::names
};

// Finds such lines: every cell is a word, and one is a name of the table, a name with a unit, or a time.
class NamesAgain {
 public:
  explicit NamesAgain(const CsvTable& table) : table_(table) {}

  void take(const TextRow& row);
  std::vector<NamesLine> take_lines() { return std::move(lines_); }

 private:
  bool is_name(std::string_view text) const;

  const CsvTable& table_;
  std::vector<NamesLine> lines_;
};

}  // namespace sandhopper
