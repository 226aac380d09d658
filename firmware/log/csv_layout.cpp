#include "firmware/log/csv_layout.hpp"

#include <algorithm>
#include <array>
#include <map>

namespace sandhopper {
namespace {

using Lines = std::deque<std::string>;

struct Division {
  char separator;
  NumberStyle numbers;
};

constexpr std::size_t kEnoughRows = 60;  // show how a table is written

// In the order of preference: where two read equally many numbers the first counts.
std::vector<Division> divisions(const CsvFormat& stated, std::optional<char> declared) {
  constexpr std::array kSeparators{',', ';', '\t', ' '};
  constexpr std::array<NumberStyle, 6> kStyles{NumberStyle{'.', '\0'}, NumberStyle{',', '\0'},
                                               NumberStyle{'.', ','},  NumberStyle{',', '.'},
                                               NumberStyle{'.', '\''}, NumberStyle{',', ' '}};
  std::vector<Division> all;
  for (const char separator : kSeparators)
    for (const auto style : kStyles) {
      const bool blank_twice = separator == ' ' && style.thousands == ' ';
      if (blank_twice || (stated.decimal && style.decimal != *stated.decimal)) continue;
      if (stated.thousands && style.thousands != *stated.thousands) continue;
      if (const auto only = stated.separator ? stated.separator : declared; only && separator != *only)
        continue;
      all.push_back({separator, style});
    }
  if (all.empty())
    all.push_back({stated.separator.value_or(declared.value_or(',')),
                   {stated.decimal.value_or('.'), stated.thousands.value_or('\0')}});
  return all;
}

bool is_number_or_time(std::string_view cell, NumberStyle style) {
  return number_in_cell(cell, style).has_value() || time_in_cell(cell).has_value();
}

struct LineShape {
  std::size_t cells = 0, numbers = 0, silent = 0;
  bool is_row() const { return numbers > 0 && 2 * (numbers + silent) >= cells; }
};

LineShape shape_of(std::string_view line, const Division& division, std::vector<TableCell>& cells) {
  LineShape shape;
  if (is_remark(line) || trimmed_cell(line).empty()) return shape;
  split_csv_cells(line, division.separator, cells);
  shape.cells = cells.size();
  for (const auto& cell : cells) {
    if (is_number_or_time(cell.text, division.numbers))
      ++shape.numbers;
    else
      shape.silent += is_no_sample(cell.text);
  }
  return shape;
}

// The table as one division shows it.
struct Seen {
  Division division{};
  std::size_t first_row = 0;  // index of the line
  std::size_t cells = 0;
  double score = 0.0;
};

// Lines of one number of cells that hold numbers; the number of cells that most of them have counts.
Seen look(const Lines& lines, const Division& division) {
  std::vector<TableCell> cells;
  std::map<std::size_t, double> score;
  std::vector<LineShape> shapes;
  std::size_t rows = 0;
  for (const auto& line : lines) {
    if (rows == kEnoughRows) break;
    shapes.push_back(shape_of(line, division, cells));
    const auto& shape = shapes.back();
    if (!shape.is_row()) continue;
    ++rows;
    const double text = static_cast<double>(shape.cells - shape.numbers - shape.silent);
    // One cell a line is a table only where no separator shows another.
    const double weight = shape.cells == 1 ? 0.1 : 1.0;
    score[shape.cells] += weight * (static_cast<double>(shape.numbers) - 0.5 * text);
  }
  Seen seen{division, lines.size(), 0, 0.0};
  for (const auto& [count, sum] : score)
    if (sum > seen.score) seen.score = sum, seen.cells = count;
  for (std::size_t i = 0; i < shapes.size() && seen.cells > 0; ++i) {
    if (!shapes[i].is_row() || shapes[i].cells != seen.cells) continue;
    seen.first_row = i;
    break;
  }
  return seen;
}

std::optional<char> declared_separator(const Lines& lines) {
  if (lines.empty()) return std::nullopt;
  const auto line = trimmed_cell(lines.front());
  if (line.size() != 5 || !(line.starts_with("sep=") || line.starts_with("SEP="))) return std::nullopt;
  return line.back();
}

// A division under which nearly every line is a row of numbers alone needs no rival.
bool is_plain(const Seen& seen, const Division& division, std::size_t lines) {
  const std::size_t rows = std::min(lines > 0 ? lines - 1 : 0, kEnoughRows);
  return division.separator == ',' && division.numbers == NumberStyle{} && seen.cells > 1 && rows > 2 &&
         seen.score >= static_cast<double>(seen.cells * rows);
}

Seen best_division(const Lines& lines, const CsvFormat& stated, std::optional<char> declared) {
  Seen best;
  best.first_row = lines.size();
  for (const auto& division : divisions(stated, declared)) {
    const auto seen = look(lines, division);
    if (seen.score > best.score) best = seen;
    if (is_plain(seen, division, lines.size())) break;
  }
  return best;
}

class Finder {
 public:
  Finder(const Lines& lines, const CsvFormat& stated) : lines_(lines), stated_(stated) {}

