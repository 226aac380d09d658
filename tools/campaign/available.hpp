#pragma once
#include <map>
#include <string>
#include <vector>

#include "config/node.hpp"
#include "tools/campaign/finding.hpp"

namespace sandhopper {

// The values of one set-up key that a lab can set for its next trial: single ones, a range, or words.
struct AvailableValues {
  std::vector<double> values;
  bool is_range = false;  // then values are its two ends, in the key's unit
  std::vector<std::string> words;
};

// One entry a set-up key; the key's name ends with its unit.
using Available = std::map<std::string, AvailableValues>;

// Reads the table [available] of a campaign.toml:
//   plate_diameter_m = [0.06, 0.08]                these
//   release_height_m = { from = 0.05, to = 0.30 }  any in between
//   profile          = ["stop_and_withdraw"]       words
// A key that cannot be understood becomes a finding in `findings`, with `file` as its place, and is left out.
Available read_available(const ConfigNode& table, const std::string& file, std::vector<Finding>& findings);

}  // namespace sandhopper
