#pragma once
#include <cstdint>
#include <filesystem>
#include <iosfwd>
#include <vector>

#include "terrain/ground_summary.hpp"

// The ground in a trial's log, as tables: /profile and /ground, which come once a stride and
// have no place in the table of the cycles.
namespace sandhopper {

struct GroundRecords {
  std::vector<StrengthProfile> profiles{};
  std::vector<GroundSummary> summaries{};
};

// Throws mcap::Error where the log cannot be read; both are empty in logs of versions without them.
GroundRecords ground_records(const std::filesystem::path& log);

// One row a stride and depth: force and its 95 % band, secant, tangent stiffness of the cell and its 95 %
// band, independent observations in the cell, and 1 in `visited` between the least and greatest depth that
// the trial has reached so far. Columns carry their units.
void write_profile_csv(const std::vector<StrengthProfile>& profiles, std::ostream& out);

// One row a stride: every number of GroundSummary under its name, with its 95 % interval in columns
// ..._ci95_low and ..._ci95_high; an infinite limit is "inf".
void write_ground_csv(const std::vector<GroundSummary>& summaries, std::ostream& out);

}  // namespace sandhopper
