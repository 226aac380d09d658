#pragma once
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "tools/campaign/text_rows.hpp"
#include "tools/campaign/written_unit.hpp"

namespace sandhopper {

// A unit that a line above the names states: "Force units: kN", "# Einheit Zeit; ms".
struct PreambleUnit {
  std::uint64_t line = 0;
  std::string text{};  // the whole line
  WrittenUnit unit{};
  std::vector<std::string> subject{};  // the words before "unit", in lower case
};

// Finds the units behind the word "unit" in lines above the names.
class PreambleUnits {
 public:
  explicit PreambleUnits(const CsvTable& table) : table_(table) {}

  void take(const TextRow& row);
  std::vector<PreambleUnit> take_units() { return std::move(units_); }

 private:
  const CsvTable& table_;
  std::vector<PreambleUnit> units_;
};

// The unit for a column: that of the line with a word of its name, else the first of the dimension. Without a
// dimension only a line with the name counts. Null if there is none.
const PreambleUnit* unit_above_for(const std::vector<PreambleUnit>& units, std::string_view column,
                                   std::string_view dimension);

}  // namespace sandhopper
