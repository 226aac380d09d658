#include "tools/campaign/draft_setups.hpp"

#include <array>

namespace sandhopper {
namespace {

// In the order of CampaignPlant.
constexpr std::array<std::string_view, EnumNames<CampaignPlant>::value.size()> kSetups{
    "# release_height_m = 0.05   # m; the sole above the bed at the release\n"
    "# compression_stiffness_N_per_m = 500.0   # N/m; of the virtual spring in compression\n",
    "# plate_diameter_m = 0.05   # m\n# bed_depth_m = 0.30   # m\n# pushes_since_preparation = 0\n"
    "# loading_from_s = 0.0   # s\n# loading_to_s = 1.0   # s\n",
    "# diameter_m = 0.05   # m\n# mass_kg = 1.0   # kg\n# impact_speed_mps = 1.0   # m/s\n",
    "# motor_enabled = false   # the axis runs free\n"};

// In the order of CampaignPlant.
constexpr std::array<std::string_view, EnumNames<CampaignPlant>::value.size()> kAvailable{
    "# release_height_m = { from = 0.02, to = 0.10 }   # m; any in between\n"
    "# compression_stiffness_N_per_m = { from = 250.0, to = 500.0 }   # N/m\n",
    "# plate_diameter_m = [0.05, 0.08]   # m; these plates\n"
    "# impact_speed_mps = { from = 0.02, to = 0.30 }   # m/s; any in between\n"
    "# depth_m = { from = 0.02, to = 0.06 }   # m\n"
    "# profile = [\"stop_and_withdraw\"]   # cycles, through\n",
    "# release_height_m = { from = 0.2, to = 1.0 }   # m; any in between\n"
    "# release_speed_mps = [0.0]   # m/s; 0: let go\n"
    "# payload_kg = [0.1, 0.2]   # kg; these weights\n",
    "# profile = [\"release\", \"sine\"]   # chirp, ramp\n"
    "# release_position_rad = { from = 0.2, to = 1.5 }   # rad; any in between\n"
    "# amplitude_rad = { from = 0.1, to = 1.0 }   # rad\n"
    "# frequency_Hz = { from = 0.2, to = 2.0 }   # Hz\n"
    "# speed_radps = { from = 0.5, to = 5.0 }   # rad/s\n"};

}  // namespace

std::string draft_setups(CampaignPlant plant) {
  return std::string(kSetups[static_cast<std::size_t>(plant)]);
}

std::string draft_available(CampaignPlant plant) {
  return "\n[available]   # what you can set for the next trial: `hop diagnose` proposes one from it\n" +
         std::string(kAvailable[static_cast<std::size_t>(plant)]);
}

}  // namespace sandhopper
