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
  std::vector<Edits> moved;
  std::vector<double> steps;
  for (std::size_t c = 0; c < problem.candidates.size(); ++c) {
    if (point.hypothesis.contains(c) || (options.sizes && !options.sizes->contains(c))) continue;
    const Candidate& candidate = problem.candidates[c];
    for (const auto& choice : shape_choices(candidate)) {
      Signatures::Alternative alternative{c, choice, {}, {}, static_cast<Index>(moved.size())};
      for (std::size_t i = 0; i < candidate.parameters.size(); ++i) {
        if (!is_amplitude(candidate.parameters, i)) continue;
        Hypothesis with = point.hypothesis;
        auto values = choice;
        const bool secant = options.sizes != nullptr && alternative.amplitudes.empty();
        const double step = secant ? options.sizes->at(c) : signature_step(candidate, choice, i);
        values[i] = step * candidate.parameters[i].typical;
        with.candidates.push_back(c);
        with.values.push_back(values);
        alternative.amplitudes.push_back(i);
        alternative.steps.push_back(step);
        moved.push_back(edits_for(problem, with, point.tolerances));
        steps.push_back(step);
      }
      out.alternatives.push_back(std::move(alternative));
    }
  }
  if (options.laws)
    for (auto& family : free_families(problem, point)) {
      const auto first = static_cast<Index>(moved.size());
      for (const auto& term : family.terms) {
        moved.push_back(with_term(base, term, kTermStep));
        steps.push_back(kTermStep);
      }
      out.laws.push_back({std::move(family), first});
    }
  out.columns.resize(problem.trials.size());
  parallel_for(problem.trials.size(), [&](std::size_t t) {
    const TrialModel& trial = *problem.trials[t];
    const VectorXd centre = predicted(problem, trial, base, point.nuisances[t]);
    MatrixXd& columns = out.columns[t];
    columns.resize(centre.size(), static_cast<Index>(moved.size()));
    for (std::size_t i = 0; i < moved.size(); ++i)
      columns.col(static_cast<Index>(i)) =
          (predicted(problem, trial, moved[i], point.nuisances[t]) - centre) / steps[i];
  });
  return out;
}

}  // namespace sandhopper::diagnose
