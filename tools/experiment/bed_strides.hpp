#pragma once
#include <cstdint>
#include <string>
#include <vector>

#include "firmware/controller_config.hpp"
#include "firmware/records.hpp"
#include "terrain/joint_fit.hpp"
#include "tools/experiment/treatments.hpp"
#include "tools/plant/bed_truth.hpp"

// First strides on fresh beds of every family, run by the firmware's own controller on the simulated robot:
// what the firmware knew of each, beside the true bed.
namespace sandhopper {

// The bed of a set of strides, and its name in tables.
struct BedCase {
  std::string name;
  BedFamilyParameters family{};
  bool smooth =
      true;  // without a crust, a boundary, a floor or suction: an event found here is a false alarm
};
// The families of terrain/bed_family.hpp, the power law at four exponents, the crust buried and at the
// surface, and a box with a floor.
const std::vector<BedCase>& bed_cases();

struct BedStride {
  BedTruth truth{};
  // From the first contact until the foot is in the air again; depth counts from that contact.
  std::vector<JointSample> samples{};
  std::vector<double> phase_changes_s{};  // stance switch and liftoff, after the contact
  double contact_error_m = 0.0;           // true depth at the first contact
  double true_max_depth_m = 0.0;
  StrideResult result{};
  ProfileSums profile{};
  bool complete = false;  // liftoff was reached
};

// Stride number `seed` - 1 of a case: its set-up cycles through hop_cells().
BedStride run_bed_stride(const CycleConfig& cycle, const WorldConfig& world, const BedCase& bed,
                         std::uint64_t seed);

}  // namespace sandhopper
