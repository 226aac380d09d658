#pragma once
#include <array>
#include <cstdint>

#include "tools/experiment/paper/hop_trial.hpp"

namespace sandhopper::paper {

// Sum of squares with its count. Several can be added.
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
  double spread() const;  // standard deviation about the mean
};

// Errors of the estimator over the stance of one trial, or of several added together.
struct EstimationErrors {
  SquareSum quasi_static_N, observer_N, load_cell_N;     // against the true force
  SquareSum quasi_static_to_cell_N, observer_to_cell_N;  // against the load cell, as in a laboratory
  SquareSum foot_depth_m, body_height_m;                 // against motion capture
  SquareSum foot_velocity_mps, body_velocity_mps;        // against the truth
  SquareSum depth_about_trial_mean_m;                    // after subtracting each trial's constant offset
  SquareSum tof_m, tof_velocity_mps;                     // raw height readings and their differences

  std::array<SquareSum, 3> normalised_innovation{};  // ToF, leg length, leg rate: squares divided by the
                                                     // variance
  std::array<double, 3> innovations_below_384{};     // number below the 95 % point of chi-squared

  double cycles = 0.0;
  double fresh_load_cell = 0.0, fresh_tof = 0.0, fresh_mocap = 0.0;
  double longest_step_error_s = 0.0;  // largest deviation of the cycles' time steps from 1 ms

  void add(const EstimationErrors& other);
};

EstimationErrors estimation_errors(const HopTrial& trial);

}  // namespace sandhopper::paper
