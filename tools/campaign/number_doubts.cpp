#include "tools/campaign/number_doubts.hpp"

#include <fmt/format.h>

#include "tools/campaign/column_checks.hpp"
#include "tools/campaign/column_names.hpp"

namespace sandhopper {

std::vector<Finding> doubts_of_numbers(const CsvTable& table, const std::string& file,
                                       const CampaignTrial& trial, std::size_t column, bool is_stated) {
  using enum FindingSeverity;
  std::vector<Finding> out;
  const auto& values = table.columns[column];
  const auto line = [&](std::size_t row) { return row < table.lines.size() ? table.lines[row] : 1; };
  if (const auto fill = fill_value_in(values))
    out.push_back(
        {FindingKind::implausible, is_stated ? note : trial_unusable, file, line(fill->first_row), 1,
         table.names[column],
         fmt::format("reads {:.10g} in {} rows, far from all others: written where there is no sample?",
                     fill->value, fill->rows),
         is_stated ? "taken as stated in [columns]"
                   : fmt::format(
                         "if so write [format] no_sample = [\"{:.10g}\"]; if it was measured, state unit and "
                         "scale of the column",
                         fill->value)});
  const auto* time = time_column(table, trial);
  if (time != nullptr && equals_time(values, *time))
    out.push_back({FindingKind::implausible, trial_unusable, file, line(0), 1, table.names[column],
                   "holds the same numbers as the time: the names stand over the wrong columns",
                   "export the table again, or give names = [...] in [format] with header_line = 0"});
  return out;
}

std::optional<Finding> misnamed_column(const CsvTable& table, const std::string& file, CampaignPlant plant,
                                       const CampaignTrial& trial, std::size_t column) {
  const auto& name = table.names[column];
  const auto misnamed = misnamed_unit(name, plant);
  if (!misnamed || table.find(misnamed->channel) != nullptr ||
      mapping_of(trial, misnamed->channel) != nullptr)
    return std::nullopt;
  return Finding{
      FindingKind::unknown_unit,
      FindingSeverity::channel_unusable,
      file,
      table.layout.header_line,
      1,
      name,
      fmt::format("looks like channel {} in the unit \"{}\", which is not the channel's; column left out",
                  misnamed->channel, misnamed->unit),
      misnamed->scale
          ? fmt::format("add {} = {{ column = \"{}\", scale = {:.10g} }} to [columns]", misnamed->channel,
                        name, *misnamed->scale)
          : fmt::format("say what it is in SI units: {} = {{ column = \"{}\", scale = … }} in [columns]",
                        misnamed->channel, name)};
}

}  // namespace sandhopper
