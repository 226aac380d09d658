#pragma once
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "firmware/controller_config.hpp"
#include "firmware/records.hpp"
#include "terrain/ground_events.hpp"
#include "tools/experiment/depth_errors.hpp"
#include "tools/experiment/treatments.hpp"
#include "tools/plant/bed_truth.hpp"

// Trials on fresh beds of every family, run by the firmware's own controller on the simulated robot. Each
// gives the firmware's data and the true bed.
namespace sandhopper {

// A bed for a set of strides, with its name in tables.
struct BedCase {
  std::string name;
  BedFamilyParameters family{};
  bool standard = true;  // scored if no bed is named
};
// The families of terrain/bed_family.hpp and the power law with exponent 1.4. Only by name: the power law
// with other exponents, a crust at the surface, and a box with a floor.
const std::vector<BedCase>& bed_cases();
// Cases with these names; without names the standard ones. Throws std::invalid_argument if a name is not in
// bed_cases().
std::vector<BedCase> named_bed_cases(const std::vector<std::string>& names);

// One stride of a trial: the data from the cycle, and the true values.
struct BedStride {
  StrideSums sums{};
  GroundEventSums events{};
  double true_crater_m = 0.0;  // deepest point of the previous strides
  double true_deepest_m = 0.0;
  // For a later stride whose foot reached new ground: depth error there minus the depth error of the crater.
  std::optional<double> landing_error_m{};
  bool events_complete = false;
};

struct BedTrial {
  BedTruth truth{};
  std::vector<BedStride> strides{};  // strides with a liftoff
  double contact_error_m = 0.0;      // true depth at the first contact
  StrideDepthErrors depth_errors{};  // of the first stride's samples on new ground, 2 mm apart
};

// The drop height has a standard deviation of 0.5 mm, as one that is set by hand. With exact heights, all
// trials of a set-up would touch the ground at the same time within a cycle.
WorldConfig with_drop_scatter(WorldConfig world);

// Runs trial number `seed` - 1 of a case. Its set-up cycles through hop_cells(). Ends after `strides`
// strides, or when the robot does not lift off again. Trials with one `robot_seed` are those of one robot; by
// default each trial has its own.
BedTrial run_bed_trial(const CycleConfig& cycle, const WorldConfig& world, const BedCase& bed,
                       std::uint64_t seed, int strides, std::optional<std::uint64_t> robot_seed = {});

}  // namespace sandhopper
