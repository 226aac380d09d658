#pragma once
#include <cstdint>
#include <filesystem>
#include <iosfwd>
#include <vector>

#include "terrain/ground_summary.hpp"

// Ground records of a trial's log as tables: /profile and /ground. They come once per stride, so they do not
// fit in the table of the cycles.
namespace sandhopper {

struct GroundRecords {
  std::vector<StrengthProfile> profiles{};
  std::vector<GroundSummary> summaries{};
};

// Throws mcap::Error if the log cannot be read. Both are empty for logs of versions without them.
GroundRecords ground_records(const std::filesystem::path& log);

// One row per stride and depth: force and its 95 % band, secant, tangent stiffness of the cell and its 95 %
// band, independent observations in the cell, and 1 in `visited` between the smallest and largest depth that
// the trial has reached so far. Column names contain their units.
void write_profile_csv(const std::vector<StrengthProfile>& profiles, std::ostream& out);

// One row per stride: every number of GroundSummary under its name, with its 95 % interval in the columns
// ..._ci95_low and ..._ci95_high. An infinite limit is "inf".
void write_ground_csv(const std::vector<GroundSummary>& summaries, std::ostream& out);

}  // namespace sandhopper
