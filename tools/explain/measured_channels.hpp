#pragma once
#include "tools/explain/recording.hpp"
#include "tools/report/report_data.hpp"

namespace sandhopper {

// One row per cycle: what each sensor delivered (empty where nothing fresh came), how old the newest sample
// was, what the bus counted, what was commanded, and the estimates while there were any. Times in seconds
// from the recording's instant.
void add_measured_channels(const Recording& recording, ReportData& data);

}  // namespace sandhopper
