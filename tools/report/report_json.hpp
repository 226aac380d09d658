#pragma once
#include <cstddef>
#include <nlohmann/json.hpp>
#include <string>

#include "tools/report/report_data.hpp"

namespace sandhopper {

// JSON of a page's data; page/data.js reads it. `envelope_run`: the result `run` of envelope().
nlohmann::json report_json(const ReportData& data, std::size_t envelope_run);

// Serialises it; invalid UTF-8 is replaced by U+FFFD.
std::string page_text(const nlohmann::json& json);

}  // namespace sandhopper
