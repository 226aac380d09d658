#include "tools/experiment/paper/sensitivity.hpp"

#include <cmath>
#include <stdexcept>

namespace sandhopper::paper {
namespace {

// Removes the added-mass force but keeps the drag from its gradient.
void without_added_mass_force(CycleConfig&, WorldConfig& world) {
  world.terrain.added_mass_switch_speed_mps = 1e12;
}

void set_torque_limit(CycleConfig& cycle, WorldConfig& world, double limit_Nm) {
  cycle.limits.motor_torque_Nm = limit_Nm;
  world.motor.torque_limit_Nm = limit_Nm;
}

void make_sensors_ideal(CycleConfig&, WorldConfig& world) {
  auto& s = world.sensors;
  s.imu_noise_mps2 = s.imu_structure_noise_mps2 = s.tof_noise_m = s.encoder_noise_rad = s.current_noise_A =
      0.0;
  s.encoder_counts_per_rev = 0.0;
  auto& spread = world.spread;
  spread.imu_raw_offset_mps2 = spread.imu_bias_mps2 = spread.imu_scale_relative = spread.tof_bias_m = 0.0;
  spread.torque_constant_relative = spread.current_offset_A = 0.0;
}

Condition estimator(std::string name, std::function<void(CycleConfig&)> change) {
  return {std::move(name), [change = std::move(change)](CycleConfig& cycle, WorldConfig&) { change(cycle); }};
}

Condition bed(std::string name, std::function<void(BedParameters&)> change) {
  return {std::move(name),
          [change = std::move(change)](CycleConfig&, WorldConfig& world) { change(world.terrain); }};
}

std::vector<Condition> make_conditions() {
  std::vector<Condition> list{{"base", [](CycleConfig&, WorldConfig&) {}}};
  for (const int gain : {50, 100, 200, 800})
    list.push_back(estimator("observer gain " + std::to_string(gain) + " 1/s",
                             [gain](CycleConfig& c) { c.estimator.observer_gain_per_s = gain; }));
  for (const int threshold : {2, 12})
    list.push_back(estimator("a0 = " + std::to_string(threshold) + " m/s^2", [threshold](CycleConfig& c) {
      c.stiffness.weights.threshold_mps2 = threshold;
    }));
  for (const int speed : {5, 10, 100})
    list.push_back(estimator("samples faster than " + std::to_string(speed) + " mm/s",
                             [speed](CycleConfig& c) { c.stiffness.min_speed_mps = 1e-3 * speed; }));
  list.push_back({kNoAddedMassForce, without_added_mass_force});
  list.push_back(bed("drag twice the mass gradient", [](BedParameters& b) { b.drag_factor = 2.0; }));
  list.push_back(
      bed("steady drag, coefficient 1", [](BedParameters& b) { b.steady_drag_coefficient = 1.0; }));
  list.push_back(bed("half the added mass", [](BedParameters& b) { b.added_mass_factor = 0.5; }));
  list.push_back(bed("twice the added mass", [](BedParameters& b) { b.added_mass_factor = 2.0; }));
  for (const int k : {1000, 2000, 3000})
    list.push_back(
        bed("bed of " + std::to_string(k) + " N/m", [k](BedParameters& b) { b.stiffness_N_per_m = k; }));
  for (const int z0 : {0, 10, 20})
    list.push_back(bed("intercept depth " + std::to_string(z0) + " mm",
                       [z0](BedParameters& b) { b.intercept_depth_m = 1e-3 * z0; }));
  for (const int ratio : {10, 100})
    list.push_back(bed("unloading " + std::to_string(ratio) + " times as stiff as loading",
                       [ratio](BedParameters& b) { b.unloading_stiffness_ratio = ratio; }));
  list.push_back(
      {"torque limit 2.4 N m", [](CycleConfig& c, WorldConfig& w) { set_torque_limit(c, w, 2.4); }});
  list.push_back(
      {"torque limit 4.0 N m", [](CycleConfig& c, WorldConfig& w) { set_torque_limit(c, w, 4.0); }});
  list.push_back({"no rail friction", [](CycleConfig&, WorldConfig& w) { w.robot.rail_coulomb_N = 0.0; }});
  list.push_back(
      estimator("believed foot mass 10 % high", [](CycleConfig& c) { c.robot.foot_mass_kg *= 1.1; }));
  list.push_back({"ToF 15 mm rms, 10 mm offset", [](CycleConfig&, WorldConfig& w) {
                    w.sensors.tof_noise_m = 0.015;
                    w.spread.tof_bias_m = 0.010;
                  }});
  list.push_back({"ideal sensors", make_sensors_ideal});
  return list;
}

const CaseResult& case_of(const TreatmentStudy& study, std::string_view name) {
  for (const auto& result : study.cases)
    if (result.definition.name == name) return result;
  throw std::out_of_range("no treatment case of that name");
}

// Mean error over the cells of one seed that have a liftoff.
std::array<double, kTreatments> seed_error(const std::vector<std::array<double, kTreatments>>& cells,
                                           const std::function<bool(const HopCell&)>& wanted, double& count) {
  std::array<double, kTreatments> sum{};
  count = 0.0;
  for (std::size_t cell = 0; cell < cells.size(); ++cell) {
    if (wanted && !wanted(hop_cells()[cell])) continue;
    if (!std::isfinite(cells[cell][0])) continue;
    for (std::size_t t = 0; t < kTreatments; ++t) sum[t] += std::abs(cells[cell][t] - 1.0);
    count += 1.0;
  }
  return sum;
}

int seeds_weighted_better(const CaseResult& result) {
  int better = 0;
  for (const auto& seed : result.ratio) {
    double count = 0.0;
    const auto sum = seed_error(seed, {}, count);
    better += sum[static_cast<std::size_t>(Treatment::observer_ols)] >
              sum[static_cast<std::size_t>(Treatment::observer_wls)];
  }
  return better;
}

}  // namespace

std::array<double, kTreatments> cell_error(const CaseResult& result,
                                           const std::function<bool(const HopCell&)>& wanted) {
  std::array<double, kTreatments> error{};
  double cells = 0.0;
  for (const auto& seed : result.ratio) {
    double count = 0.0;
    const auto sum = seed_error(seed, wanted, count);
    for (std::size_t t = 0; t < kTreatments; ++t) error[t] += sum[t];
    cells += count;
  }
  for (auto& value : error) value /= cells;
  return error;
}

const std::vector<Condition>& conditions() {
  static const std::vector<Condition> list = make_conditions();
  return list;
}

ConditionResult run_condition(const StudySetup& study, const Condition& condition) {
  StudySetup setup = study;
  condition.change(setup.cycle, setup.world);
  const auto found = run_treatment_study(setup);
  const auto& a = case_of(found, "A");
  return {.name = condition.name,
          .penetrating = cell_error(a),
          .to_max_depth = cell_error(case_of(found, "B")),
          .seeds = setup.seeds,
          .seeds_weighted_better = seeds_weighted_better(a),
          .strides = found.strides,
          .incomplete = found.incomplete};
}

}  // namespace sandhopper::paper
