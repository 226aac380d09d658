#include "tools/diagnose/evidence/form_error_evidence.hpp"

#include <algorithm>

#include "tools/diagnose/evidence/form_error.hpp"
#include "tools/diagnose/evidence/log_evidence.hpp"
#include "tools/diagnose/evidence/screen.hpp"
#include "tools/diagnose/evidence/search_parts.hpp"
#include "tools/diagnose/fit/fit.hpp"
#include "tools/diagnose/recordings/data_faults.hpp"

namespace sandhopper::diagnose {
namespace {

// The fit of one effect with the least deviance, from several sizes and all choices of its shapes.
Fit fitted_alone(const Problem& problem, const Point& null, const std::string& effect,
                 const std::function<void(double)>& progress) {
  Fit best;
  for (std::size_t c = 0; c < problem.candidates.size(); ++c) {
    const Candidate& candidate = problem.candidates[c];
    if (candidate.effect->id != effect) continue;
    const auto& size = candidate.parameters[0];
    for (auto values : shape_choices(candidate))
      for (const double start : kCommonSizes) {
        progress(0.5);
        if (start < 0.0 && !size.either_sign) continue;
        values[0] = std::clamp(start * size.typical, size.low, size.high);
        Point point = null;
        point.hypothesis = {{c}, {values}};
        Fit fit = fit_from(problem, point);
        if (fit.status != FitStatus::failed &&
            (best.status == FitStatus::failed || fit.deviance < best.deviance))
          best = std::move(fit);
      }
  }
  return best;
}

}  // namespace

std::vector<double> form_error_evidence(const Recordings& recordings, const std::string& effect,
                                        std::span<const double> shares,
                                        const std::function<void(double)>& progress) {
  progress(0.0);
  Recordings clean = recordings;
  remove_data_faults(clean.trials);
  Prepared prepared = prepare(clean);
  Problem& problem = prepared.problem;
  if (problem.trials.empty()) return {};
  Point null = fit_from(problem, null_point(problem)).point;
  keep_columns(problem, null);
  Fit fit = fitted_alone(problem, null, effect, progress);
  if (fit.status == FitStatus::failed) return {};
  update_noise(problem, fit.point);
  keep_columns(problem, fit.point);
  fit = fit_from(problem, fit.point);
  if (fit.status == FitStatus::failed || laws_of(problem, fit.point.hypothesis).empty()) return {};
  progress(0.9);
  std::vector<double> evidence;
  for (const auto& one : log_evidence_by_form(problem, fit, linearised_at(problem, fit.point, {}, shares)))
    evidence.push_back(one.value);
  return evidence;
}

}  // namespace sandhopper::diagnose
