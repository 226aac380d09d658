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

// A number that belongs to no effect but cannot be believed exactly: a fraction of a sample in a channel's
// time, or what a belief leaves open. Always fitted, with a narrow prior of unit variance on value / scale.
struct Tolerance {
  std::string name;
  double scale = 1.0;        // s, or the key's unit
  std::string channel;       // which is late; empty: of a key
  double of_sampling = 1.0;  // as much of it as instants of sampling leave unsure, s
  std::string belief_key{};
  double window_s = 0.0;  // of a channel that may record the mean over it: the tolerance is that share

  void put(Edits& edits, double in_scales) const;
};
// In its scales. What is further off is no tolerance any more: only an effect may explain it, or a fault of
// thirty scales would be paid for once and leave no trial in disagreement. What is less is no effect.
inline constexpr double kMostTolerance = 3.0;

// Derivatives of one trial by tolerances and nuisances at one point. They hardly change with the effects, so
// that fits nearby share them; a fit that gets stuck makes its own.
struct KeptColumns {
  Eigen::MatrixXd shared;        // tolerances, then whole-trial nuisances, as they are
  Eigen::MatrixXd block;         // nuisances of blocks, packed: each row belongs to one block
  Eigen::MatrixXd white_shared;  // whitened
  Eigen::MatrixXd white_block;
  Eigen::MatrixXd gram;                     // of white_shared
  std::vector<Eigen::MatrixXd> block_gram;  // per block, of its rows of white_block
  std::vector<Eigen::MatrixXd> block_by_shared;
};

// Everything a campaign is, ready to be fitted.
struct Problem {
  std::unique_ptr<PlantModel> plant;
  Context context;
  std::vector<std::unique_ptr<TrialModel>> trials;
  std::vector<std::vector<std::uint8_t>> used;  // rows that count; others are outliers or faults
  std::vector<std::string> channels;
  std::vector<std::string> phases;
  std::vector<Effect> effects;
  std::vector<Candidate> candidates;
  Edits in_place;  // effects that the belief holds already
  std::vector<Tolerance> tolerances;
  double row_s = 0.0;            // middling time between rows
  std::vector<double> floor_sd;  // per channel, from the recordings' own fast fluctuation
  NoiseModel noise;
  std::vector<ModelError> model_error;  // of every trial; empty: none yet
  RepeatableError repeatable_error;     // empty: not asked for yet
  mutable std::uint64_t simulations = 0;
  std::vector<KeptColumns> kept_columns;  // one per trial; empty: made anew each time

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

// Of a deviance that is explained, as much as a law of another form may leave unnoticed a part of: a form
// that is off by more shows in what is left.
inline constexpr double kFormUnnoticedPerRow = 10.0;
inline double with_form_unnoticed(const Problem& problem, double explained) {
  return std::clamp(explained, 0.0, kFormUnnoticedPerRow * problem.rows());
}

// A law of free form at a port, as one column of a fit: amplitude times `law`.
struct FreeTerm {
  std::string port;
  bool sensor = false;
  Law law;
  double scale = 1.0;
};

// A set of effects with the values of their parameters, one after another in each effect; beside them perhaps
// one law of free form, a sum of terms times their sizes (in scales of the port).
struct Hypothesis {
  std::vector<std::size_t> candidates;
  std::vector<std::vector<double>> values;
  std::vector<FreeTerm> law{};
  std::vector<double> law_sizes{};

  std::size_t parameters() const {  // of the effects
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

// Where a fit stands: effects, tolerances (in their scales), nuisances of every trial.
struct Point {
  Hypothesis hypothesis;
  std::vector<double> tolerances;
  std::vector<std::vector<double>> nuisances;
};

Point null_point(const Problem& problem);

// Makes the belief's own effects part of every simulation; returns the names that no candidate has.
std::vector<std::string> put_in_place(Problem& problem);

Edits edits_for(const Problem& problem, const Hypothesis& hypothesis, std::span<const double> tolerances);

}  // namespace sandhopper::diagnose
