#pragma once
#include <vector>

#include "tools/campaign/read_table.hpp"

namespace sandhopper {

// Translates the issues of the table reader into findings with their consequence, and lists the unusable
// columns in `table`. A missing time column is not reported here, because it depends on the trial if one is
// needed.
void translate_issues(const Campaign& campaign, const CampaignTrial& trial, TrialTable& table,
                      std::vector<Finding>& findings);

}  // namespace sandhopper
