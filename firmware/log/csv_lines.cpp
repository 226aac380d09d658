#include <algorithm>
#include <array>

#include "firmware/log/csv_code_pages.hpp"
#include "firmware/log/csv_layout.hpp"

// Functions for one line of a table: its names, remarks and units.
namespace sandhopper {

std::size_t lines_ahead(const CsvFormat& stated) {
  const auto names = std::max(stated.header_line.value_or(0), stated.units_line.value_or(0));
  // A line of a file is at least one byte long: a larger number is a slip of the pen and names no line.
  constexpr std::uint64_t kMost = 1U << 24U;
  return std::max(TextLines::kAhead, static_cast<std::size_t>(names <= kMost ? names : 0));
}

void split_names(std::string_view line, char separator, std::size_t wanted, std::vector<TableCell>& cells) {
  split_csv_cells(line, separator, cells);
  if (separator != ' ' || cells.size() <= wanted) return;
  std::vector<TableCell> joined;
  for (const auto& cell : cells) {
    const bool is_unit = cell.text.starts_with('(') || cell.text.starts_with('[');
    if (!is_unit || joined.empty()) {
      joined.push_back(cell);
      continue;
    }
    const char* const begin = joined.back().text.data();
    const auto end = cell.text.data() + cell.text.size();
    joined.back().text = std::string_view(begin, static_cast<std::size_t>(end - begin));
  }
  if (joined.size() == wanted) cells = std::move(joined);
}

bool is_remark(std::string_view line) {
  while (!line.empty() && (line.front() == ' ' || line.front() == '\t')) line.remove_prefix(1);
  return line.starts_with('#') || line.starts_with('%') || line.starts_with("//");
}

std::string_view without_mark(std::string_view line, std::string& mark) {
  const auto blank = [](char c) { return c == ' ' || c == '\t'; };
  std::string_view rest = line;
  while (!rest.empty() && blank(rest.front())) rest.remove_prefix(1);
  if (!is_remark(rest)) return line;
  std::size_t length = 0;
  while (length < rest.size() && std::string_view("#%/").find(rest[length]) != std::string_view::npos)
    ++length;
  mark = std::string(rest.substr(0, length));
  rest.remove_prefix(length);
  while (!rest.empty() && blank(rest.front())) rest.remove_prefix(1);
  return rest;
}

bool looks_like_unit(std::string_view text) {
  text = trimmed_cell(text);
  const auto pair = [&](char a, char b) { return text.size() >= 2 && text.front() == a && text.back() == b; };
  if (pair('[', ']') || pair('(', ')')) return true;
  constexpr std::array<std::string_view, 66> kWords{
      "s",          "ms",    "us",    "\xC2\xB5s", "\xCE\xBCs",    "ns",       "sec",
      "min",        "h",     "m",     "mm",        "cm",           "um",       "N",
      "kN",         "mN",    "lbf",   "lb",        "kgf",          "gf",       "kg",
      "g",          "t",     "rad",   "mrad",      "deg",          "\xC2\xB0", "rpm",
      "1/min",      "rad/s", "deg/s", "dps",       "\xC2\xB0/s",   "m/s",      "mm/s",
      "cm/s",       "km/h",  "m/s^2", "m/s2",      "m/s\xC2\xB2",  "A",        "mA",
      "V",          "mV",    "W",     "Nm",        "N m",          "N.m",      "N*m",
      "N\xC2\xB7m", "mNm",   "Ncm",   "Pa",        "kPa",          "MPa",      "hPa",
      "bar",        "mbar",  "psi",   "C",         "\xC2\xB0\x43", "K",        "%",
      "-",          "Hz",    "in"};
  if (std::find(kWords.begin(), kWords.end(), text) != kWords.end()) return true;
  return text == "ft" || text == "degC" || text == "count" || text == "counts" || text == "rev" ||
         text == "U/min" || text == "seconds" || text == "raw" || text == "degrees" || text == "newton" ||
         text == "meter" || text == "TS" ||
         text == "RN";  // time stamp and record number of a logger (Campbell, TOA5)
}

namespace {

// Calls `look` for every cell of the rows until it returns false.
template <class Look>
void for_each_cell(const std::deque<std::string>& lines, std::size_t first_row, char separator, Look&& look) {
  std::vector<TableCell> cells;
  for (std::size_t i = first_row; i < lines.size(); ++i) {
    if (is_remark(lines[i])) continue;
    split_csv_cells(lines[i], separator, cells);
    for (const auto& cell : cells)
      if (!look(cell.text)) return;
  }
}

// An example if there are 1.001 and 3,5 but no number like 1.234,5: some columns may have decimal points and
// others decimal commas.
std::string written_in_two_ways(const std::deque<std::string>& lines, std::size_t first_row,
                                const CsvLayout& layout) {
  const auto style = layout.numbers;
  if (style.thousands != '.' && style.thousands != ',') return "";
  std::string example;
  bool has_decimals = false;
  for_each_cell(lines, first_row, layout.separator, [&](std::string_view text) {
    if (!number_in_cell(text, style)) return true;
    const bool grouped = text.find(style.thousands) != std::string_view::npos;
    const bool decimal = text.find(style.decimal) != std::string_view::npos;
    has_decimals = has_decimals || decimal;
    if (grouped && example.empty()) example = text;
    if (grouped && decimal) example.clear(), has_decimals = false;  // this cell shows both marks and decides
    return !(grouped && decimal);
  });
  return has_decimals ? example : "";
}

}  // namespace

std::vector<std::string> encoding_in_words(TextEncoding encoding, const std::deque<std::string>& lines) {
  switch (encoding) {
    case TextEncoding::utf8:
      return {};
    case TextEncoding::utf16_le:
    case TextEncoding::utf16_be:
      return {"the file is UTF-16 and is read as such"};
    case TextEncoding::utf32_le:
    case TextEncoding::utf32_be:
      return {"the file is UTF-32 and is read as such"};
    case TextEncoding::windows_1251:
      return {
          "the file is not UTF-8, and its words are of Cyrillic letters in Windows-1251: it is read as such; "
          "if its names are garbled save it as UTF-8"};
    case TextEncoding::mac_roman:
      return {"the file is Mac Roman, not UTF-8, and is read as such"};
    case TextEncoding::windows_1252:
      break;
  }
  std::vector<std::string> said{"the file is Windows-1252, not UTF-8, and is read as such"};
  if (std::ranges::any_of(lines, has_words_beyond_ascii))
    said.emplace_back(
        "whole words of it are letters beyond ASCII, as in another code page (KOI8-R, CP866, GB18030): if "
        "its names are garbled save it as UTF-8, for example with iconv -f KOI8-R -t UTF-8 FILE > FILE.csv");
  return said;
}

std::string cure_for_transposed(const std::deque<std::string>& lines, const CsvLayout& layout) {
  constexpr std::size_t kFewestSamples = 3, kShown = 4;
  std::vector<TableCell> cells;
  std::vector<std::string> names;
  for (const auto& line : lines) {
    if (is_remark(line) || trimmed_cell(line).empty()) continue;
    split_csv_cells(line, layout.separator, cells);
    if (cells.size() <= kFewestSamples) return "";
    const auto is_filled = [&](const TableCell& cell) {
      return number_in_cell(cell.text, layout.numbers) || time_in_cell(cell.text) || is_no_sample(cell.text);
    };
    const auto numbers = std::count_if(cells.begin() + 1, cells.end(), is_filled);
    if (static_cast<std::size_t>(numbers) + 2 < cells.size())
      return "";  // a cell with the unit may follow the name
    if (is_filled(cells.front())) {
      if (names.empty() && is_no_sample(cells.front().text))
        continue;  // numbers of the samples above the rows
      return "";
    }
    const std::string name(cells.front().text);
    if (std::ranges::find(names, name) != names.end()) return "";
    names.push_back(name);
  }
  if (names.size() < 2) return "";
  std::string text = "holds its channels one below the other (";
  for (std::size_t i = 0; i < names.size() && i < kShown; ++i)
    text += (i == 0 ? "\"" : ", \"") + names[i] + '"';
  const std::string separator = layout.separator == '\t' ? "\\t" : std::string(1, layout.separator);
  return text + (names.size() > kShown ? ", …" : "") +
         ") and its samples side by side; exchange rows and columns: python3 -c \"import csv, sys; "
         "csv.writer(sys.stdout, delimiter='" +
         separator + "').writerows(zip(*csv.reader(open('FILE'), delimiter='" + separator +
         "')))\" > FILE.csv, and name that file";
}

std::string ambiguous_cell_in(const std::deque<std::string>& lines, std::size_t first_row,
                              const CsvLayout& layout) {
  const auto style = layout.numbers;
  if (layout.separator == ',') return "";
  if (auto cell = written_in_two_ways(lines, first_row, layout); !cell.empty()) return cell;
  const char mark = style.decimal == ',' ? ',' : style.thousands;
  if (mark != ',' && !(style == NumberStyle{',', '.'})) return "";
  const NumberStyle other = style == NumberStyle{',', '\0'} ? NumberStyle{'.', ','} : NumberStyle{',', '\0'};
  std::string example;
  for_each_cell(lines, first_row, layout.separator, [&](std::string_view text) {
    const auto a = number_in_cell(text, style), b = number_in_cell(text, other);
    if (a && !b) example.clear();
    if (a && b && example.empty() && *a != *b) example = text;
    return !a || b;  // a cell that can be read in only one way decides
  });
  return example;
}

}  // namespace sandhopper
