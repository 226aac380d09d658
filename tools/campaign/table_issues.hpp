#pragma once
#include <vector>

#include "tools/campaign/read_table.hpp"

namespace sandhopper {

// Problems that the reader of tables found, as findings with what each costs; names the columns that cannot
// be used. A missing column of the time is not told here: whether one is needed depends on the trial.
void translate_issues(const Campaign& campaign, const CampaignTrial& trial, TrialTable& table,
                      std::vector<Finding>& findings);

}  // namespace sandhopper
