#pragma once
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "terrain/ground_events.hpp"
#include "terrain/ground_summary.hpp"
#include "tools/report/ground_text.hpp"

namespace sandhopper {

// A strength profile in words and numbers, for people; empty if there is none. `is_unchanged`: this stride
// reached no new ground, and its profile was already reported.
std::vector<std::string> profile_lines(const StrengthProfile& profile, const GroundSummary& ground,
                                       bool is_unchanged = false);

// The same for programs: the known depths, and depth_m, force_N, ci95_N, secant_N_per_m, tangent_N_per_m,
// tangent_ci95_N_per_m and observations at the end of every cell, the ground's shape and its numbers. null if
// there is none.
nlohmann::ordered_json profile_json(const StrengthProfile& profile, const GroundSummary& ground);

// Ruptures, boundaries, floor and suction of one stance, one line each; empty if none was found.
std::vector<std::string> ground_event_lines(const GroundEvents& found);

// The same for programs: an array of the events with their false-alarm probability. null if the log has none.
nlohmann::ordered_json ground_events_json(const GroundEvents& found);

}  // namespace sandhopper
