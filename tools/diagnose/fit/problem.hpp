#pragma once
#include <algorithm>
#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "tools/diagnose/discrepancy/model_error.hpp"
#include "tools/diagnose/fit/noise_model.hpp"
#include "tools/diagnose/model/effect.hpp"
#include "tools/diagnose/model/plant.hpp"

namespace sandhopper::diagnose {

// A number that belongs to no effect but is not known exactly: a channel's sampling instant within one
// sample, or a number that the belief leaves open. All trials share it. It is always fitted, with the prior
// value / scale ~ N(0, 1).
struct Tolerance {
  std::string name;
  double scale = 1.0;        // s, a share (with window_s), or the unit of the key
  std::string channel;       // channel that is late or averaged; empty: `belief_key` counts
  double of_sampling = 1.0;  // part of `scale` that comes from unknown sampling instants, s
  std::string belief_key{};
  // > 0: the channel may record the mean over this window; the tolerance is that share
  double window_s = 0.0;
  bool is_relative = false;  // the tolerance is a share of the number under `belief_key`
  // Stated by [known_to]. It may be large, so its derivative is taken anew at each point.
  bool is_stated = false;

  // Adds the tolerance to `edits`; `in_scales` is value / scale.
  void put(Edits& edits, double in_scales) const;
};
// Clamp tolerances to +-3 standard deviations. A larger offset must be explained by an effect; otherwise one
// shared tolerance would hide a real delay at the price of one prior term.
inline constexpr double kMostTolerance = 3.0;

// Derivatives of one trial by tolerances and nuisances at one point. They hardly change with the effects, so
// nearby fits share them; a fit that gains too little recomputes them.
struct KeptColumns {
  Eigen::MatrixXd shared;  // columns: tolerances, then trial nuisances; not whitened
  // Columns: block nuisances, shared by all blocks, because each row belongs to one block.
  Eigen::MatrixXd block;
  Eigen::MatrixXd white_shared;  // whitened
  Eigen::MatrixXd white_block;
  Eigen::MatrixXd gram;                          // white_shared' white_shared
  std::vector<Eigen::MatrixXd> block_gram;       // per block: white_block' white_block over its rows
  std::vector<Eigen::MatrixXd> block_by_shared;  // per block: white_block' white_shared over its rows
};

// A campaign prepared for a fit: trial models, candidates, tolerances and noise.
struct Problem {
  std::unique_ptr<PlantModel> plant;
  Context context;
  std::vector<std::unique_ptr<TrialModel>> trials;
  std::vector<std::vector<std::uint8_t>> used;  // [trial][row], 1: the row counts; 0: it is an outlier
  std::vector<std::string> channels;
  std::vector<std::string> phases;
  std::vector<Effect> effects;
  std::vector<Candidate> candidates;
  Edits in_place;  // effects that the belief contains already
  std::vector<Tolerance> tolerances;
  double row_s = 0.0;       // median time between rows
  double port_error = 0.0;  // PlantModel::port_error
  // Per channel: least standard deviation of the noise, from the recordings' fast fluctuation.
  std::vector<double> floor_sd;
  NoiseModel noise;
  std::vector<ModelError> model_error;    // per trial; empty: not computed yet
  RepeatableError repeatable_error;       // empty: not computed yet
  mutable std::uint64_t simulations = 0;  // number of simulated trials so far
  std::vector<KeptColumns> kept_columns;  // per trial; empty: linearise() computes them each time

  std::vector<const TrialModel*> trial_pointers() const {
    std::vector<const TrialModel*> pointers;
    for (const auto& trial : trials) pointers.push_back(trial.get());
    return pointers;
  }
  double rows() const {
    double sum = 0.0;
    for (const auto& trial : trials) sum += static_cast<double>(trial->rows.size());
    return sum;
  }
};

// Limits an explained deviance to 10 per row. Above that, an error in the form of an explaining law would
// show in the residual, so the unnoticed error of the form does not grow any further.
inline constexpr double kFormUnnoticedPerRow = 10.0;
inline double with_form_unnoticed(const Problem& problem, double explained) {
  return std::clamp(explained, 0.0, kFormUnnoticedPerRow * problem.rows());
}

// One term of a law of free form at a port. It is one column of a fit: amplitude times `law`.
struct FreeTerm {
  std::string port;
  bool sensor = false;
  Law law;
  double scale = 1.0;
};

// A set of effects (indices of candidates) with the values of their parameters, and optionally one law of
// free form: a sum of terms times their sizes (in scales of the port).
struct Hypothesis {
  std::vector<std::size_t> candidates;
  std::vector<std::vector<double>> values;
  std::vector<FreeTerm> law{};
  std::vector<double> law_sizes{};

  std::size_t parameters() const {  // number of the effects' parameters
    std::size_t n = 0;
    for (const auto& v : values) n += v.size();
    return n;
  }
  bool contains(std::size_t candidate) const {
    for (const auto c : candidates)
      if (c == candidate) return true;
    return false;
  }
};

// A point of a fit: effects, tolerances (in their scales), nuisances of every trial.
struct Point {
  Hypothesis hypothesis;
  std::vector<double> tolerances;
  std::vector<std::vector<double>> nuisances;
};

// The point without effects, with all tolerances and nuisances 0.
Point null_point(const Problem& problem);

// Adds the effects of the belief to every simulation. Returns the names of those that are no candidates.
std::vector<std::string> put_in_place(Problem& problem);

// All changes that `in_place`, a hypothesis and the tolerances make to a simulation.
Edits edits_for(const Problem& problem, const Hypothesis& hypothesis, std::span<const double> tolerances);

}  // namespace sandhopper::diagnose
