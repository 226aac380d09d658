#pragma once
#include <array>
#include <functional>
#include <nlohmann/json.hpp>
#include <string_view>
#include <vector>

#include "tools/experiment/treatments.hpp"

// Any number of simulated first strides over the 15 cells of the hop set, in bounded memory: of each group of
// five trials only sums remain. A campaign can be run in parts, on other machines, and merged: the parts'
// sums add up to the whole's.
namespace sandhopper {

// Ways to a stiffness that are compared on the same strides: the paper's treatments in window A, its best one
// in the other windows, and the joint fit.
enum class Way : std::size_t {
  quasi_static_ols,
  observer_ols,
  observer_wls,
  observer_wls_new_depth,
  observer_wls_to_max_depth,
  observer_wls_through_origin,
  observer_wls_compression,
  joint
};
inline constexpr std::array<std::string_view, 8> kWayNames{"qs_ols",   "mo_ols",   "mo_wls",   "mo_wls_A2",
                                                           "mo_wls_B", "mo_wls_C", "mo_wls_E", "joint"};
inline constexpr std::size_t kWays = kWayNames.size();

// Of k_est/k, k the stiffness of that trial's own bed (for a straight line the slope a slow intrusion into it
// has).
struct WaySums {
  double strides = 0.0;  // with a finite answer
  double ratio = 0.0;
  double ratio_squared = 0.0;
  double covered = 0.0;  // truth inside the 95 % interval
  double valid = 0.0;    // no reason against using it
  double valid_covered = 0.0;
  double groups = 0.0;       // of five trials
  double group_error = 0.0;  // sum of |mean ratio of a group - 1|
  double worst_group_error = 0.0;

  void add(const WaySums& other);
};

struct CellSums {
  std::array<WaySums, kWays> ways{};
  double strides = 0.0;
  double incomplete = 0.0;  // no liftoff
  double simulated_s = 0.0;

  void add(const CellSums& other);
};

struct StrideCampaign {
  std::vector<CellSums> cells = std::vector<CellSums>(hop_cells().size());

  void add(const StrideCampaign& other);
  CellSums total() const;
  // Mean over the cells of the cells' mean group error; the greatest mean over a cell.
  double mean_error(Way way) const;
  double worst_cell_error(Way way) const;
  double coverage(Way way) const;
};

void to_json(nlohmann::ordered_json& json, const StrideCampaign& campaign);
// Throws nlohmann::json::exception where `json` is not what to_json writes.
void from_json(const nlohmann::ordered_json& json, StrideCampaign& campaign);

struct CampaignSetup {
  CycleConfig cycle{};
  WorldConfig world{};
  long strides = 600;  // rounded up to whole groups of five
  long first_seed = 1;
  long part = 0, parts = 1;  // this part runs every `parts`-th group, starting with `part`
  unsigned threads = 2;
  std::function<void(long done, long total)> progress{};  // in groups
};
StrideCampaign run_stride_campaign(const CampaignSetup& setup);

}  // namespace sandhopper
