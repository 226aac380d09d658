#pragma once
#include <cstddef>

#include "tools/report/report_data.hpp"

namespace sandhopper {

struct EnvelopeLimits {
  std::size_t max_rows = 60'000;       // aimed at; strides are kept whole even if that takes more
  double stride_margin_s = 0.3;        // kept whole before touchdown and after liftoff
  std::size_t min_other_rows = 4'000;  // what the time between strides gets at least
};

// A log too long to show row by row: rows of the strides stay, runs of others become two rows that hold each
// column's least and greatest value. Returns the data unchanged when it is short enough. The length of the
// longest run, in rows, goes to `run`: 1 means nothing was thinned.
ReportData envelope(ReportData data, const EnvelopeLimits& limits, std::size_t& run);

}  // namespace sandhopper
