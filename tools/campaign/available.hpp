#pragma once
#include <map>
#include <string>
#include <vector>

#include "config/node.hpp"
#include "tools/campaign/finding.hpp"

namespace sandhopper {

// Values of one set-up key that the lab can set for its next trial: single values, a range, or words. In the
// key's unit.
struct AvailableValues {
  std::vector<double> values;
  bool is_range = false;  // True: `values` are the two ends of the range.
  std::vector<std::string> words;
};

// Key: set-up key (its name ends with its unit).
using Available = std::map<std::string, AvailableValues>;

// Reads the table [available] of a campaign.toml:
//   plate_diameter_m = [0.06, 0.08]                these values
//   release_height_m = { from = 0.05, to = 0.30 }  any value in between
//   profile          = ["stop_and_withdraw"]       words
// An entry that cannot be parsed is left out, with a note in `findings`. `file`: file name for the notes.
Available read_available(const ConfigNode& table, const std::string& file, std::vector<Finding>& findings);

}  // namespace sandhopper
