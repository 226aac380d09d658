#pragma once
#include <optional>
#include <string>
#include <string_view>

#include "firmware/log/csv_import.hpp"
#include "tools/calibrate/tap_alignment.hpp"

namespace sandhopper::calibrate {

// Seconds in a unit of time: "s", "ms", "us", "ns", "min". A unit line's "(us)", "[ms]" and "µs" are
// accepted. Empty for other words.
std::optional<double> seconds_in(std::string_view unit);

// The unit, other than seconds, in which the foreign times must be read so that the taps fit ours; empty if
// there is none.
std::optional<std::string> unit_that_fits(const TapTimes& ours, const Series& foreign);

// Problems of the times that make a table useless; `name` is the file's. Each gives the text of the error and
// its cure.
struct TimeProblem {
  std::string text, cure;
};
// Most rows have a time that is no number: marks between thousands, or other characters.
std::optional<TimeProblem> times_that_are_no_numbers(const std::string& name, const CsvTable& table);
// At least half of the rows are copies of the row before, and no row has only its time.
std::optional<TimeProblem> rows_that_stand_twice(const std::string& name, const CsvTable& table,
                                                 const std::vector<double>& time_s);
// At least half of the rows have the time of the row before, because the times have too few digits.
std::optional<TimeProblem> times_too_coarse(const std::string& name, const std::vector<double>& time_s,
                                            std::size_t column_number);

}  // namespace sandhopper::calibrate
