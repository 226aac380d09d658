#pragma once
#include "tools/diagnose/discrepancy/open_world.hpp"

// Limits that decide if a law of free form is unknown physics.
namespace sandhopper::diagnose {

// The best set of named effects, beside which or in place of which a law may act.
struct BestNames {
  double rows = 0.0;
  double deviance = 0.0;
  double explained = 0.0;   // drop of the deviance by the names
  double form_error = 0.0;  // PlantModel::form_error
};

// Least held-out gain of a law beside the names: above the errors of a simulation with nothing missing, and
// above what another form of the named laws leaves.
double least_gain_of_law(const BestNames& best);

// A law beside the names, whose gain exceeds the least one. If few trials show it, the p-value is weak: that
// is accepted if the gain is unmistakable.
bool is_law_beside(const FreeGain& gain, double rows);
// The most probable law, if the names leave far more than the noise.
bool is_likely_law(const FreeGain& gain);
// A law of force balances. Laws of torque (listed actuator effects look the same) and of time (correlates
// with everything) are none.
bool is_law_of_balance(const FreeGain& gain);
// A law in place of small sensor faults, which gain `of_faults`.
bool is_law_in_place_of_faults(const FreeGain& gain, double of_faults);

// A law that explains more on held-out trials than the names on the trials they were fitted to: the names
// are wrong.
bool outdoes_names(const FreeGain& gain, const BestNames& best);
// False if no law can, because the deviance cannot fall so low.
bool may_be_outdone(const BestNames& best);

// True if what a law explains is too much for an error in the form of the named laws: as a share of what both
// explain, or per row.
bool is_beyond_form(const FreeGain& gain, double share, double rows);

// True if a nuisance's mean over the trials is an effect that is missing. `z`: of largest_common_shift().
bool is_unknown_shift(double z, bool beside_names);

}  // namespace sandhopper::diagnose
