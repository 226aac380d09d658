#include "tools/campaign/shared_columns.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <vector>

#include "config/hint.hpp"
#include "tools/campaign/read_table.hpp"
#include "tools/campaign/used_column.hpp"

namespace sandhopper {

std::optional<Finding> shared_column(const CsvTable& table, const CampaignTrial& trial,
                                     const std::string& campaign_file) {
  std::vector<const ColumnMapping*> counted;  // The first mapping of a channel counts.
  for (const auto& mapping : trial.columns) {
    const auto* column = find_column(table, mapping.column);
    if (column == nullptr ||
        std::ranges::find(counted, mapping.channel, &ColumnMapping::channel) != counted.end())
      continue;
    const auto unit = unit_of_key(mapping.channel);
    for (const auto* other : counted)
      if (find_column(table, other->column) == column && unit_of_key(other->channel) != unit)
        return Finding{FindingKind::set_up,
                       FindingSeverity::trial_unusable,
                       campaign_file,
                       mapping.position.line,
                       mapping.position.column,
                       mapping.channel,
                       fmt::format("takes column {}, which {} takes, too: a column holds one quantity",
                                   toml_text(mapping.column), other->channel),
                       fmt::format("name another column for one of them; the columns are {}",
                                   fmt::join(table.names, ", "))};
    counted.push_back(&mapping);
  }
  return std::nullopt;
}

}  // namespace sandhopper
