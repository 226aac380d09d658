#pragma once
#include <filesystem>

#include "tools/report/report_data.hpp"

namespace sandhopper {

// Reads a trial's log (firmware/log/topics.hpp) to its end, or to the place where it was cut. Metadata become
// facts, attached text becomes the configuration. Notes list what is missing, cut or damaged. Throws
// mcap::Error if the file is no log of this build's records, std::system_error if it cannot be opened.
ReportData report_data_from_log(const std::filesystem::path& log);

}  // namespace sandhopper
