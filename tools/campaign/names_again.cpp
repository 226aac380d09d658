#include "tools/campaign/names_again.hpp"

#include <algorithm>

#include "tools/campaign/read_table.hpp"
#include "tools/campaign/written_unit.hpp"

namespace sandhopper {
namespace {

constexpr std::string_view kMarkOfJoinedFiles = "\xEF\xBB\xBF";

bool is_a_unit(std::string_view text) {
  const auto unit = read_unit(text, false);
  return unit && !unit->dimension.empty();
}

}  // namespace

bool NamesAgain::is_name(std::string_view text) const {
  if (std::ranges::find(table_.names, text) != table_.names.end() || is_called_time(text)) return true;
  const auto unit = unit_in_name(text);
  return unit && unit->is_certain && !unit->dimension.empty();
}

void NamesAgain::take(const TextRow& row) {
  // A short line is a remark, or a row that was cut.
  if (table_.names.empty() || row.cells.size() < table_.numbers.back()) return;
  std::vector<std::string> texts;
  bool has_silence = false, has_name = false, has_unit = false, are_units = true;
  for (std::size_t i = 0; i < table_.names.size(); ++i) {
    auto text = text_of_column(row, table_, i);
    // Files that were joined keep their byte order marks.
    if (text.starts_with(kMarkOfJoinedFiles)) text.remove_prefix(kMarkOfJoinedFiles.size());
    if (number_in_cell(text, table_.layout.numbers) || time_in_cell(text) || is_out_of_range(text)) return;
    texts.emplace_back(text);
    has_silence |= is_no_sample(text);
    has_name |= is_name(text);
    has_unit |= is_a_unit(text);
    are_units &= is_a_unit(text) || is_no_sample(text) || looks_like_unit(text);
  }
  if (has_unit && are_units) return lines_.push_back({row.line, true, std::move(texts)});
  if (has_name && !has_silence) lines_.push_back({row.line, false, std::move(texts)});
}

}  // namespace sandhopper
