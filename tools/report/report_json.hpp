#pragma once
#include <cstddef>
#include <nlohmann/json.hpp>
#include <string>

#include "tools/report/report_data.hpp"

namespace sandhopper {

// What a page of a ReportData carries; page/data.js reads it. `envelope_run`: see envelope().
nlohmann::json report_json(const ReportData& data, std::size_t envelope_run);

// As text; what is no valid UTF-8 is replaced.
std::string page_text(const nlohmann::json& json);

}  // namespace sandhopper
