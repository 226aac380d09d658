#pragma once
#include <string>
#include <string_view>
#include <vector>

#include "terrain/ground_events.hpp"
#include "terrain/ground_summary.hpp"
#include "tools/report/report_data.hpp"

// Sentences about the ground of a trial, for terminal and page.
namespace sandhopper {

// The shape of the ground, and whether a straight line describes it.
std::string headline(const GroundSummary& ground);

// True if the stride reached no new ground: its profile equals that of the stride before.
bool adds_nothing(const ReportData& data, std::size_t stride);

// Summary of the trial: what is known of the ground, at which depths, and which strides reached no new
// ground. Empty if the log holds no profile.
std::string trial_line(const ReportData& data);

// Events that were found in a stance (rupture, boundary or floor, suction); empty if there were none.
std::vector<const GroundEvent*> found_in(const GroundEvents& found);

// For example "a crust broke at 12.3 mm: 14.2 N at 0.45 m/s, size 3.1 +- 0.4 N".
std::string in_words(const GroundEvent& event);
// Unit of GroundEvent::size.
std::string_view unit_of_size(GroundEventKind kind);

}  // namespace sandhopper
