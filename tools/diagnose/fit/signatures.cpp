#include "tools/diagnose/fit/signatures.hpp"

#include "tools/diagnose/evidence/screen.hpp"
#include "tools/diagnose/fit/linearise.hpp"
#include "tools/experiment/parallel.hpp"

namespace sandhopper::diagnose {
namespace {

using Eigen::Index, Eigen::MatrixXd, Eigen::VectorXd;

}  // namespace

Signatures signatures_at(const Problem& problem, const Point& point, const SignatureOptions& options) {
  const Edits base = edits_for(problem, point.hypothesis, point.tolerances);
  Signatures out;
  std::vector<Direction> moved;
  for (std::size_t c = 0; c < problem.candidates.size(); ++c) {
    if (point.hypothesis.contains(c) || (options.sizes && !options.sizes->contains(c))) continue;
    const Candidate& candidate = problem.candidates[c];
    for (const auto& choice : shape_choices(candidate)) {
      Signatures::Alternative alternative{c, choice, {}, {}, static_cast<Index>(moved.size())};
      for (std::size_t i = 0; i < candidate.parameters.size(); ++i) {
        if (!is_amplitude(candidate.parameters, i)) continue;
        Hypothesis with = point.hypothesis;
        const bool secant = options.sizes != nullptr && alternative.amplitudes.empty();
        const double step = secant ? options.sizes->at(c) : signature_step(candidate, choice, i);
        with.candidates.push_back(c);
        with.values.push_back(choice);
        const auto moved_by = [&](double by) {
          with.values.back()[i] = by * candidate.parameters[i].typical;
          return edits_for(problem, with, point.tolerances);
        };
        alternative.amplitudes.push_back(i);
        alternative.steps.push_back(step);
        moved.push_back({moved_by(step), step});
        if (secant) continue;
        if (choice[i] == 0.0 && candidate.parameters[i].central_step > 0.0)
          moved.back().opposite = moved_by(-step);
        if (i == 0) {
          moved.back().like = candidate.label();
          moved.back().like_step = candidate.parameters[i].typical;
        }
      }
      out.alternatives.push_back(std::move(alternative));
    }
  }
  if (options.laws)
    for (auto& family : free_families(problem, point)) {
      const auto first = static_cast<Index>(moved.size());
      for (const auto& term : family.terms) moved.push_back({with_term(base, term, kTermStep), kTermStep});
      out.laws.push_back({std::move(family), first});
    }
  const auto& known = options.columns != nullptr ? *options.columns : problem.kept_columns;
  out.columns.resize(problem.trials.size());
  parallel_for(problem.trials.size(), [&](std::size_t t) {
    const TrialModel& trial = *problem.trials[t];
    const VectorXd centre = predicted(problem, trial, base, point.nuisances[t]);
    MatrixXd& columns = out.columns[t];
    columns.resize(centre.size(), static_cast<Index>(moved.size()));
    const auto simulate = [&](const Edits& edits) {
      return predicted(problem, trial, edits, point.nuisances[t]);
    };
    for (std::size_t i = 0; i < moved.size(); ++i) {
      const auto alike = known.empty() ? std::nullopt : derivative_of_alike(problem, t, moved[i], known[t]);
      columns.col(static_cast<Index>(i)) = alike ? *alike : derivative(moved[i], centre, simulate);
    }
  });
  return out;
}

}  // namespace sandhopper::diagnose
