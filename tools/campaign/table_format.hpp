#pragma once
#include <vector>

#include "config/node.hpp"
#include "config/problem.hpp"
#include "firmware/log/csv_layout.hpp"

namespace sandhopper {

// [format] of campaign.toml, or a trial's `format`: what cannot be guessed of a file, every key optional.
//   separator    = ";"     ",", ";", "tab" or "blank"
//   decimal      = ","     "." or ","
//   thousands    = "."     "", ".", ",", "'" or " "
//   encoding     = "windows-1252"   "utf-8", "utf-16", "utf-16-be"
//   header_line  = 4       line of the columns' names, from 1; 0: there is none, `names` gives them
//   units_line   = 5       0: there is none
//   names        = ["t_s", "force_N"]
//   no_sample    = ["OVER", "-999"]   further cells without a sample
//   spread_times = true    rows that share a time came evenly
// Changes `format`, and returns what cannot be understood, with its place.
std::vector<ConfigProblem> read_format(const ConfigNode& table, CsvFormat& format);

}  // namespace sandhopper
