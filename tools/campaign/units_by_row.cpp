#include "tools/campaign/units_by_row.hpp"

#include <algorithm>
#include <cmath>

#include "tools/campaign/written_unit.hpp"

namespace sandhopper {

void UnitColumns::take(const TextRow& row) {
  const auto is_number = [&](std::size_t i) {
    return number_in_cell(text_of_column(row, table_, i), table_.layout.numbers).has_value();
  };
  bool is_row = false;
  for (std::size_t i = 0; i < columns_.size() && !is_row; ++i) is_row = is_number(i);
  if (!is_row || row.is_remark) return;
  for (std::size_t i = 0; i < columns_.size(); ++i) {
    auto& column = columns_[i];
    const auto text = text_of_column(row, table_, i);
    if (column.has_others || is_no_sample(text)) continue;
    const auto unit = read_unit(text, false);
    column.has_others = !unit || unit->dimension.empty();
    const bool is_new = !column.has_others && std::ranges::find(column.units, text, [](const auto& u) {
                                                return std::string_view(u.text);
                                              }) == column.units.end();
    if (is_new) column.units.push_back({std::string(text), row.line});
  }
}

std::optional<std::size_t> UnitColumns::target_of(std::size_t i) const {
  const auto has_numbers = [&](std::size_t k) {
    return std::ranges::any_of(table_.columns[k], [](double value) { return !std::isnan(value); });
  };
  for (std::size_t k = i; k-- > 0;)
    if (has_numbers(k)) return k;
  for (std::size_t k = i + 1; k < columns_.size(); ++k)
    if (has_numbers(k)) return k;
  return std::nullopt;
}

std::vector<UnitsByRow> UnitColumns::found() const {
  std::vector<UnitsByRow> out;
  for (std::size_t i = 0; i < columns_.size(); ++i) {
    if (columns_[i].has_others || columns_[i].units.empty()) continue;
    if (const auto target = target_of(i)) out.push_back({i, *target, columns_[i].units});
  }
  return out;
}

}  // namespace sandhopper
