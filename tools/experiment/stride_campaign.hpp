#pragma once
#include <array>
#include <functional>
#include <nlohmann/json.hpp>
#include <string_view>
#include <vector>

#include "tools/experiment/treatments.hpp"

// Any number of simulated first strides over the 15 cells of the hop set, in bounded memory: only sums remain
// of each group of five trials. A campaign can be run in parts on several machines; the sums of the parts add
// up to those of the whole.
namespace sandhopper {

// Methods of stiffness estimation that are compared on the same strides: the paper's treatments in window A,
// its best one in the other windows, and the joint fit.
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

// Sums of k_est/k, with k the stiffness of the trial's own bed (for straight lines the slope of a slow
// intrusion into this bed).
struct WaySums {
  double strides = 0.0;  // strides with a finite result
  double ratio = 0.0;
  double ratio_squared = 0.0;
  double covered = 0.0;  // true value inside the 95 % interval
  double valid = 0.0;    // strides without a reason against using the result
  double valid_covered = 0.0;
  double groups = 0.0;       // number of groups of five trials
  double group_error = 0.0;  // sum of |mean ratio of a group - 1|
  double worst_group_error = 0.0;

  void add(const WaySums& other);
};

struct CellSums {
  std::array<WaySums, kWays> ways{};
  double strides = 0.0;
  double incomplete = 0.0;  // strides without liftoff
  double simulated_s = 0.0;

  void add(const CellSums& other);
};

struct StrideCampaign {
  std::vector<CellSums> cells = std::vector<CellSums>(hop_cells().size());

  void add(const StrideCampaign& other);
  CellSums total() const;
  // mean_error(): mean over the cells of each cell's mean group error. worst_cell_error(): its largest value
  // over the cells.
  double mean_error(Way way) const;
  double worst_cell_error(Way way) const;
  double coverage(Way way) const;
};

void to_json(nlohmann::ordered_json& json, const StrideCampaign& campaign);
// Throws nlohmann::json::exception if `json` was not written by to_json.
void from_json(const nlohmann::ordered_json& json, StrideCampaign& campaign);

struct CampaignSetup {
  CycleConfig cycle{};
  WorldConfig world{};
  long strides = 600;  // rounded up to whole groups of five
  long first_seed = 1;
  long part = 0, parts = 1;  // this part runs every `parts`-th group, beginning with `part`
  unsigned threads = 2;
  std::function<void(long done, long total)> progress{};  // counted in groups
};
StrideCampaign run_stride_campaign(const CampaignSetup& setup);

}  // namespace sandhopper
