#pragma once
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "firmware/controller_config.hpp"
#include "firmware/records.hpp"
#include "terrain/ground_events.hpp"
#include "tools/experiment/treatments.hpp"
#include "tools/plant/bed_truth.hpp"

// Trials on fresh beds of every family, run by the firmware's own controller on the simulated robot:
// what the firmware knew of each, beside the true bed.
namespace sandhopper {

// The bed of a set of strides, and its name in tables.
struct BedCase {
  std::string name;
  BedFamilyParameters family{};
  bool standard = true;  // scored where no bed is named
};
// The families of terrain/bed_family.hpp and the power law at exactly 1.4. By name alone: that law at other
// exponents, a crust at the surface, and a box with a floor.
const std::vector<BedCase>& bed_cases();
// Those with these names; where there are none, the standard ones. Throws std::invalid_argument where a name
// is none of bed_cases().
std::vector<BedCase> named_bed_cases(const std::vector<std::string>& names);

// One stride of a trial: what the cycle handed over, and what was true.
struct BedStride {
  StrideSums sums{};
  GroundEventSums events{};
  double true_crater_m = 0.0;  // deepest point of the strides before
  double true_deepest_m = 0.0;
  // Of a later stride, where its foot reached new ground: error of the depth there, less that of the
  // crater's.
  std::optional<double> landing_error_m{};
  bool events_complete = false;
};

struct BedTrial {
  BedTruth truth{};
  std::vector<BedStride> strides{};  // those that lifted off
  double contact_error_m = 0.0;      // true depth at the first contact
};

// Trial number `seed` - 1 of a case: its set-up cycles through hop_cells(). Ends after `strides`, or where
// the robot does not lift off again.
BedTrial run_bed_trial(const CycleConfig& cycle, const WorldConfig& world, const BedCase& bed,
                       std::uint64_t seed, int strides);

}  // namespace sandhopper
