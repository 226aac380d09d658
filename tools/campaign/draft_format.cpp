#include "tools/campaign/draft_format.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

namespace sandhopper {

std::string draft_format(const CsvLayout& l, const std::vector<std::string>& names) {
  const std::string separator = l.separator == '\t'  ? "tab"
                                : l.separator == ' ' ? "blank"
                                                     : std::string(1, l.separator);
  std::string text = "\n[format]   # how the files are written; found by looking\n";
  text += fmt::format("separator   = \"{}\"   # \",\", \";\", \"|\", \"tab\" or \"blank\"\n", separator);
  const std::string mark = l.is_ambiguous ? "# " : "";  // If it is ambiguous, the user must state it.
  text += fmt::format("{}decimal     = \"{}\"\n", mark, l.numbers.decimal);
  text += fmt::format("{}thousands   = \"{}\"   # \"\": none\n", mark,
                      l.numbers.thousands == '\0' ? std::string() : std::string(1, l.numbers.thousands));
  text += fmt::format("encoding    = \"{}\"   # {}\n", name_of(l.encoding),
                      fmt::join(EnumNames<TextEncoding>::value, ", "));
  text += fmt::format("header_line = {}   # of the columns' names; 0: none, and `names` gives them\n",
                      l.header_line);
  text += fmt::format("units_line  = {}   # 0: none\n", l.units_line);
  text += names.empty() ? "# names        = [\"t_s\", \"force_N\"]\n"
                        : fmt::format("names       = [\"{}\"]\n", fmt::join(names, "\", \""));
  text +=
      "# no_sample    = [\"OVER\", \"-999\"]   # further cells without a sample; NaN, -, #N/A are known\n";
  text += "# clock        = \"mm:ss\"   # 12:30 is 12 min 30 s; \"hh:mm\": half past twelve\n";
  text += "# day_first    = true   # 03/04/2023 is 3 April\n";
  text += "# frames_per_s = 25   # 10:00:00:12 is frame 12 of so many in a second\n";
  text += "# time_restarts_at = 60   # a time that begins again at 0 there, as the seconds of a minute\n";
  text += "# row_every_s  = 0.001   # for a file without times: from row to row\n";
  text += "# spread_times = true   # rows that share a time came evenly\n";
  return text;
}

std::string separator_word(const CsvLayout& layout) {
  switch (layout.separator) {
    case '\t':
      return "tabs";
    case ' ':
      return "blanks";
    case ';':
      return "semicolons";
    case '|':
      return "bars";
    default:
      return "commas";
  }
}

}  // namespace sandhopper
