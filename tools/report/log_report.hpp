#pragma once
#include <filesystem>

#include "tools/report/report_data.hpp"

namespace sandhopper {

// A trial's log (firmware/log/topics.hpp), read to its end or to where it was cut: cycles, events, strides,
// truth; metadata become facts, attached text the configuration. What is missing, cut or damaged is said in
// the notes. Throws mcap::Error for a file that is no log of this build's records, std::system_error when it
// cannot be opened.
ReportData report_data_from_log(const std::filesystem::path& log);

}  // namespace sandhopper
