#include "tools/report/envelope.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace sandhopper {
namespace {

std::vector<bool> rows_of_strides(const ReportData& data, double margin_s) {
  std::vector<bool> keep(data.time_s.size(), false);
  for (const ReportStride& stride : data.strides) {
    const auto first = std::ranges::lower_bound(data.time_s, stride.touchdown_s - margin_s);
    const auto last = std::ranges::upper_bound(data.time_s, stride.liftoff_s + margin_s);
    std::fill(keep.begin() + (first - data.time_s.begin()), keep.begin() + (last - data.time_s.begin()),
              true);
  }
  return keep;
}

// A contiguous range of rows, first to first + count - 1. With count 1 the row is kept; otherwise two rows
// replace the range, with the least and the greatest value of each column.
struct Run {
  std::size_t first;
  std::size_t count;
};

std::vector<Run> runs_of(const std::vector<bool>& keep, std::size_t length) {
  std::vector<Run> runs;
  for (std::size_t row = 0; row < keep.size();) {
    std::size_t end = row + 1;
    if (!keep[row]) {
      while (end < keep.size() && end - row < length && !keep[end]) ++end;
    }
    runs.push_back({row, end - row});
    row = end;
  }
  return runs;
}

std::vector<double> thinned(const std::vector<double>& values, const std::vector<Run>& runs) {
  std::vector<double> result;
  result.reserve(2 * runs.size());
  for (const Run& run : runs) {
    if (run.count == 1) {
      result.push_back(values[run.first]);
      continue;
    }
    double least = std::numeric_limits<double>::quiet_NaN();
    double greatest = least;
    for (std::size_t row = run.first; row < run.first + run.count; ++row) {
      least = std::fmin(least, values[row]);  // fmin and fmax ignore NaN
      greatest = std::fmax(greatest, values[row]);
    }
    result.push_back(least);
    result.push_back(greatest);
  }
  return result;
}

}  // namespace

ReportData envelope(ReportData data, const EnvelopeLimits& limits, std::size_t& run) {
  run = 1;
  const std::size_t rows = data.time_s.size();
  if (rows <= limits.max_rows) return data;

  const std::vector<bool> keep = rows_of_strides(data, limits.stride_margin_s);
  const auto kept = static_cast<std::size_t>(std::ranges::count(keep, true));
  const std::size_t room = std::max(limits.max_rows - std::min(kept, limits.max_rows), limits.min_other_rows);
  run = std::max<std::size_t>(1, (2 * (rows - kept) + room - 1) / room);
  if (run < 3) {  // replacing two rows by two rows would gain nothing
    run = 1;
    return data;
  }

  const std::vector<Run> runs = runs_of(keep, run);
  for (ReportColumn& column : data.columns) column.values = thinned(column.values, runs);
  std::vector<double> time_s;
  for (const Run& part : runs) {
    time_s.push_back(data.time_s[part.first]);
    if (part.count > 1) time_s.push_back(data.time_s[part.first + part.count / 2]);
  }
  data.time_s = std::move(time_s);
  return data;
}

}  // namespace sandhopper
