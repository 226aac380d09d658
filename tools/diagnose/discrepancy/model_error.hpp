#pragma once
#include <Eigen/Core>
#include <string>
#include <vector>

#include "tools/diagnose/discrepancy/low_rank.hpp"

namespace sandhopper::diagnose {

struct Problem;
struct Point;
struct Signatures;
class NoiseModel;

// Standard deviations of the model error. Their source is in tools/diagnose/README.md, "Model error".
struct ModelErrorScales {
  double numerical = 1.0;     // relative to the difference between equivalent simulations
  double port_knot_s = 0.02;  // Knot spacing in time of the force or torque error (PlantModel::port_error).
  double repeatable = 0.01;   // Error common to all trials, in scales of its port.
  double typical = 0.015;     // Common error along each listed effect, in its typical size.
  double reading = 0.06;      // The same for effects on readings and time stamps.
};
inline constexpr ModelErrorScales kModelErrorScales{};

// Model error that is the same in all trials: laws of free form at the plant's ports, and a small amount of
// every listed effect. The columns are multiplied by their prior standard deviations. They are small, so
// their derivatives are taken at one point only.
struct RepeatableError {
  std::vector<int> group;              // Columns of a group share one scale.
  std::vector<std::size_t> candidate;  // Candidate of each column; kNoCandidate for a law of free form.
  std::vector<Eigen::MatrixXd> white;  // One matrix per trial, whitened.

  static constexpr std::size_t kNoCandidate = static_cast<std::size_t>(-1);
  std::size_t size() const { return group.size(); }
};

// Model error of one trial, independent of the other trials:
//   D = [numerical variants, port forces u_{p,t}], each column times its prior standard deviation
// and row_sd: the part of the difference between simulations without a sign, independent in each row.
struct ModelError {
  Eigen::MatrixXd columns;  // D in the rows' units
  Eigen::VectorXd row_sd;   // in the rows' units
  Eigen::MatrixXd white;    // D whitened by the noise model
  LowRank low_rank;         // of `white`
};

// Uses the signatures' derivatives and the present noise model.
RepeatableError repeatable_error(const Problem& problem, const Signatures& signatures);

// Model errors of all trials at a point. They still must be whitened: `take_model_error`.
std::vector<ModelError> model_errors(const Problem& problem, const Point& point);

// Stores the errors in the problem and whitens them with its noise model.
void take_model_error(Problem& problem, std::vector<ModelError> errors);

// Replaces the noise model and recomputes what depends on it.
void take_noise(Problem& problem, NoiseModel noise);

// Standard deviation of row `k` of trial `t` if nothing is missing (noise and model error), in the channel's
// unit.
double row_sd(const Problem& problem, std::size_t t, std::size_t k);

// Whitens residuals or derivatives of trial `t`, one per column, in place: first by the noise model, then by
// the trial's model error.
void whiten(const Problem& problem, std::size_t t, Eigen::Ref<Eigen::MatrixXd> values);

}  // namespace sandhopper::diagnose
