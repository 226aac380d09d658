#pragma once
#include <string>

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

}  // namespace sandhopper
