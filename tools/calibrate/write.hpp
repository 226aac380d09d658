#pragma once
#include <string>

#include "tools/calibrate/outcome.hpp"

namespace sandhopper::calibrate {

// Text of the value as written to the file: two decimals after the first digit of its interval, or five
// significant digits.
std::string value_text(const CalibratedValue& value);

// Returns the text of a configuration file with the values of one target replaced in place and its record
// appended, after the strict loader accepted it. `file_name` is used in messages. Throws ConfigError and
// std::invalid_argument. No file is written.
std::string with_calibration(const std::string& file_name, const std::string& text, const Outcome& outcome,
                             const Outcome::Target& target, const std::string& date);

}  // namespace sandhopper::calibrate
