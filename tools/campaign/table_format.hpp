#pragma once
#include <vector>

#include "config/node.hpp"
#include "config/problem.hpp"
#include "firmware/log/csv_layout.hpp"

namespace sandhopper {

// Reads [format] of campaign.toml, or `format` of a trial: the parts of a file's format that cannot be
// guessed. Every key is optional.
//   separator    = ";"     ",", ";", "tab", "blank" or "|"
//   decimal      = ","     "." or ","
//   thousands    = "."     "", ".", ",", "'" or " "
//   encoding     = "windows-1252"   "utf-8", "utf-16", "utf-32", "windows-1251", "mac-roman", …
//   header_line  = 4       line of the columns' names, from 1; 0: none, `names` gives them
//   units_line   = 5       0: none
//   names        = ["t_s", "force_N"]
//   no_sample    = ["OVER", "-999"]   further cells without a sample
//   spread_times = true    rows with the same time were evenly spaced
//   clock        = "mm:ss" 12:30 is 12 min 30 s; "hh:mm": 12 h 30 min
//   day_first    = true    03/04/2023 is 3 April
//   frames_per_s = 25      10:00:00:12 is frame 12 of so many in a second
//   time_restarts_at = 60  the time begins again at 0 there, in the unit of its column
//   row_every_s  = 0.001   for a file without times
// Changes `format` and returns the entries that cannot be parsed, with their position.
std::vector<ConfigProblem> read_format(const ConfigNode& table, CsvFormat& format);

}  // namespace sandhopper
