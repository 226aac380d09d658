#pragma once
#include "tools/diagnose/evidence/search.hpp"

// Limits that decide if the trials need an effect of a fitted set.
namespace sandhopper::diagnose {

// Figures beside the evidence of one effect.
struct BesideEvidence {
  std::size_t trials = 0, effects = 1;  // effects: size of the set
  std::size_t candidates = 1;           // effects that were screened
  double rows = 0.0;
  double form_error = 0.0;        // PlantModel::form_error
  bool is_strongest = true;       // smallest p-value of the set
  double drop = 0.0;              // Drop of the deviance from the fit without the effect to that with it.
  bool came_true = true;          // comes_true()
  bool removes_offset = false;    // removes_offset()
  double explained = 0.0;         // Drop of the deviance by the whole set.
  double between_programs = 0.0;  // Drop by which two programs with the same equations may differ.
};

struct Need {
  bool is_sound = false;     // Significant, inside its range, and true in the simulation.
  bool is_needed = false;    // Sound, large enough and noticeable.
  bool is_hopeless = false;  // Not worth a better fit.
};

// Sets `weak`, `too_small` and `unnoticed` of the evidence.
Need need_of(EffectEvidence& evidence, const BesideEvidence& beside);

// True if the deviance without the effect is really higher: by a fraction of the linear gain in total, or
// consistently over the trials.
bool comes_true(const Fit& without, const Fit& with, double linear_gain);
// True if most of the linear gain is real.
bool is_mostly_true(double drop, double linear_gain);

// True if the nuisance parameters have absorbed something that is missing: the deviance stays far above the
// noise, or all trials shift one nuisance alike. `z`: of largest_common_shift().
bool have_absorbed(double deviance, double rows, double z);
// True if an effect removes most of an offset that a nuisance had in all trials.
bool removes_offset(double z_without, double z_with);

}  // namespace sandhopper::diagnose
