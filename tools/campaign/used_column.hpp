#pragma once
#include <string>
#include <vector>

#include "tools/campaign/unit_check.hpp"

namespace sandhopper {

// A column as it was read: channel = scale x column + offset.
struct UsedColumn {
  std::string channel;
  std::string column;
  std::string
      unit{};  // Unit of the column's numbers; empty if nobody states it and `scale` is that of no unit.
  double scale = 1.0;
  double offset = 0.0;
  bool in_file = false;              // True if the file itself (name or row of units) states this unit.
  bool is_stated = false;            // True if its mapping states `unit` and `scale`.
  std::vector<std::string> added{};  // further columns that are added to it
};

// `scale`: the factor that check_unit found.
UsedColumn used_column(const ColumnUnits& column, double scale, double offset, bool is_stated);

// The same column counted the other way.
UsedColumn reversed(UsedColumn column);

// The same column, if its numbers are in a unit that is `factor` times the present one.
UsedColumn in_other_unit(UsedColumn column, double factor);

// Its line of [columns]: force_N = { column = "F (kN)", unit = "kN", scale = 1000 }.
std::string mapping_line(const UsedColumn& column);

// The same with a unit, so that its unit and scale are the user's own statement.
std::string confirming_line(const UsedColumn& column);

// Advice for a channel with doubtful values: correct its scale, or confirm it with the line that is given.
std::string scale_cure(const UsedColumn& column);

// `column` of a mapping: "A", or ["A", "B"] for columns that are added.
std::string column_text(const std::string& column, const std::vector<std::string>& added);

// A text between quotation marks of TOML.
std::string toml_text(std::string_view text);

}  // namespace sandhopper