  CsvLayout run(TextEncoding encoding) {
    out_.encoding = encoding;
    const auto declared = declared_separator(lines_);
    seen_ = best_division(lines_, stated_, declared);
    if (seen_.cells == 0) return without_numbers(declared);
    out_.separator = seen_.division.separator;
    out_.numbers = seen_.division.numbers;
    out_.first_row_line = seen_.first_row + 1;
    find_names();
    look_for_ambiguity();
    describe(declared.has_value());
    return std::move(out_);
  }

 private:
  // No row: the first line that is no remark names the columns, divided as in a file of this project.
  CsvLayout without_numbers(std::optional<char> declared) {
    std::size_t at = declared ? 1 : 0;
    if (stated_.header_line && *stated_.header_line > 0) at = *stated_.header_line - 1;
    while (at < lines_.size() && trimmed_cell(lines_[at]).empty()) ++at;
    const std::string_view line = at < lines_.size() ? std::string_view(lines_[at]) : std::string_view();
    for (const char separator : {',', ';', '\t'})
      if (line.find(separator) != std::string_view::npos) {
        out_.separator = separator;
        break;
      }
    if (declared) out_.separator = *declared;
    if (stated_.separator) out_.separator = *stated_.separator;
    without_mark(line, out_.header_mark);
    out_.header_line = at < lines_.size() ? at + 1 : 0;
    out_.first_row_line = out_.header_line + 1;
    return std::move(out_);
  }

  // Cells of a line above the rows, the mark of a remark left out.
  std::vector<std::string> cells_above(std::size_t i) const {
    std::string mark;
    std::vector<TableCell> cells;
    split_csv_cells(without_mark(lines_[i], mark), out_.separator, cells);
    std::vector<std::string> texts;
    for (const auto& cell : cells) texts.emplace_back(cell.text);
    while (texts.size() > seen_.cells && texts.back().empty()) texts.pop_back();
    return texts;
  }

  // As many cells as a row has (one less where rows end with a separator), none of them a number.
  bool may_name(std::size_t i) const {
    const auto cells = cells_above(i);
    const bool count = cells.size() == seen_.cells || cells.size() + 1 == seen_.cells;
    if (!count || cells.empty() || is_silent(cells)) return false;
    return std::none_of(cells.begin(), cells.end(),
                        [&](const auto& cell) { return is_number_or_time(cell, out_.numbers); });
  }
  static bool is_silent(const std::vector<std::string>& cells) {
    return std::all_of(cells.begin(), cells.end(), [](const auto& cell) { return cell.empty(); });
  }
  // A row of units has them below most of the names, and not the names again.
  bool holds_units(std::size_t i) const {
    const auto cells = cells_above(i);
    const auto filled = std::count_if(cells.begin(), cells.end(), [](const auto& c) { return !c.empty(); });
    const auto units = std::count_if(cells.begin(), cells.end(),
                                     [](const auto& c) { return !c.empty() && looks_like_unit(c); });
    return units > 0 && 3 * units >= 2 * filled;
  }

