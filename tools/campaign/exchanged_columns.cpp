#include "tools/campaign/exchanged_columns.hpp"

#include <fmt/format.h>

#include "tools/campaign/column_guess.hpp"
#include "tools/campaign/column_rivals.hpp"
#include "tools/campaign/read_table.hpp"
#include "tools/campaign/used_column.hpp"

namespace sandhopper {
namespace {

bool fits(const std::optional<WrittenUnit>& unit, std::string_view channel) {
  const auto wanted = unit_of_channel(channel);
  return unit && wanted && factor_between(*unit, *wanted).has_value();
}

// The unit that the file itself states for a column; empty unless it is certain.
std::optional<WrittenUnit> certain_unit(const CsvTable& table, std::size_t i) {
  auto unit = unit_of_column(table, i);
  return unit && unit->is_certain && !unit->dimension.empty() ? unit : std::nullopt;
}

// The line for a column that belongs to `channel`: unit alone, or a negative scale alone for a depth by name.
std::string right_line(const CsvTable& table, std::size_t i, const WrittenUnit& unit,
                       const std::string& channel, CampaignPlant plant) {
  const auto guess = guess_column(table.names[i], unit, plant, {});
  const auto column = toml_text(table.names[i]);
  return guess && guess->channel == channel && guess->is_downward
             ? fmt::format("{} = {{ column = {}, scale = {:.9g} }}", channel, column, guess->scale)
             : fmt::format("{} = {{ column = {}, unit = {} }}", channel, column, toml_text(unit.text));
}

}  // namespace

std::optional<Exchange> find_exchange(const CsvTable& table, const CampaignTrial& trial, CampaignPlant plant,
                                      const ColumnUnits& column) {
  const auto index_of = [&](const std::string& name) -> std::optional<std::size_t> {
    const auto* found = find_column(table, name);
    if (found == nullptr) return std::nullopt;
    return static_cast<std::size_t>(found - table.columns.data());
  };
  const auto here = index_of(column.column);
  const auto unit = here ? certain_unit(table, *here) : std::nullopt;
  const bool own_word = !column.stated_unit.empty() && column.has_scale;
  if (!unit || fits(unit, column.channel)) return std::nullopt;
  for (const auto& other : trial.columns) {
    const auto there = other.channel == column.channel ? std::nullopt : index_of(other.column);
    const auto others = there ? certain_unit(table, *there) : std::nullopt;
    const bool crossed =
        others && !fits(others, other.channel) && fits(others, column.channel) && fits(unit, other.channel);
    if (!crossed || (own_word && other.is_stated())) continue;
    return Exchange{
        fmt::format("this column is in {} and \"{}\", which {} takes, is in {}: the columns of {} and "
                    "{} are exchanged",
                    unit->text, other.column, other.channel, others->text, column.channel, other.channel),
        fmt::format("write {} and {} into [columns]",
                    right_line(table, *there, *others, column.channel, plant),
                    right_line(table, *here, *unit, other.channel, plant))};
  }
  return std::nullopt;
}

}  // namespace sandhopper
