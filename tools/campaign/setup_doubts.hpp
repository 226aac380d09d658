#pragma once
#include <string>
#include <vector>

#include "tools/campaign/campaign.hpp"
#include "tools/campaign/setup_vocabulary.hpp"

namespace sandhopper {

// Finds set-up keys that say something the tools need, but in a form that they do not read: a known quantity
// in another unit (plate_diameter_mm), a misspelt key, a number as a text, two sizes of one foot. Their trial
// is unusable, because its numbers would be those of nominal.toml or of a default. A key of the laboratory's
// own (operator, temperature_C) is none of these and stays silent.
class SetupDoubts {
 public:
  SetupDoubts(CampaignPlant plant, std::string file);

  std::vector<Finding> of(const CampaignTrial& trial) const;

 private:
  CampaignPlant plant_;
  std::string file_;  // campaign.toml
  std::vector<SetupWord> words_;
};

}  // namespace sandhopper
