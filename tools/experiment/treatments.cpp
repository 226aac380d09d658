#include "tools/experiment/treatments.hpp"

#include <cmath>

#include "tools/experiment/parallel.hpp"

namespace sandhopper {

const std::vector<HopCell>& hop_cells() {
  static const std::vector<HopCell> cells = [] {
    const std::array<std::array<double, 2>, 5> speeds{
        {{0.2, 0.0025}, {0.45, 0.0125}, {0.7, 0.0303}, {1.0, 0.0618}, {1.2, 0.0890}}};
    std::vector<HopCell> out;
    for (const auto& [speed, height] : speeds)
      for (const double k : {250.0, 375.0, 500.0}) out.push_back({speed, height, k});
    return out;
  }();
  return cells;
}

const std::vector<TreatmentCase>& treatment_cases() {
  static const std::vector<TreatmentCase> cases{
      {"A", SampleWindow::penetrating, true},   {"A2", SampleWindow::new_depth, true},
      {"B", SampleWindow::to_max_depth, true},  {"C", SampleWindow::to_max_depth, false},
      {"C2", SampleWindow::penetrating, false}, {"D", SampleWindow::whole_stance, true},
      {"E", SampleWindow::compression, true},   {"T", SampleWindow::penetrating, true, true}};
  return cases;
}

GroundTruthStiffness slow_intrusion_stiffness(const BedParameters& parameters, double foot_radius_m) {
  const Bed bed(parameters, foot_radius_m);
  RecursiveRegression line;
  for (int i = 1; i <= 500; ++i) {
    const double depth = 1e-4 * i;
    line.add({depth, bed.quasi_static_force_N(depth), 1.0});
  }
  StiffnessConfig config;
  config.free_intercept = true;
  const double free = solve_stiffness(line.sums(), config).value_N_per_m;
  config.free_intercept = false;
  return {free, solve_stiffness(line.sums(), config).value_N_per_m};
}

std::array<double, kTreatments> CaseResult::mean_error() const {
  std::array<double, kTreatments> mean{};
  for (const auto& seed : error_by_seed)
    for (std::size_t t = 0; t < kTreatments; ++t)
      mean[t] += seed[t] / static_cast<double>(error_by_seed.size());
  return mean;
}

int CaseResult::seeds_in_order(Treatment worse, Treatment better) const {
  int count = 0;
  for (const auto& seed : error_by_seed)
    count += seed[static_cast<std::size_t>(worse)] > seed[static_cast<std::size_t>(better)];
  return count;
}

namespace {

struct ErrorSums {
  double quasi_static = 0.0, observer = 0.0, load_cell = 0.0, depth = 0.0, velocity = 0.0;
  double samples = 0.0;

