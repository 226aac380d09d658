#pragma once
#include <string>
#include <string_view>
#include <vector>

#include "terrain/ground_events.hpp"
#include "terrain/ground_summary.hpp"
#include "tools/report/report_data.hpp"

// The ground of a trial in a sentence, for terminal and page.
namespace sandhopper {

// The shape of the ground, and whether a straight line describes it.
std::string headline(const GroundSummary& ground);

// A stride that reached no ground deeper than those before: the profile after it is the one before.
bool adds_nothing(const ReportData& data, std::size_t stride);

// The trial's last line: what is known of the ground and at which depths, and which strides said nothing new.
// Empty where the log holds no profile.
std::string trial_line(const ReportData& data);

// What was found in a stance: ruptures, boundaries, floor and suction; empty where nothing was.
std::vector<const GroundEvent*> found_in(const GroundEvents& found);

// "a crust broke at 12.3 mm: 14.2 N at 0.45 m/s, size 3.1 +- 0.4 N"
std::string in_words(const GroundEvent& event);
std::string_view unit_of_size(GroundEventKind kind);

}  // namespace sandhopper
