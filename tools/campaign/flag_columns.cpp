#include "tools/campaign/flag_columns.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>

#include "tools/campaign/column_guess.hpp"

namespace sandhopper {
namespace {

using Words = std::vector<std::string_view>;

// A column of more different cells is no mark.
constexpr std::size_t kMostMarks = 20;

bool is_one_of(std::string_view text, const Words& words) {
  return std::ranges::find(words, text) != words.end();
}

const Words kNo{"0", "false", "no", "n"}, kYes{"1", "true", "yes", "y"};
const Words kBadWords{"err",      "error", "fault", "bad",  "invalid", "nok",     "ng",
                      "overload", "ovl",   "fail",  "lost", "failed",  "timeout", "not ok"};
const Words kNoError{"none", "ok", "good", "valid", "-"};

// "1.0" and "1" are one mark. Empty for a number that is not whole.
std::string as_mark(std::string_view cell) {
  const auto text = in_lower_case(cell);
  char* end = nullptr;
  const double number = std::strtod(text.c_str(), &end);
  if (end == text.c_str() || *end != '\0') return text;
  if (!std::isfinite(number) || number != std::round(number)) return "";
  return std::to_string(std::llround(number));
}

bool is_whole_number(const std::string& text) {
  const auto first = text.find_first_not_of('-');
  return first != std::string::npos && text.find_first_not_of("0123456789", first) == std::string::npos;
}

}  // namespace

FlagColumns::FlagColumns(const CsvTable& table) : table_(table), columns_(table.names.size()) {
  for (std::size_t i = 0; i < columns_.size(); ++i) columns_[i].meaning = meaning_of(table.names[i]);
}

FlagColumns::Meaning FlagColumns::meaning_of(std::string_view name) {
  std::string word;
  for (const char c : in_lower_case(name) + " ") {
    if (c >= 'a' && c <= 'z') {
      word += c;
      continue;
    }
    if (is_one_of(word, {"invalid", "error", "err", "fault", "overload"})) return Meaning::bad;
    if (is_one_of(word, {"valid", "isvalid", "ok", "validity"})) return Meaning::good;
    if (is_one_of(word, {"status", "quality", "flag", "flags"})) return Meaning::either;
    word.clear();
  }
  return Meaning::none;
}

void FlagColumns::take(const TextRow& row) {
  if (row.is_remark) return;
  for (std::size_t i = 0; i < columns_.size(); ++i) {
    if (columns_[i].meaning == Meaning::none) continue;
    const auto cell = text_of_column(row, table_, i);
    if (cell.empty()) continue;
    const auto mark = as_mark(cell);
    auto& cells = columns_[i].cells[mark];
    if (cells.rows++ == 0) cells.first_line = row.line;
    if (mark.empty() || columns_[i].cells.size() > kMostMarks) columns_[i] = {};
  }
}

bool FlagColumns::is_marked(const Column& column, const std::string& text) {
  switch (column.meaning) {
    case Meaning::good:
      return is_one_of(text, kNo) || is_one_of(text, kBadWords);
    case Meaning::bad:
      return !is_one_of(text, kNo) && !is_one_of(text, kNoError);
    case Meaning::either:
      break;
    case Meaning::none:
      return false;
  }
  if (is_one_of(text, kBadWords)) return true;
  const bool is_no = is_one_of(text, kNo);
  if (column.cells.size() != 2 || (!is_no && !is_one_of(text, kYes))) return false;
  const auto& other = column.cells.begin()->first == text ? *column.cells.rbegin() : *column.cells.begin();
  return is_one_of(other.first, is_no ? kYes : kNo) && column.cells.at(text).rows < other.second.rows;
}

std::vector<FlagColumn> FlagColumns::found() const {
  std::vector<FlagColumn> flags;
  for (std::size_t i = 0; i < columns_.size(); ++i) {
    FlagColumn flag{.column = i, .is_number = true};
    std::uint64_t most = 0;
    for (const auto& [text, cells] : columns_[i].cells) {
      flag.rows += cells.rows;
      flag.is_number = flag.is_number && is_whole_number(text);
      if (!is_marked(columns_[i], text)) {
        if (cells.rows > most && is_whole_number(text)) flag.good = std::stod(text);
        most = std::max(most, cells.rows);
        continue;
      }
      if (flag.marked == 0 || cells.first_line < flag.first_line) flag.first_line = cells.first_line;
      flag.marked += cells.rows;
      flag.texts.push_back(text);
    }
    if (flag.marked > 0 && flag.marked < flag.rows) flags.push_back(std::move(flag));
  }
  return flags;
}

}  // namespace sandhopper
