#pragma once
#include <filesystem>
#include <string>

#include "tools/report/report_data.hpp"

namespace sandhopper {

// One HTML page that holds everything it shows and asks no network for anything: time plots of the stride's
// quantities over common time, force against depth with the fitted lines, stiffness with intervals, events
// and configuration.
std::string trial_page(const ReportData& data);

// Writes it. Throws std::runtime_error with path and cause where that fails.
void write_trial_report(const ReportData& data, const std::filesystem::path& path);

}  // namespace sandhopper
