#pragma once
#include <string>
#include <vector>

#include "firmware/log/csv_layout.hpp"

// The table [format] of a drafted campaign.toml.
namespace sandhopper {

// `names`: names of the columns that the user gave because the file has none.
std::string draft_format(const CsvLayout& layout, const std::vector<std::string>& names);

// "tabs", "semicolons", …
std::string separator_word(const CsvLayout& layout);

}  // namespace sandhopper
