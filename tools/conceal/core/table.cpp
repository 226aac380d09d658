#include "tools/conceal/core/table.hpp"

#include <fmt/format.h>

#include <cmath>
#include <iterator>

namespace sandhopper::conceal {

Column& Table::add(std::string name, int decimals) {
  return columns.emplace_back(Column{std::move(name), decimals, {}});
}

Column* Table::find(const std::string& name) {
  for (auto& column : columns)
    if (column.name == name) return &column;
  return nullptr;
}

const Column* Table::find(const std::string& name) const { return const_cast<Table*>(this)->find(name); }

void Table::keep_rows(const std::vector<bool>& kept) {
  for (auto& column : columns) {
    std::size_t to = 0;
    for (std::size_t i = 0; i < column.values.size(); ++i)
      if (kept[i]) column.values[to++] = column.values[i];
    column.values.resize(to);
  }
}

std::string to_csv(const Table& table) {
  fmt::memory_buffer text;
  auto out = std::back_inserter(text);
  for (std::size_t c = 0; c < table.columns.size(); ++c)
    fmt::format_to(out, "{}{}", c ? "," : "", table.columns[c].name);
  fmt::format_to(out, "\n");
  for (std::size_t row = 0; row < table.rows(); ++row) {
    for (std::size_t c = 0; c < table.columns.size(); ++c) {
      const auto& column = table.columns[c];
      if (c) fmt::format_to(out, ",");
      const double value = column.values[row] + 0.0;  // avoids "-0"
      if (!std::isnan(value)) fmt::format_to(out, "{:.{}f}", value, column.decimals);
    }
    fmt::format_to(out, "\n");
  }
  return fmt::to_string(text);
}

}  // namespace sandhopper::conceal
