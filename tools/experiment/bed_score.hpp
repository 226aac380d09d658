#pragma once
#include <functional>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "terrain/ground_events.hpp"
#include "tools/experiment/bed_strides.hpp"

// Score of what a stride says about beds of every family: coverage and width of a force profile, events
// that were found, missed and false, per family of beds.
namespace sandhopper {

// The force over depth that somebody claims after one stride, normal at each depth, ascending; depths count
// from the undisturbed surface. `line_valid`: a straight line is reported as a valid description.
struct ProfileClaim {
  std::vector<double> depth_m;
  std::vector<double> mean_N;
  std::vector<double> sd_N;
  bool line_valid = false;
};

// Gives the claim for one stride; none where it makes none. Called from several threads at once.
struct ProfileProvider {
  std::string name;
  std::function<std::optional<ProfileClaim>(const BedStride&)> claim;
};

// The joint fit's line k (z + z0 (1 - exp(-z/dz0))), with k's standard error alone.
ProfileProvider joint_line_provider(const StiffnessConfig& config);

// The strength profile (terrain/strength_profile.hpp) at the depths it visited.
ProfileProvider strength_profile_provider(const StiffnessConfig& config);

struct ProfileScore {
  double claims = 0.0;
  double depths = 0.0;               // at which a claim was compared: visited by the foot, from 2 mm on
  double covered = 0.0;              // of those, truth inside mean +- 1.96 sd
  double squared_error = 0.0;        // of (mean - truth) / truth
  std::vector<double> width_20mm{};  // 2 x 1.96 sd / truth at 20 mm, of strides that reached it
  double lines_valid = 0.0;

  double coverage() const { return covered / depths; }
  double median_width_20mm() const;
};

struct EventScore {
  double possible = 0.0;  // strides in which the event happened
  double found = 0.0;     // of these, with the depth within 10 mm
  double within_2mm = 0.0;
  double depth_error_m = 0.0, depth_error_squared_m2 = 0.0;  // sums over those found
  double absent = 0.0;                                       // strides in which it did not happen
  double false_alarms = 0.0;                                 // of these
  double largest_absent = 0.0;                               // statistic over threshold
};

struct BedScore {
  std::string bed;
  bool smooth = true;
  double strides = 0.0, incomplete = 0.0;
  double contact_error_m = 0.0;         // sum
  std::vector<ProfileScore> profile{};  // one a provider
  EventScore rupture{}, boundary{}, floor{}, suction{};
};

struct BedScoreSetup {
  CycleConfig cycle{};
  WorldConfig world{};
  GroundEventConfig events{};
  std::vector<ProfileProvider> providers{};
  std::vector<std::string> beds{};  // names of bed_cases(); empty: all
  long strides = 200;               // of each
  std::uint64_t first_seed = 1;
  unsigned threads = 2;
  std::function<void(long done, long total)> progress{};
};

// Throws std::invalid_argument where a name is none of bed_cases().
std::vector<BedScore> score_beds(const BedScoreSetup& setup);

void to_json(nlohmann::ordered_json& json, const BedScore& score);

}  // namespace sandhopper
