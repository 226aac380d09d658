#pragma once
#include <optional>

#include "tools/conceal/case.hpp"

namespace sandhopper::conceal {

// Part of a recording, one channel in one phase, in which a hidden effect exceeds the noise. Ratio: RMS
// difference between the recordings with all hidden effects and with all but this one / the sensor's noise in
// that channel and phase.
struct Cell {
  std::string channel, phase;
  double ratio;            // over all trials
  double max_trial_ratio;  // largest of one trial, > 1
};

// The cells of an effect, ordered by channel and phase. nullopt: no cell can be said to show the effect (a
// data fault; an effect that exceeds the noise in inputs of the simulation only).
using EffectCells = std::optional<std::vector<Cell>>;

// The cells of each hidden effect of the case, in its order.
std::vector<EffectCells> cells_of_effects(const Case& c);

}  // namespace sandhopper::conceal
