#pragma once
#include <optional>
#include <string>
#include <string_view>

#include "tools/campaign/written_unit.hpp"

namespace sandhopper {

// `unit` of a column whose unit is not stated yet; nothing is computed from such a column.
inline constexpr std::string_view kUnknownUnit = "?";

// A column that will become a channel, and what is known about its unit.
struct ColumnUnits {
  std::string column;
  std::string channel;
  std::string row_unit;      // its cell in the row of units; empty without such a row
  std::string row_source{};  // words for another place of `row_unit` in the file
  std::string stated_unit;   // `unit` of its mapping; empty if not stated
  double scale = 1.0;
  bool has_scale = false;  // True if the mapping states a scale.
  double largest = 0.0;    // Largest number of the column, for the message.
};

struct FilesUnit {
  std::optional<WrittenUnit> unit;
  std::string where;
};

// Unit in the row of units, else in the column's name.
FilesUnit unit_in_file(const ColumnUnits& column);

// Factor from the column's numbers to the channel's unit, or the contradiction to be resolved first.
struct UnitVerdict {
  double scale = 1.0;
  std::string problem{};  // empty: `scale` can be used
  std::string cure{};
  std::string overruled{};  // The unit in the file that `unit` and `scale` overrule, with the arithmetic.
};

// Compares the unit in the column's name, in the row of units and in `unit` with the channel's unit and
// `scale`. f: factor from the written unit to the channel's unit; right if |scale| / f = 1 within kSameScale.
// `unit` alone gives the scale, but it must agree with the file. `unit` and `scale` together overrule the
// file, which is told (`overruled`); they only must not contradict each other (their ratio must not be that
// of two other units of the dimension). A scale from another dimension (volts of a load cell) is accepted if
// it is written down.
UnitVerdict check_unit(const ColumnUnits& column);

}  // namespace sandhopper