  void add(const RecordedStride& stride) {
    for (const auto& s : stride.samples) {
      if (s.state != State::compression && s.state != State::extension) continue;
      const auto square = [](double x) { return x * x; };
      quasi_static += square(s.estimate.quasi_static_force_N - s.true_force_N);
      observer += square(s.estimate.contact_force_N - s.true_force_N);
      load_cell += square(s.estimate.load_cell_force_N - s.true_force_now_N);
      depth += square(s.estimate.force_depth_m + s.true_foot_z_m);
      velocity += square(s.estimate.force_velocity_mps + s.true_foot_velocity_mps);
      samples += 1.0;
    }
  }
  void add(const ErrorSums& other) {
    quasi_static += other.quasi_static;
    observer += other.observer;
    load_cell += other.load_cell;
    depth += other.depth;
    velocity += other.velocity;
    samples += other.samples;
  }
};

using Stiffnesses = std::array<double, kTreatments>;

struct StrideOutcome {
  std::vector<Stiffnesses> by_case;
  ErrorSums errors;
  bool complete = false;
};

StrideOutcome run_one(const StudySetup& setup, const HopCell& cell, std::uint64_t seed) {
  CycleConfig cycle = setup.cycle;
  cycle.controller.compression_stiffness_N_per_m = cell.compression_stiffness_N_per_m;
  StrideWatch watch;
  if (setup.ignore_ages)
    watch.before_cycle = [](SensorFrame& frame) {
      if (frame.tof.fresh) frame.tof.time_ns = frame.time_ns;
    };
  auto stride = record_stride(
      cycle, setup.world, {.release_height_m = cell.release_height_m, .seed = seed, .noise = true}, watch);
  if (setup.ignore_ages) stride = paired_by_row(stride);
  StrideOutcome outcome;
  outcome.complete = stride.complete;
  if (!stride.complete) return outcome;
  outcome.errors.add(stride);
  const auto true_stride = with_true_state(stride);
  for (const auto& definition : treatment_cases()) {
    StiffnessConfig config = cycle.stiffness;
    config.window = definition.window;
    config.free_intercept = definition.free_intercept;
    const auto result = evaluate_stride(definition.true_state ? true_stride : stride, config);
    outcome.by_case.push_back({result.quasi_static_ols.value_N_per_m, result.observer_ols.value_N_per_m,
                               result.observer_wls.value_N_per_m});
  }
  return outcome;
}

// Every (seed, cell, trial) has its own element, so the result does not depend on the number of threads.
std::vector<StrideOutcome> run_all(const StudySetup& setup) {
  const auto& cells = hop_cells();
  const int per_seed = static_cast<int>(cells.size()) * setup.trials_per_cell;
  const int total = setup.seeds * per_seed;
  std::vector<StrideOutcome> outcomes(static_cast<std::size_t>(total));
  parallel_for(
      total, std::max(setup.threads, 1U),
      [&](long i) {
        const auto& cell = cells[static_cast<std::size_t>(i % per_seed / setup.trials_per_cell)];
        outcomes[static_cast<std::size_t>(i)] = run_one(setup, cell, static_cast<std::uint64_t>(i + 1));
      },
      [&](long done, long all) {
        if (setup.progress) setup.progress(static_cast<int>(done), static_cast<int>(all));
      });
  return outcomes;
}

CaseResult collect_case(const StudySetup& setup, const std::vector<StrideOutcome>& outcomes,
                        std::size_t index, double truth_N_per_m) {
  CaseResult result{treatment_cases()[index], {}, {}};
  const std::size_t cells = hop_cells().size();
  const auto trials = static_cast<std::size_t>(setup.trials_per_cell);
  for (std::size_t seed = 0; seed < static_cast<std::size_t>(setup.seeds); ++seed) {
    std::array<double, kTreatments> error{};
    auto& ratios = result.ratio.emplace_back();
    for (std::size_t cell = 0; cell < cells; ++cell) {
      std::array<double, kTreatments> mean{};
      double count = 0.0;
      for (std::size_t trial = 0; trial < trials; ++trial) {
        const auto& outcome = outcomes[(seed * cells + cell) * trials + trial];
        if (!outcome.complete) continue;
        for (std::size_t t = 0; t < kTreatments; ++t) mean[t] += outcome.by_case[index][t] / truth_N_per_m;
        count += 1.0;
      }
      for (std::size_t t = 0; t < kTreatments; ++t) {
        mean[t] /= count;
        error[t] += std::abs(mean[t] - 1.0) / static_cast<double>(cells);
      }
      ratios.push_back(mean);
    }
    result.error_by_seed.push_back(error);
  }
  return result;
}

}  // namespace

TreatmentStudy run_treatment_study(const StudySetup& setup) {
  const auto outcomes = run_all(setup);
  TreatmentStudy study;
  study.truth = slow_intrusion_stiffness(setup.world.terrain, setup.world.robot.leg.foot_radius_m);
  study.strides = static_cast<int>(outcomes.size());
  for (const auto& outcome : outcomes) study.incomplete += !outcome.complete;
  for (std::size_t i = 0; i < treatment_cases().size(); ++i) {
    const bool free = treatment_cases()[i].free_intercept;
    study.cases.push_back(collect_case(
        setup, outcomes, i, free ? study.truth.free_intercept_N_per_m : study.truth.through_origin_N_per_m));
  }
  const std::size_t per_speed = 3 * static_cast<std::size_t>(setup.trials_per_cell);
  const std::size_t speeds = hop_cells().size() / 3;
  for (std::size_t speed = 0; speed < speeds; ++speed) {
    ErrorSums sums;
    for (std::size_t i = 0; i < outcomes.size(); ++i)
      if (i / per_speed % speeds == speed) sums.add(outcomes[i].errors);
    const auto rms = [&](double total) { return std::sqrt(total / sums.samples); };
    study.errors.push_back({hop_cells()[3 * speed].touchdown_speed_mps, rms(sums.quasi_static),
                            rms(sums.observer), rms(sums.load_cell), rms(sums.depth), rms(sums.velocity)});
  }
  return study;
}

}  // namespace sandhopper
