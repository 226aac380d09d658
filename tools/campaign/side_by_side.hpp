#pragma once
#include <cstddef>
#include <string>
#include <vector>

#include "firmware/log/csv_import.hpp"

namespace sandhopper {

// Recordings side by side in one table: t1, theta1, t2, theta2. Each group holds the columns of one
// recording, with a time of its own; `base` is a column's name without the number that tells the recordings
// apart.
struct SideColumn {
  std::size_t column = 0;
  std::string base;
};
using SideRecording = std::vector<SideColumn>;

// Empty for a table of one recording: there are fewer than two groups, a group has no time or nothing else,
// or it has a column that the first group lacks.
std::vector<SideRecording> recordings_side_by_side(const CsvTable& table);

}  // namespace sandhopper
