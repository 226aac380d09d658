#pragma once
#include <cstddef>

#include "tools/report/report_data.hpp"

namespace sandhopper {

struct EnvelopeLimits {
  std::size_t max_rows = 60'000;  // target of the number of rows; strides are kept whole even if that takes
                                  // more
  double stride_margin_s = 0.3;   // rows kept before touchdown and after liftoff of each stride
  std::size_t min_other_rows = 4'000;  // least number of rows for the time between strides
};

// Thins a log that is too long to show row by row. Rows of strides stay. Every run of other rows becomes two
// rows with the least and the greatest value of each column. Data with at most max_rows rows are returned
// unchanged. `run`: length of the longest run in rows; 1: nothing was thinned.
ReportData envelope(ReportData data, const EnvelopeLimits& limits, std::size_t& run);

}  // namespace sandhopper
