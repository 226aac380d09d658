#include "tools/experiment/stride_campaign.hpp"

#include <algorithm>
#include <cmath>
#include <mutex>

#include "tools/experiment/parallel.hpp"
#include "tools/plant/world.hpp"

namespace sandhopper {
namespace {

constexpr long kGroup = 5;

struct Answer {
  double value = 0.0, low = 0.0, high = 0.0;
  bool valid = false;
};
Answer answer_of(const StiffnessEstimate& e) {
  return {e.value_N_per_m, e.ci95_low_N_per_m, e.ci95_high_N_per_m, e.validity == Validity::valid};
}
Answer answer_of(const JointEstimate& e) {
  return {e.value_N_per_m, e.ci95_low_N_per_m, e.ci95_high_N_per_m, e.validity == Validity::valid};
}

struct Window {
  Way way;
  SampleWindow window;
  bool free_intercept;
};
constexpr std::array<Window, 4> kOtherWindows{
    {{Way::observer_wls_new_depth, SampleWindow::new_depth, true},
     {Way::observer_wls_to_max_depth, SampleWindow::to_max_depth, true},
     {Way::observer_wls_through_origin, SampleWindow::to_max_depth, false},
     {Way::observer_wls_compression, SampleWindow::compression, true}}};

std::array<Answer, kWays> evaluate(const RecordedStride& stride, const StiffnessConfig& stiffness) {
  std::array<Answer, kWays> answers{};
  const auto put = [&](Way way, const Answer& answer) { answers[static_cast<std::size_t>(way)] = answer; };
  const auto main = evaluate_stride(stride, stiffness);
  put(Way::quasi_static_ols, answer_of(main.quasi_static_ols));
  put(Way::observer_ols, answer_of(main.observer_ols));
  put(Way::observer_wls, answer_of(main.observer_wls));
  put(Way::joint, answer_of(main.joint));
  for (const auto& other : kOtherWindows) {
    StiffnessConfig config = stiffness;
    config.window = other.window;
    config.free_intercept = other.free_intercept;
    put(other.way, answer_of(evaluate_stride(stride, config).observer_wls));
  }
  return answers;
}

double truth_of(Way way, double k_N_per_m, const BedParameters& bed, double foot_radius_m) {
  if (way == Way::joint) return k_N_per_m;
  BedParameters own = bed;
  own.stiffness_N_per_m = k_N_per_m;
  const auto slow = slow_intrusion_stiffness(own, foot_radius_m);
  return way == Way::observer_wls_through_origin ? slow.through_origin_N_per_m : slow.free_intercept_N_per_m;
}

CellSums run_group(const CampaignSetup& setup, const HopCell& cell, long first_seed) {
  CycleConfig cycle = setup.cycle;
  cycle.controller.compression_stiffness_N_per_m = cell.compression_stiffness_N_per_m;
  const double radius = setup.world.robot.leg.foot_radius_m;
  CellSums sums;
  std::array<double, kWays> group_ratio{}, group_strides{};
  for (long trial = 0; trial < kGroup; ++trial) {
    const TrialSetup hop{.release_height_m = cell.release_height_m,
                         .seed = static_cast<std::uint64_t>(first_seed + trial),
                         .noise = true};
    const double k = World(setup.world, hop, 0).plant().bed().parameters().stiffness_N_per_m;
    const auto stride = record_stride(cycle, setup.world, hop);
    sums.strides += 1.0;
    sums.simulated_s += 1e-3 * static_cast<double>(stride.samples.size());
    if (!stride.complete) {
      sums.incomplete += 1.0;
      continue;
    }
    const auto answers = evaluate(stride, cycle.stiffness);
    for (std::size_t w = 0; w < kWays; ++w) {
      const auto& a = answers[w];
      if (!std::isfinite(a.value) || a.value == 0.0) continue;
      const double truth = truth_of(static_cast<Way>(w), k, setup.world.terrain, radius);
      const double ratio = a.value / truth;
      const bool covered = a.low <= truth && truth <= a.high;
      auto& way = sums.ways[w];
      way.strides += 1.0;
      way.ratio += ratio;
      way.ratio_squared += ratio * ratio;
      way.covered += covered;
      way.valid += a.valid;
      way.valid_covered += a.valid && covered;
      group_ratio[w] += ratio;
      group_strides[w] += 1.0;
    }
  }
  for (std::size_t w = 0; w < kWays; ++w) {
    if (group_strides[w] == 0.0) continue;
    auto& way = sums.ways[w];
    way.groups = 1.0;
    way.group_error = way.worst_group_error = std::abs(group_ratio[w] / group_strides[w] - 1.0);
  }
  return sums;
}

}  // namespace

void WaySums::add(const WaySums& other) {
  strides += other.strides;
  ratio += other.ratio;
  ratio_squared += other.ratio_squared;
  covered += other.covered;
  valid += other.valid;
  valid_covered += other.valid_covered;
  groups += other.groups;
  group_error += other.group_error;
  worst_group_error = std::max(worst_group_error, other.worst_group_error);
}

void CellSums::add(const CellSums& other) {
  for (std::size_t w = 0; w < kWays; ++w) ways[w].add(other.ways[w]);
  strides += other.strides;
  incomplete += other.incomplete;
  simulated_s += other.simulated_s;
}

void StrideCampaign::add(const StrideCampaign& other) {
  for (std::size_t c = 0; c < cells.size(); ++c) cells[c].add(other.cells[c]);
}

CellSums StrideCampaign::total() const {
  CellSums sum;
  for (const auto& cell : cells) sum.add(cell);
  return sum;
}

double StrideCampaign::mean_error(Way way) const {
  double sum = 0.0, count = 0.0;
  for (const auto& cell : cells) {
    const auto& w = cell.ways[static_cast<std::size_t>(way)];
    if (w.groups == 0.0) continue;
    sum += w.group_error / w.groups;
    count += 1.0;
  }
  return sum / count;
}

double StrideCampaign::worst_cell_error(Way way) const {
  double worst = 0.0;
  for (const auto& cell : cells) {
    const auto& w = cell.ways[static_cast<std::size_t>(way)];
    if (w.groups > 0.0) worst = std::max(worst, w.worst_group_error);
  }
  return worst;
}

double StrideCampaign::coverage(Way way) const {
  const auto sum = total();
  const auto& w = sum.ways[static_cast<std::size_t>(way)];
  return w.covered / w.strides;
}

StrideCampaign run_stride_campaign(const CampaignSetup& setup) {
  const long groups = (setup.strides + kGroup - 1) / kGroup;
  const long mine = (groups - setup.part + setup.parts - 1) / setup.parts;
  const auto& cells = hop_cells();
  StrideCampaign campaign;
  std::mutex adding;
  parallel_for(
      mine, setup.threads,
      [&](long i) {
        const long group = setup.part + i * setup.parts;
        const auto cell = static_cast<std::size_t>(group) % cells.size();
        const auto sums = run_group(setup, cells[cell], setup.first_seed + kGroup * group);
        const std::lock_guard lock(adding);
        campaign.cells[cell].add(sums);
      },
      setup.progress);
  return campaign;
}

}  // namespace sandhopper
