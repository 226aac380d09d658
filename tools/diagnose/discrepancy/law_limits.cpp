#include "tools/diagnose/discrepancy/law_limits.hpp"

#include <algorithm>
#include <cmath>

#include "tools/diagnose/discrepancy/misfit.hpp"
#include "tools/diagnose/fit/levels.hpp"

// Limits below without measured values were set by hand on campaigns of this project
// (tools/diagnose/README.md, "Open").
namespace sandhopper::diagnose {
namespace {

// Limits of the fraction of the explainable deviance that a free law explains (a law of a sensor, a law of
// the plant). Measured beside the right names: at most 0.08 for a law of the plant (105 campaigns of a second
// program), 0.16 for a law of a sensor.
constexpr double kUnknownShare = 0.30, kUnknownShareOfPlant = 0.16;
// p-value of a law beside the names whose gain is not unmistakable.
constexpr double kUnknownSignificance = 0.003;
constexpr double kSmallestLaw = 0.1;  // Ignore laws whose largest value (in scales of the port) is smaller.
// Least gains. Relative to the best fit's deviance, at most ten times the form error of the plant: the errors
// of a null campaign stay below.
constexpr double kUnknownGain = 25.0, kUnknownShareOfDeviance = 0.03;
// Smaller gains change no residual by a noticeable fraction of the noise floor.
constexpr double kUnknownGainPerRow = 0.004;
constexpr double kMostTrialsLeft = 0.75;  // fraction of the trials that a law must improve
constexpr double kBalanceShare = 0.25;    // Fraction of a trial's variance; below 0.05 with nothing missing.
// A free law must explain this many times what the best names explain.
constexpr double kOutdone = 1.3;
// Expected deviance per row that no law undercuts; free laws are tried only if they can stay above it.
constexpr double kLeastPerRow = 0.75;
// Limits of |z| of a common nuisance offset: beside named effects (at most 3.3 with the right ones), and
// without any (at most 2.9 with nothing missing).
constexpr double kShiftBesideNames = 4.5, kShiftAlone = 6.0;

}  // namespace

double least_gain_of_law(const BestNames& best) {
  return std::max({kUnknownGain, kUnknownGainPerRow * best.rows,
                   std::min(kUnknownShareOfDeviance, 10.0 * best.form_error) * best.deviance,
                   best.form_error * best.explained});
}

bool is_law_beside(const FreeGain& gain, double rows) {
  const bool much = gain.held_out > kUnmistakablePerRow * rows;
  return gain.p_value < (much ? kLevel : kUnknownSignificance) && gain.trials_better >= kMostTrialsLeft &&
         gain.size.cwiseAbs().maxCoeff() > kSmallestLaw;
}

bool is_likely_law(const FreeGain& gain) { return gain.held_out > kUnknownGain; }

bool is_law_of_balance(const FreeGain& gain) {
  return gain.family.variable != "torque_Nm" && gain.family.variable != "t_s" &&
         gain.held_out > kBalanceShare && gain.p_value < kSignificance &&
         gain.trials_better >= kMostTrialsLeft;
}

bool is_law_in_place_of_faults(const FreeGain& gain, double of_faults) {
  return !gain.family.sensor && gain.held_out > std::max(of_faults, kUnknownGain) && gain.p_value < kLevel &&
         gain.trials_better >= kMostTrialsLeft;
}

bool outdoes_names(const FreeGain& gain, const BestNames& best) {
  return gain.held_out > kOutdone * best.explained + least_gain_of_law(best) && gain.p_value < kLevel &&
         gain.trials_better >= kMostTrialsLeft;
}

bool may_be_outdone(const BestNames& best) {
  return best.deviance - (kOutdone - 1.0) * best.explained - least_gain_of_law(best) >
         kLeastPerRow * best.rows;
}

bool is_beyond_form(const FreeGain& gain, double share, double rows) {
  return share > (gain.family.sensor ? kUnknownShare : kUnknownShareOfPlant) ||
         gain.held_out > kUnmistakablePerRow * rows;
}

bool is_unknown_shift(double z, bool beside_names) {
  return std::abs(z) > (beside_names ? kShiftBesideNames : kShiftAlone);
}

}  // namespace sandhopper::diagnose
