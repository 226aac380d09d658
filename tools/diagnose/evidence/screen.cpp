#include "tools/diagnose/evidence/screen.hpp"

#include <Eigen/Cholesky>
#include <Eigen/LU>
#include <algorithm>
#include <cmath>

#include "tools/diagnose/fit/fit.hpp"

namespace sandhopper::diagnose {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

std::vector<std::vector<double>> shape_choices(const Candidate& candidate) {
  std::vector<double> typical;
  typical.reserve(candidate.parameters.size());
  for (std::size_t i = 0; i < candidate.parameters.size(); ++i)
    typical.push_back(is_amplitude(candidate.parameters, i) ? 0.0 : candidate.parameters[i].typical);
  std::vector<std::vector<double>> choices{typical};
  for (std::size_t i = 0; i < candidate.parameters.size(); ++i)
    for (const double shape : candidate.parameters[i].shapes) {
      choices.push_back(typical);
      choices.back()[i] = shape;
    }
  return choices;
}

double signature_step(const Candidate& candidate, const std::vector<double>& choice, std::size_t amplitude) {
  const auto& p = candidate.parameters[amplitude];
  if (choice[amplitude] == 0.0 && p.central_step > 0.0) return p.central_step / p.typical;
  return choice[amplitude] != 0.0 ? choice[amplitude] / p.typical
                                  : std::min(candidate.probe(), p.high / p.typical);
}

std::vector<MatrixXd> eliminated(const std::vector<TrialLinear>& trials, Index first, Index count,
                                 const VectorXd& prior_information) {
  std::vector<MatrixXd> grams;
  grams.reserve(trials.size());
  for (const auto& trial : trials) grams.push_back(trial.gram);
  if (count == 0) return grams;
  const Index width = grams.front().cols();
  MatrixXd pooled = MatrixXd::Zero(width, width);
  for (const auto& gram : grams) pooled += gram;
  MatrixXd block = pooled.block(first, first, count, count);
  block.diagonal() += prior_information;
  const MatrixXd regression = block.ldlt().solve(pooled.middleRows(first, count));
  MatrixXd transform = MatrixXd::Identity(width, width);
  for (Index j = 0; j < width; ++j)
    if (j < first || j >= first + count) transform.block(first, j, count, 1) = -regression.col(j);
  for (auto& gram : grams) gram = transform.transpose() * gram * transform;
  return grams;
}

Pooled pooled(const std::vector<MatrixXd>& grams, const std::vector<Index>& columns) {
  const auto k = static_cast<Index>(columns.size());
  Pooled out{MatrixXd::Zero(k, k), VectorXd::Zero(k)};
  for (const auto& gram : grams) {
    out.information += gram(columns, columns);
    out.score += gram(columns, 0);
  }
  return out;
}

GroupGain group_gain(const std::vector<MatrixXd>& grams, const std::vector<Index>& columns,
                     double prior_information) {
  const auto k = static_cast<Index>(columns.size());
  auto [information, score] = pooled(grams, columns);
  information.diagonal().array() += prior_information;
  GroupGain out;
  out.size = information.ldlt().solve(score);
  out.gain = std::max(0.0, score.dot(out.size));
  const double length = out.size.norm();
  const VectorXd direction = length > 0.0 ? VectorXd(out.size / length) : VectorXd(VectorXd::Unit(k, 0));
  for (const auto& gram : grams) {
    double u = 0.0, info = 0.0;
    for (Index i = 0; i < k; ++i) {
      u += direction[i] * gram(columns[static_cast<std::size_t>(i)], 0);
      for (Index j = 0; j < k; ++j)
        info += direction[i] * direction[j] *
                gram(columns[static_cast<std::size_t>(i)], columns[static_cast<std::size_t>(j)]);
    }
    out.evidence.score.push_back(u);
    out.evidence.information.push_back(std::max(info, 0.0));
  }
  return out;
}

HeldOut held_out_gain(const std::vector<MatrixXd>& grams, const std::vector<Index>& columns,
                      const MatrixXd& prior_information) {
  const auto k = static_cast<Index>(columns.size());
  const auto pick = [&](const MatrixXd& gram, MatrixXd& h, VectorXd& u) {
    for (Index i = 0; i < k; ++i) {
      u[i] = gram(columns[static_cast<std::size_t>(i)], 0);
      for (Index j = 0; j < k; ++j)
        h(i, j) = gram(columns[static_cast<std::size_t>(i)], columns[static_cast<std::size_t>(j)]);
    }
  };
  const VectorXd believed = prior_information.inverse().diagonal();
  MatrixXd all = prior_information, h(k, k);
  VectorXd score = VectorXd::Zero(k), u(k);
  for (const auto& gram : grams) {
    pick(gram, h, u);
    all += h;
    score += u;
  }
  HeldOut out;
  for (const auto& gram : grams) {
    pick(gram, h, u);
    const MatrixXd covariance = (all - h).ldlt().solve(MatrixXd::Identity(k, k));
    VectorXd size = covariance * (score - u);
    for (Index i = 0; i < k; ++i) size[i] *= std::max(0.0, 1.0 - covariance(i, i) / believed[i]);
    out.of_trial.push_back(2.0 * size.dot(u) - size.dot(h * size));
    out.gain += out.of_trial.back();
  }
  return out;
}

std::vector<Screened> screen(const Problem& problem, const Point& point,
                             const std::vector<KeptColumns>* columns, const Signatures& signatures) {
  const auto directions = parameter_directions(problem, point);
  const auto own = static_cast<Index>(directions.size());
  const auto linear =
      linearise_all(problem, point, directions, {.more = &signatures.columns, .columns = columns});
  const auto grams = eliminated(linear, 1, own, prior_information(problem, point));

  std::vector<Screened> found;
  for (const auto& alternative : signatures.alternatives) {
    std::vector<Index> group_columns;
    for (std::size_t i = 0; i < alternative.amplitudes.size(); ++i)
      group_columns.push_back(own + 1 + alternative.first + static_cast<Index>(i));
    auto group = group_gain(grams, group_columns, kPriorOfAmplitude);
    const auto& parameters = problem.candidates[alternative.candidate].parameters;
    Screened s{alternative.candidate, alternative.values, group.gain, group.evidence, group.size[0]};
    for (std::size_t i = 0; i < alternative.amplitudes.size(); ++i) {
      const auto& p = parameters[alternative.amplitudes[i]];
      double& value = s.values[alternative.amplitudes[i]];
      const double wanted = group.size[static_cast<Index>(i)] * p.typical;
      value = std::clamp(wanted, p.low, p.high);
      if (group_columns.size() == 1 && value != wanted) {
        // The size is clamped to its bound: compute the gain of the clamped size.
        double score = 0.0, information = 0.0;
        for (const auto& gram : grams) {
          score += gram(group_columns[0], 0);
          information += gram(group_columns[0], group_columns[0]);
        }
        const double b = value / p.typical;
        s.gain = std::max(0.0, 2.0 * b * score - b * b * information);
        s.typicals = b;
      }
    }
    const auto same = std::find_if(found.begin(), found.end(),
                                   [&](const Screened& f) { return f.candidate == s.candidate; });
    if (same == found.end())
      found.push_back(std::move(s));
    else if (s.gain > same->gain)
      *same = std::move(s);
  }
  std::sort(found.begin(), found.end(), [](const Screened& a, const Screened& b) { return a.gain > b.gain; });
  return found;
}

}  // namespace sandhopper::diagnose
