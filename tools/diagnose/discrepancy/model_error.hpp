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

// How large model error is, standard deviations; see README.
struct ModelErrorScales {
  double numerical = 1.0;     // times the difference between honest simulations
  double port_knot_s = 0.02;  // distance in time of the knots of a force or torque (PlantModel::port_error)
  double repeatable = 0.01;   // the same in all trials, in scales of its port
  double typical = 0.015;     // of every effect on the list, in its typical size
  double reading = 0.06;      // the same of effects on readings and their times
};
inline constexpr ModelErrorScales kModelErrorScales{};

// Model error that is the same in all trials: laws of free form at the plant's ports, and a little of every
// effect on the list. Columns times their prior standard deviation; it is small, so that
// they are taken everywhere as they are at one point.
struct RepeatableError {
  std::vector<int> group;              // of each column: columns of a group share their scale
  std::vector<std::size_t> candidate;  // whose signature it is; kNoCandidate: of a port
  std::vector<Eigen::MatrixXd> white;  // of every trial, whitened

  static constexpr std::size_t kNoCandidate = static_cast<std::size_t>(-1);
  std::size_t size() const { return group.size(); }
};

// Model error of one trial, independent of that of the others:
//   D = [numerical variants, port forces u_{p,t}], each column times its prior standard deviation
// and, row by row, what two simulations differ by that no such column describes.
struct ModelError {
  Eigen::MatrixXd columns;  // D in the rows' units
  Eigen::VectorXd row_sd;   // in the rows' units
  Eigen::MatrixXd white;    // D whitened by the noise model
  LowRank low_rank;         // of `white`
};

// At the point of the signatures, whitened as the problem is now.
RepeatableError repeatable_error(const Problem& problem, const Signatures& signatures);

// At a point, for every trial, with the problem's noise model.
std::vector<ModelError> model_errors(const Problem& problem, const Point& point);

// The problem's from now on, with the noise model it has.
void take_model_error(Problem& problem, std::vector<ModelError> errors);

// The problem's noise model from now on; what rests on it is made anew.
void take_noise(Problem& problem, NoiseModel noise);

// Standard deviation of row `k` of trial `t` when nothing is missing: noise and model error.
double row_sd(const Problem& problem, std::size_t t, std::size_t k);

// Whitens residuals or derivatives of trial `t`, one a column, in place: by the noise model, then by the
// trial's model error.
void whiten(const Problem& problem, std::size_t t, Eigen::Ref<Eigen::MatrixXd> values);

}  // namespace sandhopper::diagnose
