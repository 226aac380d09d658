#pragma once
#include <vector>

#include "tools/campaign/campaign.hpp"
#include "tools/campaign/finding.hpp"

namespace sandhopper {

// One note that names the recordings (.csv, .txt) which lie beside those of the trials and which no trial
// lists. A file is a recording if it is a table with a column that the campaign reads, besides the time.
std::vector<Finding> unlisted_recordings(const Campaign& campaign);

}  // namespace sandhopper
