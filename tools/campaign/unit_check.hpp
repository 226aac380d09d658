#pragma once
#include <optional>
#include <string>
#include <string_view>

#include "tools/campaign/written_unit.hpp"

namespace sandhopper {

// `unit` of a column whose unit its experimenter has not stated yet: nothing is computed from it.
inline constexpr std::string_view kUnknownUnit = "?";

// A column that is to become a channel, and what is known of its unit.
struct ColumnUnits {
  std::string column;
  std::string channel;
  std::string row_unit;     // its cell in the row of units, empty without one
  std::string stated_unit;  // `unit` of its mapping, empty where nothing is stated
  double scale = 1.0;
  bool has_scale = false;  // the mapping states a scale
  double largest = 0.0;    // of the column's numbers, for the arithmetic of the message
};

// The factor from the column's numbers to the channel's unit, or what must be cleared up first.
struct UnitVerdict {
  double scale = 1.0;
  std::string problem{};  // empty: the scale can be used
  std::string cure{};
};

// Holds the unit in the column's name, in the row of units and in `unit` against the channel's unit and
// `scale`:
//   factor f from the written unit to the channel's unit;  right where |scale| / f = 1 within kSameScale.
// `unit` alone gives the scale; it must agree with the file's own words as a scale must. `unit` and `scale`
// together are what the experimenter says: they must agree with each other where their ratio is one of two
// units, and the file's own words no longer count. A scale from another dimension (volts of a load cell) is
// taken where it is written down.
UnitVerdict check_unit(const ColumnUnits& column);

}  // namespace sandhopper
