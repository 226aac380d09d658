#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>

#include "tools/diagnose/report_parts.hpp"

namespace sandhopper::diagnose {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

struct Squares {
  std::vector<double> sum, count;
  explicit Squares(std::size_t channels) : sum(channels, 0.0), count(channels, 0.0) {}
  double rms(std::size_t c) const { return count[c] > 0.0 ? std::sqrt(sum[c] / count[c]) : 0.0; }
  void add(const Problem& problem, std::size_t trial, const VectorXd& residual) {
    const auto& rows = problem.trials[trial]->rows;
    for (std::size_t k = 0; k < rows.size(); ++k) {
      if (!problem.used[trial][k]) continue;
      sum[rows[k].channel] += std::pow(residual[static_cast<Index>(k)], 2);
      ++count[rows[k].channel];
    }
  }
};

}  // namespace

// Held out: the effects' parameters come from the other trials, the trial's own nuisances are fitted.
void report_errors(const Problem& problem, const Search& search, Diagnosis& diagnosis) {
  const std::size_t channels = problem.channels.size();
  Squares before(channels), after(channels), held_out(channels);
  const auto null_linear = linearise_all(problem, search.null().fit.point, {}, {.keep_plain = true});
  for (std::size_t t = 0; t < null_linear.size(); ++t) before.add(problem, t, null_linear[t].plain.col(0));

  const Point& point = search.best().fit.point;
  const auto directions = parameter_directions(problem, point);
  const auto k = static_cast<Index>(directions.size());
  const auto linear = linearise_all(problem, point, directions, {.keep_plain = true});
  MatrixXd information = MatrixXd::Identity(k, k) * 0.01;
  VectorXd score = VectorXd::Zero(k);
  for (const auto& trial : linear) {
    information += trial.gram.bottomRightCorner(k, k);
    score += trial.gram.col(0).tail(k);
  }
  for (std::size_t t = 0; t < linear.size(); ++t) {
    after.add(problem, t, linear[t].plain.col(0));
    VectorXd e = linear[t].plain.col(0);
    if (k > 0 && linear.size() > 1) {
      const MatrixXd others = information - linear[t].gram.bottomRightCorner(k, k);
      const VectorXd change = others.ldlt().solve(score - linear[t].gram.col(0).tail(k));
      e -= linear[t].plain.rightCols(k) * change;
    }
    held_out.add(problem, t, e);
  }
  for (std::size_t c = 0; c < channels; ++c) {
    if (before.count[c] == 0.0) continue;
    ChannelFit fit;
    fit.channel = problem.channels[c];
    fit.train = {before.rms(c), after.rms(c)};
    fit.heldout = {before.rms(c), held_out.rms(c)};
    fit.floor = problem.noise.channel(c).sd();
    diagnosis.noise_floor[fit.channel] = fit.floor;
    diagnosis.fits.push_back(fit);
  }
  std::sort(diagnosis.fits.begin(), diagnosis.fits.end(), [](const ChannelFit& a, const ChannelFit& b) {
    return a.heldout.before / std::max(a.floor, 1e-300) > b.heldout.before / std::max(b.floor, 1e-300);
  });
}

}  // namespace sandhopper::diagnose
