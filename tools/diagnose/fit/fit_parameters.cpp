#include <Eigen/Core>
#include <algorithm>
#include <cmath>

#include "tools/diagnose/discrepancy/free_laws.hpp"
#include "tools/diagnose/fit/fit.hpp"

// The free parameters of a point and their priors.
namespace sandhopper::diagnose {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

constexpr double kDerivativeStep = 0.02;  // in typical sizes of the parameter
constexpr double kLawStep = 0.01;         // in scales of the free law's port

Eigen::Map<const VectorXd> law_sizes(const Hypothesis& hypothesis) {
  return {hypothesis.law_sizes.data(), static_cast<Index>(hypothesis.law_sizes.size())};
}

}  // namespace

bool move_parameters(const Problem& problem, Point& point, const VectorXd& step) {
  bool bounded = false;
  Index at = 0;
  for (std::size_t i = 0; i < point.hypothesis.candidates.size(); ++i) {
    const auto& parameters = problem.candidates[point.hypothesis.candidates[i]].parameters;
    for (std::size_t j = 0; j < parameters.size(); ++j, ++at) {
      double& value = point.hypothesis.values[i][j];
      const double wanted = value + step[at] * parameters[j].typical;
      value = std::clamp(wanted, parameters[j].low, parameters[j].high);
      bounded = bounded || (value != wanted && j == 0);
    }
  }
  for (double& size : point.hypothesis.law_sizes) size += step[at++];
  for (double& value : point.tolerances)
    value = std::clamp(value + step[at++], -kMostTolerance, kMostTolerance);
  return bounded;
}

double prior_deviance(const Problem& problem, const Point& point) {
  double sum = 0.0;
  if (const auto sizes = law_sizes(point.hypothesis); sizes.size() > 0)
    sum += sizes.dot(free_law_information(point.hypothesis.law.size()) * sizes);
  for (std::size_t i = 0; i < point.hypothesis.candidates.size(); ++i) {
    const auto& parameters = problem.candidates[point.hypothesis.candidates[i]].parameters;
    for (std::size_t j = 0; j < parameters.size(); ++j) {
      // A shape gets a narrow prior around its typical value, because the data may not determine it. An
      // amplitude gets a wide prior around 0.
      const bool amplitude = is_amplitude(parameters, j);
      const double centre = amplitude ? 0.0 : parameters[j].typical;
      const double sd = amplitude ? kPriorTypicals * parameters[j].typical : parameters[j].typical;
      sum += std::pow((point.hypothesis.values[i][j] - centre) / sd, 2);
    }
  }
  for (const double value : point.tolerances) sum += value * value;
  return sum;
}

void add_priors(const Problem& problem, const Point& point, MatrixXd& information, VectorXd& score) {
  Index at = 0;
  for (std::size_t i = 0; i < point.hypothesis.candidates.size(); ++i) {
    const auto& parameters = problem.candidates[point.hypothesis.candidates[i]].parameters;
    for (std::size_t j = 0; j < parameters.size(); ++j, ++at) {
      const bool amplitude = is_amplitude(parameters, j);
      const double centre = amplitude ? 0.0 : parameters[j].typical;
      const double weight = amplitude ? kPriorOfAmplitude : 1.0;
      information(at, at) += weight;
      score[at] -= weight * (point.hypothesis.values[i][j] - centre) / parameters[j].typical;
    }
  }
  if (const auto sizes = law_sizes(point.hypothesis); sizes.size() > 0) {
    const MatrixXd of_law = free_law_information(point.hypothesis.law.size());
    information.block(at, at, sizes.size(), sizes.size()) += of_law;
    score.segment(at, sizes.size()) -= of_law * sizes;
    at += sizes.size();
  }
  for (const double value : point.tolerances) {
    information(at, at) += 1.0;
    score[at++] -= value;
  }
}

std::vector<Direction> parameter_directions(const Problem& problem, const Point& point) {
  std::vector<Direction> directions;
  for (std::size_t i = 0; i < point.hypothesis.candidates.size(); ++i) {
    const auto& parameters = problem.candidates[point.hypothesis.candidates[i]].parameters;
    for (std::size_t j = 0; j < parameters.size(); ++j) {
      const auto moved_by = [&](double step) {
        Hypothesis moved = point.hypothesis;
        moved.values[i][j] += step * parameters[j].typical;
        return edits_for(problem, moved, point.tolerances);
      };
      if (const double step = parameters[j].central_step / parameters[j].typical; step > 0.0) {
        directions.push_back({moved_by(step), step, -1, moved_by(-step)});
        continue;
      }
      double step = kDerivativeStep;
      if (point.hypothesis.values[i][j] + step * parameters[j].typical > parameters[j].high) step = -step;
      directions.push_back({moved_by(step), step});
      if (j == 0) {
        directions.back().like = problem.candidates[point.hypothesis.candidates[i]].label();
        directions.back().like_step = parameters[j].typical;
      }
    }
  }
  for (std::size_t k = 0; k < point.hypothesis.law.size(); ++k) {
    Hypothesis moved = point.hypothesis;
    moved.law_sizes[k] += kLawStep;
    directions.push_back({edits_for(problem, moved, point.tolerances), kLawStep});
  }
  for (std::size_t i = 0; i < point.tolerances.size(); ++i) {
    if (!problem.tolerances[i].is_stated) {
      directions.push_back({{}, 1.0, static_cast<int>(i)});
      continue;
    }
    std::vector<double> moved(point.tolerances.begin(), point.tolerances.end());
    moved[i] += kDerivativeStep;
    directions.push_back({edits_for(problem, point.hypothesis, moved), kDerivativeStep});
  }
  return directions;
}

VectorXd prior_information(const Problem& problem, const Point& point) {
  constexpr double kHeld = 1e12;  // prior information that fixes a tolerance at its bound
  const auto own = static_cast<Index>(point.hypothesis.parameters());
  const auto tolerances = static_cast<Index>(problem.tolerances.size());
  VectorXd prior = VectorXd::Constant(own + tolerances, kPriorOfAmplitude);
  for (Index i = 0; i < tolerances; ++i)
    prior[own + i] = std::abs(point.tolerances[static_cast<std::size_t>(i)]) < kMostTolerance ? 1.0 : kHeld;
  return prior;
}

}  // namespace sandhopper::diagnose
