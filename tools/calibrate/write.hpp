#pragma once
#include <string>

#include "tools/calibrate/outcome.hpp"

namespace sandhopper::calibrate {

// A value as the file will hold it: two digits more than its interval has, or five significant ones.
std::string value_text(const CalibratedValue& value);

// The text of a configuration file, whose name stands in messages, with the values of one target in place and
// its record at the end, checked by the strict loader. Throws ConfigError and std::invalid_argument; nothing
// is written.
std::string with_calibration(const std::string& file_name, const std::string& text, const Outcome& outcome,
                             const Outcome::Target& target, const std::string& date);

}  // namespace sandhopper::calibrate
