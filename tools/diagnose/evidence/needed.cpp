#include "tools/diagnose/evidence/needed.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

#include "tools/diagnose/discrepancy/misfit.hpp"
#include "tools/diagnose/evidence/search_parts.hpp"
#include "tools/diagnose/fit/levels.hpp"
#include "tools/diagnose/fit/statistics.hpp"

// Limits below without another source were set by hand on campaigns of this project
// (tools/diagnose/README.md, "Open").
namespace sandhopper::diagnose {
namespace {

// Smallest (effective) number T of trials for a sign-flip test of one of n hypotheses: its least p-value,
// n 2^(1 - T), is below kLevel.
double trials_to_flip(std::size_t hypotheses) {
  return 1.0 + std::ceil(std::log2(static_cast<double>(hypotheses) / kLevel));
}
// The fit without the effect must be worse by this fraction of the linear gain, or worse in most trials. If
// the simulation is chaotic, the derivative is huge but the real difference is near zero.
constexpr double kComesTrue = 0.05;
// If the real drop exceeds this fraction of the linear gain, sign flips at the fit itself count, too.
constexpr double kMostlyTrue = 0.3;
// An effect beside a stronger one needs p < kTwofold in campaigns of at least so many trials and for plants
// with at least this form error. There the p-values of real effects are orders of magnitude smaller; effects
// that only correct the form of the other law at some of its states have larger ones.
constexpr std::size_t kTrialsToDoubt = 10;
constexpr double kFormInDoubt = 0.01;
// An effect with a gain above this fraction of the explained deviance may be so large that the simulation is
// not linear in it. Then sign flips, which are linear, are not required.
constexpr double kFarShare = 0.02;
// p-value above which a set is not worth a better fit.
constexpr double kHopeless = 0.2;
// Largest |z| of a nuisance's mean over the trials without an absorbed effect; at most 2.9 with nothing
// missing.
constexpr double kAbsorbedLean = 4.0;
// An effect explains the common nuisance offset if |z| falls below this fraction.
constexpr double kRemoved = 0.6;

// Largest p-value by Student's t with which an effect is needed. A priori it is more probable that something
// is missing than that one more effect is missing, so an effect alone may have a larger one.
double significance_needed(const BesideEvidence& beside, bool enough) {
  const bool in_doubt =
      !beside.is_strongest && beside.trials >= kTrialsToDoubt && beside.form_error >= kFormInDoubt;
  if (in_doubt) return kTwofold;
  return enough && beside.effects == 1 ? kLevel : kSignificance;
}

// True if sign flips need not confirm the p-value. They are evaluated without the effect, where the
// simulation may not be linear in a large effect; only flips at the fit are left then, and those count all
// candidates. They also have little power if a few trials carry nearly all information.
bool needs_no_flips(const EffectEvidence& evidence, const BesideEvidence& beside) {
  const bool far = evidence.gain > kFarShare * beside.explained;
  const bool flips_can_tell =
      evidence.evidence.effective_trials() >= trials_to_flip(far ? beside.candidates : 1);
  return (far || !flips_can_tell || beside.removes_offset) &&
         evidence.p_value < (flips_can_tell ? kBeyondDoubt : kTwofold) &&
         (beside.removes_offset || is_mostly_true(beside.drop, evidence.gain));
}

}  // namespace

bool comes_true(const Fit& without, const Fit& with, double linear_gain) {
  if (without.deviance - with.deviance > kComesTrue * linear_gain) return true;
  std::vector<double> drops;
  for (std::size_t t = 0; t < with.trial_deviance.size(); ++t)
    drops.push_back(without.trial_deviance[t] - with.trial_deviance[t]);
  return signed_rank_p_value(drops) < kLevel;
}

bool is_mostly_true(double drop, double linear_gain) { return drop > kMostlyTrue * linear_gain; }

bool have_absorbed(double deviance, double rows, double z) {
  return deviance > (1.0 + kMuchPerRow) * rows || std::abs(z) > kAbsorbedLean;
}

bool removes_offset(double z_without, double z_with) {
  return std::abs(z_without) > kAbsorbedLean && std::abs(z_with) < kRemoved * std::abs(z_without);
}

Need need_of(EffectEvidence& evidence, const BesideEvidence& beside) {
  const bool enough = static_cast<double>(beside.trials) >= trials_to_flip(1);
  const double flip_needed = enough && !needs_no_flips(evidence, beside) ? kLevel : 1.0;
  const double smallest = evidence.gain > kUnmistakablePerRow * beside.rows ? 0.0 : kSmallestOfTypical;
  evidence.weak = !(evidence.p_value < kSignificance);
  evidence.too_small = evidence.typicals < smallest;
  // If the effect removes an offset that a nuisance had in all trials, that offset is the evidence, not the
  // deviance.
  evidence.unnoticed =
      !beside.removes_offset && std::min(evidence.gain, beside.drop) < beside.between_programs;
  Need need;
  need.is_sound = evidence.p_value < significance_needed(beside, enough) &&
                  evidence.flip_p_value <= flip_needed && !evidence.at_bound && beside.came_true;
  need.is_needed = need.is_sound && !evidence.too_small && !evidence.unnoticed;
  need.is_hopeless = evidence.p_value > kHopeless || evidence.typicals < 0.5 * smallest;
  return need;
}

}  // namespace sandhopper::diagnose
