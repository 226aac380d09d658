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

constexpr std::size_t kEnoughRows = 60;  // number of rows that suffices to detect the layout

// In the order of preference: if two read equally many numbers the first one wins.
std::vector<Division> divisions(const CsvFormat& stated, std::optional<char> declared) {
  constexpr std::array kSeparators{',', ';', '\t', ' ', '|'};
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
  bool has_words() const { return numbers + silent < cells; }
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

// Result of reading the table with one division.
struct Seen {
  Division division{};
  std::size_t first_row = 0;  // index of the line
  std::size_t cells = 0;
  double score = 0.0;
};

// True if each of the next lines with cells, up to three, holds numbers in as many cells.
bool rows_follow(const std::vector<LineShape>& shapes, std::size_t row) {
  std::size_t seen = 0;
  for (std::size_t i = row + 1; i < shapes.size() && seen < 3; ++i) {
    if (shapes[i].cells == 0) continue;
    if (shapes[i].numbers == 0 || shapes[i].cells != shapes[row].cells) return false;
    ++seen;
  }
  return seen > 0;
}

// True if `row` is a fact above the names ("Gain;2") and no row of the table: a line of as many words
// follows, with more rows below it than above it. A line of names that is repeated within a table does not
// count.
bool is_above_names(const Lines& lines, const std::vector<LineShape>& shapes, std::size_t row) {
  const auto is_names = [&](std::size_t i) {
    return shapes[i].cells == shapes[row].cells && shapes[i].numbers == 0 && shapes[i].silent == 0;
  };
  const auto rows_between = [&](std::size_t from, std::size_t to) {
    return std::count_if(
        shapes.begin() + static_cast<std::ptrdiff_t>(from), shapes.begin() + static_cast<std::ptrdiff_t>(to),
        [&](const LineShape& shape) { return shape.is_row() && shape.cells == shapes[row].cells; });
  };
  for (std::size_t i = row + 1; i < shapes.size(); ++i)
    if (is_names(i)) {
      const auto end = lines.begin() + static_cast<std::ptrdiff_t>(row);
      const bool is_repeated = std::find(lines.begin(), end, lines[i]) != end;
      return !is_repeated && rows_between(i, shapes.size()) > rows_between(row, i);
    }
  return false;
}

// Scores the lines that hold numbers, grouped by their number of cells. The group with the highest score is
// the table.
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
    // A line with one cell is a row only if no separator finds more cells.
    const double weight = shape.cells == 1 ? 0.1 : 1.0;
    score[shape.cells] += weight * (static_cast<double>(shape.numbers) - 0.5 * text);
  }
  Seen seen{division, lines.size(), 0, 0.0};
  for (const auto& [count, sum] : score)
    if (sum > seen.score) seen.score = sum, seen.cells = count;
  for (std::size_t i = 0; i < shapes.size() && seen.cells > 0; ++i) {
    if (!shapes[i].is_row() || shapes[i].cells != seen.cells) continue;
    // A line of numbers among the names ("ID",1,1,2) is not followed by further rows of numbers: go on
    // searching.
    if (seen.first_row == lines.size()) seen.first_row = i;
    if (!shapes[i].has_words() || (rows_follow(shapes, i) && !is_above_names(lines, shapes, i))) {
      seen.first_row = i;
      break;
    }
  }
  return seen;
}

std::optional<char> declared_separator(const Lines& lines) {
  if (lines.empty()) return std::nullopt;
  const auto line = trimmed_cell(lines.front());
  if (line.size() != 5 || !(line.starts_with("sep=") || line.starts_with("SEP="))) return std::nullopt;
  return line.back();
}