  void find_names() {
    out_.header_line = 0;
    std::vector<std::size_t> rows;  // upwards
    for (std::size_t i = seen_.first_row; i-- > 0 && rows.size() < 3;) {
      if (trimmed_cell(lines_[i]).empty()) continue;
      if (may_name(i))
        rows.push_back(i);
      else if (!rows.empty() || !is_remark(lines_[i]))
        break;
    }
    std::size_t header = lines_.size();
    if (stated_.header_line) {
      if (*stated_.header_line > 0) header = *stated_.header_line - 1;
    } else if (!rows.empty()) {
      header = rows.front();
      if (rows.size() > 1 && holds_units(header)) header = rows[1];
    }
    if (header < lines_.size()) {
      out_.header_line = header + 1;
      without_mark(lines_[header], out_.header_mark);
      out_.first_row_line = std::max<std::uint64_t>(out_.first_row_line, header + 2);
    }
    if (stated_.header_line && *stated_.header_line == 0) out_.first_row_line = seen_.first_row + 1;
    find_units(header);
  }

  void find_units(std::size_t header) {
    if (stated_.units_line) {
      out_.units_line = *stated_.units_line;
    } else {
      for (std::size_t i = header + 1; i < seen_.first_row && i < lines_.size(); ++i)
        if (may_name(i) && holds_units(i)) {
          out_.units_line = i + 1;
          break;
        }
    }
    out_.first_row_line = std::max(out_.first_row_line, out_.units_line + 1);
  }

  // 1,234 between semicolons: three digits behind every comma, and nothing else to tell what it means.
  void look_for_ambiguity() {
    const auto style = out_.numbers;
    const bool by_comma = out_.separator == ',';
    if (by_comma || stated_.decimal || stated_.thousands) return;
    const char mark = style.decimal == ',' ? ',' : style.thousands;
    if (mark != ',' && !(style == NumberStyle{',', '.'})) return;
    const NumberStyle other =
        style == NumberStyle{',', '\0'} ? NumberStyle{'.', ','} : NumberStyle{',', '\0'};
    std::vector<TableCell> cells;
    std::string example;
    for (std::size_t i = seen_.first_row; i < lines_.size(); ++i) {
      if (is_remark(lines_[i])) continue;
      split_csv_cells(lines_[i], out_.separator, cells);
      for (const auto& cell : cells) {
        const auto a = number_in_cell(cell.text, style), b = number_in_cell(cell.text, other);
        if (!a) continue;
        if (!b) return;  // this cell decides
        if (example.empty() && *a != *b) example = cell.text;
      }
    }
    out_.is_ambiguous = !example.empty();
    out_.ambiguous_cell = example;
  }

  void describe(bool declared) {
    const auto say = [&](std::string text) { out_.said.push_back(std::move(text)); };
    if (out_.encoding == TextEncoding::utf16_le || out_.encoding == TextEncoding::utf16_be)
      say("the file is UTF-16 and is read as such");
    if (out_.encoding == TextEncoding::windows_1252)
      say("the file is Windows-1252, not UTF-8, and is read as such");
    const std::uint64_t plain = declared ? 2 : 1;
    if (out_.header_line > plain) {
      std::string text = "the names of the columns stand in line " + std::to_string(out_.header_line);
      text += out_.header_line == plain + 1 ? ", the line above is passed over"
                                            : ", the lines above are passed over";
      say(text);
    }
    if (out_.units_line > 0) say("line " + std::to_string(out_.units_line) + " holds units");
    if (out_.separator == ' ') say("the columns are divided by blanks");
    if (out_.numbers.decimal == ',') say("numbers have a decimal comma");
    if (out_.numbers.thousands != '\0')
      say(std::string("thousands are divided by \"") + out_.numbers.thousands + "\"");
  }

  const Lines& lines_;
  const CsvFormat& stated_;
  Seen seen_{};
  CsvLayout out_{};
};

}  // namespace

CsvLayout find_layout(const std::deque<std::string>& first_lines, TextEncoding encoding,
                      const CsvFormat& stated) {
  return Finder(first_lines, stated).run(encoding);
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
         text == "meter";
}

}  // namespace sandhopper
