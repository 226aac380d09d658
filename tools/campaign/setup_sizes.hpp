#pragma once
#include <optional>
#include <string>

#include "tools/campaign/campaign.hpp"

namespace sandhopper {

// Diameter of the foot, plate or body that a belief holds, in m. Empty for a plant without one, or a body
// whose area is not stated.
std::optional<double> believed_diameter_m(const Belief& belief);

// A trial that states two different sizes of its foot (plate_diameter_m = 0.04 and radius_m = 0.04), or one
// under a name that is not read and that differs from the size in use (probe_diameter_mm = 50, plate_area_cm2
// = 50, plate_width_m = 0.08, plate = "80 mm"). A second size of the same value, and that of a grain or a
// container, is none.
std::optional<Finding> contradicting_sizes(const CampaignTrial& trial, CampaignPlant plant,
                                           const std::string& file);

}  // namespace sandhopper
