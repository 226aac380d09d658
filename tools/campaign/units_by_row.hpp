#pragma once
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "tools/campaign/text_rows.hpp"

namespace sandhopper {

// A column whose cells are units, as a meter writes that changes its range by itself.
struct UnitsByRow {
  struct Unit {
    std::string text;
    std::uint64_t first_line = 0;
  };
  std::size_t column = 0;
  std::size_t target = 0;     // the column of numbers whose units it holds
  std::vector<Unit> units{};  // the different ones
};

// Finds them. The target is the nearest column of numbers before it, or the next one if there is none.
class UnitColumns {
 public:
  explicit UnitColumns(const CsvTable& table) : table_(table), columns_(table.names.size()) {}

  void take(const TextRow& row);
  std::vector<UnitsByRow> found() const;

 private:
  struct Column {
    std::vector<UnitsByRow::Unit> units;
    bool has_others = false;  // a cell that is neither a unit nor empty
  };
  std::optional<std::size_t> target_of(std::size_t i) const;

  const CsvTable& table_;
  std::vector<Column> columns_;
};

}  // namespace sandhopper
