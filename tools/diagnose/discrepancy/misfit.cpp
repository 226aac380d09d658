#include "tools/diagnose/discrepancy/misfit.hpp"

// These limits were set by hand on campaigns of this project (tools/diagnose/README.md, "Open").
namespace sandhopper::diagnose {
namespace {

// A large residual also exceeds this fraction of the explained deviance.
constexpr double kMuchOfExplained = 0.1;
// Smallest residual per row that is compared with the explained deviance.
constexpr double kLittlePerRow = 0.05;
// A true effect with a law of another form leaves less than this fraction of the explained deviance. If more
// is left, the named effects are no explanation.
constexpr double kNoMatterOfForm = 0.3;

}  // namespace

Misfit misfit_of(const std::vector<TrialMisfit>& trials, double null_deviance, bool motion_is_prescribed) {
  Misfit m;
  double deviance = 0.0, rows = 0.0;
  for (const auto& trial : trials) {
    deviance += trial.deviance;
    rows += trial.rows;
  }
  m.unexplained = deviance - rows;
  m.explained = null_deviance - deviance;
  if (trials.size() < kTooFewTrials) return m;
  const std::size_t enough = motion_is_prescribed ? 2 : (trials.size() + 1) / 2;
  // Missing physics shows in many trials. A few trials with a large residual are failed simulations.
  const auto left = [&](double per_row) {
    std::size_t far = 0;
    for (const auto& trial : trials) far += trial.deviance > (1.0 + per_row) * trial.rows;
    return m.unexplained > per_row * rows && far >= enough;
  };
  m.large = left(kMuchPerRow) && m.unexplained > kMuchOfExplained * m.explained;
  m.outweighs = left(kLittlePerRow) && m.unexplained > kNoMatterOfForm * m.explained;
  m.noticeable = m.large || m.unexplained > kMuchPerRow * rows;
  return m;
}

}  // namespace sandhopper::diagnose
