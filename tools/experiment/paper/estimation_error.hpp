#pragma once
#include <array>
#include <cstdint>

#include "tools/experiment/paper/hop_trial.hpp"

namespace sandhopper::paper {

// Sum of squares with its count; several add up.
struct SquareSum {
  double squares = 0.0;
  double sum = 0.0;
  double count = 0.0;

  void add(double value) {
    squares += value * value;
    sum += value;
    count += 1.0;
  }
  void add(const SquareSum& other) {
    squares += other.squares;
    sum += other.sum;
    count += other.count;
  }
  double rms() const;
  double spread() const;  // about the mean
};

// What the estimator got wrong over the stance of one trial (or of several, added up).
struct EstimationErrors {
  SquareSum quasi_static_N, observer_N, load_cell_N;     // against the true force
  SquareSum quasi_static_to_cell_N, observer_to_cell_N;  // against the load cell, as a laboratory can
  SquareSum foot_depth_m, body_height_m;                 // against motion capture
  SquareSum foot_velocity_mps, body_velocity_mps;        // against the truth
  SquareSum depth_about_trial_mean_m;  // what remains when a trial's constant offset is taken off
  SquareSum tof_m, tof_velocity_mps;   // raw height readings and their differences

  std::array<SquareSum, 3> normalised_innovation{};  // ToF, leg length, leg rate: squares over variance
  std::array<double, 3> innovations_below_384{};     // counts, chi-squared 95 %

  double cycles = 0.0;
  double fresh_load_cell = 0.0, fresh_tof = 0.0, fresh_mocap = 0.0;
  double longest_step_error_s = 0.0;  // of the cycles' time stamps from 1 ms

  void add(const EstimationErrors& other);
};

EstimationErrors estimation_errors(const HopTrial& trial);

}  // namespace sandhopper::paper
