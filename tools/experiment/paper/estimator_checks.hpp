#pragma once
#include "estimation/kalman_filter.hpp"
#include "tools/plant/world_config.hpp"

// Checks of the estimator's equations without a bed.
namespace sandhopper::paper {

// Compares the mean of pdot - psi over each 0.1 ms of a noise-free hop without friction with the mean true
// force.
struct MomentumCheck {
  double largest_N;
  double rms_N;
};
MomentumCheck momentum_balance(const WorldConfig& world);

// Step response of the observer at 1 kHz: its time constant, and its largest difference from the internal
// form r = k (p - integral (psi + r) dt) integrated in steps of 1 us.
struct ObserverStep {
  double time_constant_s;
  double expected_s;                // 1/k
  double internal_form_difference;  // share of the step
};
ObserverStep observer_step(double gain_per_s);

// Observability of the filter's model, and its normalised squared innovations if the model is true: their
// mean over all runs, and the number of runs whose mean lies inside its 95 % band.
struct FilterCheck {
  int rank_with_tof = 0;
  int rank_without_tof = 0;
  double mean_normalised = 0.0;
  int runs_inside_band = 0;
  int runs = 0;
};
FilterCheck filter_check(const KalmanConfig& config);

}  // namespace sandhopper::paper
