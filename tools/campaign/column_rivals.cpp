#include "tools/campaign/column_rivals.hpp"

#include <fmt/format.h>

#include "tools/campaign/column_guess.hpp"
#include "tools/campaign/read_table.hpp"

namespace sandhopper {

std::optional<WrittenUnit> unit_of_column(const CsvTable& table, std::size_t column) {
  if (auto unit = read_unit(table.units[column], true)) return unit;
  return unit_in_name(table.names[column]);
}

std::vector<std::size_t> rivals_of_column(const CsvTable& table, CampaignPlant plant,
                                          const std::string& channel, std::size_t taken) {
  std::vector<std::size_t> rivals;
  for (std::size_t i = 0; i < table.names.size(); ++i) {
    if (i == taken || is_setpoint_by_name(table.names[i])) continue;
    const auto guess = guess_column(table.names[i], unit_of_column(table, i), plant, {});
    if (guess && guess->channel == channel) rivals.push_back(i);
  }
  return rivals;
}

std::vector<std::size_t> rivals_of_time(const CsvTable& table, std::size_t taken) {
  std::vector<std::size_t> rivals;
  for (std::size_t i = 0; i < table.names.size(); ++i) {
    const auto unit = unit_of_column(table, i);
    const bool in_time = unit && unit->is_certain && unit->dimension == "time";
    if (i != taken && (in_time || is_called_time(table.names[i]))) rivals.push_back(i);
  }
  return rivals;
}

bool has_two_motors(const CsvTable& table) {
  std::size_t angles = 0, currents = 0;
  for (std::size_t i = 0; i < table.names.size(); ++i) {
    if (is_setpoint_by_name(table.names[i])) continue;
    const auto unit = unit_of_column(table, i);
    angles += unit && unit->dimension == "angle";
    currents += unit && unit->dimension == "current";
  }
  return angles == 2 && currents == 2;
}

std::string rivals_in_words(const CsvTable& table, const std::vector<std::size_t>& rivals) {
  if (rivals.empty()) return "";
  std::vector<std::string> names;
  for (const auto i : rivals) names.push_back(fmt::format("\"{}\"", table.names[i]));
  return names.size() == 1
             ? fmt::format("column {} fits as well; to take it, name it in [columns]", names.front())
             : fmt::format("columns {} fit as well; to take one of them, name it in [columns]",
                           fmt::join(names, ", "));
}

}  // namespace sandhopper