// If nearly every line is a row of numbers with comma and decimal point, no other division is tried.
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
    // Blanks need a clearly higher score than another separator: a line may hold tabs, and blanks within its
    // cells.
    const double favour = division.separator == ' ' && best.cells > 1 ? 1.1 : 1.0;
    if (seen.score > favour * best.score) best = seen;
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
    out_.header_separator = out_.separator;
    out_.numbers = seen_.division.numbers;
    out_.row_cells = seen_.cells;
    out_.first_row_line = seen_.first_row + 1;
    find_names();
    if (!stated_.decimal && !stated_.thousands) {
      out_.ambiguous_cell = ambiguous_cell_in(lines_, seen_.first_row, out_);
      out_.is_ambiguous = !out_.ambiguous_cell.empty();
    }
    describe(declared.has_value());
    return std::move(out_);
  }

 private:
  // The table has no rows: the first line that is no remark names the columns, divided as in this project's
  // files.
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
    out_.header_separator = out_.separator;
    without_mark(line, out_.header_mark);
    out_.header_line = at < lines_.size() ? at + 1 : 0;
    out_.first_row_line = out_.header_line + 1;
    return std::move(out_);
  }

  // Cells of a line above the rows, without the mark of a remark.
  std::vector<std::string> cells_above(std::size_t i) const {
    std::string mark;
    std::vector<TableCell> cells;
    split_names(without_mark(lines_[i], mark), out_.header_separator, seen_.cells, cells);
    std::vector<std::string> texts;
    for (const auto& cell : cells) texts.emplace_back(cell.text);
    while (texts.size() > seen_.cells && texts.back().empty()) texts.pop_back();
    return texts;
  }

  // True if the line has as many cells as a row (one less if rows end with a separator), and none is a
  // number.
  bool may_name(std::size_t i) const {
    const auto cells = cells_above(i);
    const bool count = cells.size() == seen_.cells || cells.size() + 1 == seen_.cells ||
                       (cells.size() == seen_.cells + 1 && is_remarks(cells.back()));
    if (!count || cells.empty() || is_silent(cells)) return false;
    return std::none_of(cells.begin(), cells.end(),
                        [&](const auto& cell) { return is_number_or_time(cell, out_.numbers); });
  }
  // True for the name of a column of remarks, which the rows may lack.
  static bool is_remarks(std::string name) {
    constexpr std::array<std::string_view, 8> kNames{"comment", "comments", "remark",    "remarks",
                                                     "note",    "notes",    "kommentar", "bemerkung"};
    std::transform(name.begin(), name.end(), name.begin(),
                   [](char c) { return c >= 'A' && c <= 'Z' ? static_cast<char>(c + 32) : c; });
    return std::find(kNames.begin(), kNames.end(), name) != kNames.end();
  }
  static bool is_silent(const std::vector<std::string>& cells) {
    return std::all_of(cells.begin(), cells.end(), [](const auto& cell) { return is_no_sample(cell); });
  }
  // True if at least two thirds of the filled cells look like units.
  bool holds_units(std::size_t i) const {
    const auto cells = cells_above(i);
    const auto filled = std::count_if(cells.begin(), cells.end(), [](const auto& c) { return !c.empty(); });
    const auto units = std::count_if(cells.begin(), cells.end(),
                                     [](const auto& c) { return !c.empty() && looks_like_unit(c); });
    return units > 0 && 3 * units >= 2 * filled;
  }

  // Lines above the rows that may name the columns, from below upwards.
  std::vector<std::size_t> lines_of_names() const {
    std::vector<std::size_t> rows;
    for (std::size_t i = seen_.first_row; i-- > 0 && rows.size() < 3;) {
      if (trimmed_cell(lines_[i]).empty() || is_rule(i)) continue;
      if (may_name(i))
        rows.push_back(i);
      else if (!rows.empty() || !is_remark(lines_[i]))
        break;
    }
    return rows;
  }

  // A program may print "Time, Force" and then rows with tabs. Then the names have another separator.
  std::vector<std::size_t> lines_divided_otherwise() {
    for (const char other : {',', ';', '\t', '|'}) {
      if (other == out_.separator) continue;
      out_.header_separator = other;
      if (auto rows = lines_of_names(); !rows.empty()) return rows;
    }
    out_.header_separator = out_.separator;
    return {};
  }

  // True for a rule such as "|---|---|" between names and rows.
  bool is_rule(std::size_t i) const {
    return lines_[i].find('-') != std::string::npos && is_silent(cells_above(i));
  }

  bool has_gaps(std::size_t i) const {
    const auto cells = cells_above(i);
    return std::any_of(cells.begin(), cells.end(), [](const auto& cell) { return cell.empty(); });
  }

  // Finds the nearest line above the rows that is neither blank, remark nor row, and stores its number of
  // cells.
  void find_misfit() {
    std::vector<TableCell> cells;
    for (std::size_t i = seen_.first_row; i-- > 0;) {
      if (trimmed_cell(lines_[i]).empty() || is_remark(lines_[i])) continue;
      if (shape_of(lines_[i], seen_.division, cells).is_row()) continue;
      split_csv_cells(lines_[i], out_.separator, cells);
      out_.misfit_line = i + 1;
      out_.misfit_cells = cells.size();
      return;
    }
  }

  void divide_stated_names(std::size_t header) {
    for (const char separator : {out_.separator, ',', ';', '\t', '|'}) {
      out_.header_separator = separator;
      if (cells_above(header).size() == seen_.cells) return;
    }
    out_.header_separator = out_.separator;
  }

  // R writes the row's number as an additional first cell, without a name above it.
  void find_extra_cells(std::size_t header) {
    const std::size_t names = header < lines_.size() ? cells_above(header).size() : 0;
    out_.has_unused_names = names == seen_.cells + 1;
    if (names + 1 != seen_.cells) return;
    std::vector<TableCell> cells;
    std::size_t count = 0;
    for (std::size_t i = seen_.first_row; i < lines_.size(); ++i) {
      split_csv_cells(lines_[i], out_.separator, cells);
      if (cells.size() != seen_.cells) continue;
      if (cells.back().text.empty() || cells.front().text != std::to_string(++count)) return;
    }
    out_.rows_are_counted = count > 2;
  }

  void find_names() {
    out_.header_line = 0;
    auto rows = lines_of_names();
    if (rows.empty() && seen_.cells > 1 && !stated_.header_line) rows = lines_divided_otherwise();
    // A line below the names may describe the processing of some columns only. Skip such a line with gaps.
    while (rows.size() > 1 && has_gaps(rows[0]) && !has_gaps(rows[1])) rows.erase(rows.begin());
    if (rows.empty()) find_misfit();
    std::size_t header = lines_.size();
    if (stated_.header_line) {
      if (*stated_.header_line > 0) header = *stated_.header_line - 1;
    } else if (!rows.empty()) {
      header = rows.front();
      if (rows.size() > 1 && holds_units(header)) header = rows[1];
    }
    if (header < lines_.size() && stated_.header_line) divide_stated_names(header);
    if (header < lines_.size()) {
      out_.header_line = header + 1;
      without_mark(lines_[header], out_.header_mark);
      out_.first_row_line = std::max<std::uint64_t>(out_.first_row_line, header + 2);
    }
    if (stated_.header_line && *stated_.header_line == 0) out_.first_row_line = seen_.first_row + 1;
    find_extra_cells(header);
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

  // A property that the owner states is nothing unusual any more.
  void describe(bool declared) {
    const auto say = [&](std::string text, bool is_stated = false) {
      if (!is_stated) out_.said.push_back(std::move(text));
    };
    for (auto& text : encoding_in_words(out_.encoding, lines_))
      say(std::move(text), stated_.encoding.has_value());
    const std::uint64_t plain = declared ? 2 : 1, at = out_.header_line;
    const std::string above = at == plain + 1 ? ", the line above is" : ", the lines above are";
    if (at > plain && !stated_.header_line)
      say("the names of the columns stand in line " + std::to_string(at) + above + " passed over");
    if (out_.units_line > 0)
      say("line " + std::to_string(out_.units_line) + " holds units", stated_.units_line.has_value());
    if (out_.separator == ' ') say("the columns are divided by blanks", stated_.separator.has_value());
    if (out_.header_separator != out_.separator) say("the names are divided in another way than the rows");
    if (out_.rows_are_counted) say("each row begins with its number, which has no name and is passed over");
    if (out_.has_unused_names) say("rows end before the last name, which is that of remarks");
    if (out_.numbers.decimal == ',') say("numbers have a decimal comma", stated_.decimal.has_value());
    if (out_.numbers.thousands != '\0')
      say(std::string("thousands are divided by \"") + out_.numbers.thousands + "\"",
          stated_.thousands.has_value());
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

}  // namespace sandhopper
