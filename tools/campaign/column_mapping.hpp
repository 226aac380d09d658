#pragma once
#include <string>
#include <vector>

#include "config/node.hpp"
#include "tools/campaign/campaign.hpp"

namespace sandhopper {

// A table [columns] of channels and columns. The short form `t_s = "time"` means scale 1, offset 0.
// A mapping that cannot be understood makes the trials that use it unusable: without it another column would
// be taken, or the same one without its scale and offset.
struct ColumnTable {
  std::vector<ColumnMapping> columns;
  std::vector<Finding> findings;
};

ColumnTable read_column_table(const ConfigNode& table, CampaignPlant plant, const std::string& file);

}  // namespace sandhopper
