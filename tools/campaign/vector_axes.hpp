#pragma once
#include <cstddef>
#include <string>
#include <vector>

#include "firmware/log/csv_import.hpp"

namespace sandhopper {

// Columns that are the x, y and z of one vector: "Acceleration x (m/s^2)", "accY", "gFz".
struct VectorAxes {
  std::vector<std::size_t> columns;  // of the table: x, y, z; empty: the column is no axis of three
  std::vector<double> mean_size;     // mean |value| of each
  std::size_t taken = 0;             // 0: x

  bool found() const { return !columns.empty(); }
  char letter() const { return static_cast<char>('x' + taken); }
};

// The vector that `column` belongs to, by names that differ in one letter x, y or z; `taken` is that column.
VectorAxes axes_of(const CsvTable& table, std::size_t column);

}  // namespace sandhopper
