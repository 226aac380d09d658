#pragma once
#include <filesystem>
#include <string>

#include "tools/report/report_data.hpp"

namespace sandhopper {

// One self-contained HTML page: time plots of the trial's quantities, force against depth with the fitted
// lines, stiffness with intervals, events and configuration. It needs no network.
std::string trial_page(const ReportData& data);

// Writes the page. Throws std::runtime_error with path and cause if the file cannot be written.
void write_trial_report(const ReportData& data, const std::filesystem::path& path);

}  // namespace sandhopper
