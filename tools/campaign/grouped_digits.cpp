#include "tools/campaign/grouped_digits.hpp"

#include <algorithm>

namespace sandhopper {
namespace {

bool are_digits(std::string_view text) {
  return !text.empty() && std::ranges::all_of(text, [](char c) { return c >= '0' && c <= '9'; });
}

}  // namespace

GroupedDigits::GroupedDigits(const CsvTable& table)
    : table_(table),
      columns_(table.names.size()),
      is_clear_(table.layout.is_ambiguous || table.layout.numbers.thousands != '\0') {}

void GroupedDigits::take(const TextRow& row) {
  if (is_clear_ || row.is_remark) return;
  for (std::size_t i = 0; i < columns_.size(); ++i)
    if (!columns_[i].is_decided) take(columns_[i], text_of_column(row, table_, i));
}

void GroupedDigits::take(Column& column, std::string_view text) {
  const auto style = table_.layout.numbers;
  if (!number_in_cell(text, style)) {
    // 1.234.567 is no number in this style, and shows that the mark divides thousands.
    column.has_unmarked |=
        number_in_cell(text, {style.decimal == '.' ? ',' : '.', style.decimal}).has_value();
    return;
  }
  constexpr std::size_t kGroup = 3;
  if (text.starts_with('-') || text.starts_with('+')) text.remove_prefix(1);
  const auto mark = text.find(style.decimal);
  if (mark == std::string_view::npos) {
    column.is_decided = !are_digits(text) || text.size() > kGroup;
    column.has_unmarked = true;
    return;
  }
  const auto before = text.substr(0, mark), behind = text.substr(mark + 1);
  if (before.find(style.decimal == '.' ? ',' : '.') != std::string_view::npos) is_clear_ = true;
  column.is_decided = !are_digits(before) || before.size() > kGroup || before.starts_with('0') ||
                      !are_digits(behind) || behind.size() != kGroup;
  if (column.marked.empty()) column.marked = text;
}

std::vector<std::string> GroupedDigits::cells() const {
  std::vector<std::string> out;
  for (const auto& column : columns_)
    out.push_back(!is_clear_ && !column.is_decided && column.has_unmarked ? column.marked : "");
  return out;
}

}  // namespace sandhopper
