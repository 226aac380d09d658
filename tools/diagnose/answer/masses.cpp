#include "tools/diagnose/answer/masses.hpp"

#include <algorithm>
#include <functional>

#include "tools/diagnose/evidence/calibration.hpp"
#include "tools/diagnose/fit/levels.hpp"

namespace sandhopper::diagnose {
namespace {

bool is_fault(const FoundEffect& effect) { return !effect.channel.empty(); }

}  // namespace

void limit_beside_each_other(std::vector<FoundEffect>& effects) {
  std::ranges::sort(effects, std::greater<>{}, &FoundEffect::heldout_gain);
  bool form_in_doubt = false;
  for (std::size_t i = 1; i < effects.size(); ++i) {
    auto& beside = effects[i];
    if (beside.is_unknown()) continue;
    beside.mass = mass_beside(beside.mass, beside.heldout_gain);
    form_in_doubt = form_in_doubt || (is_fault(beside) && beside.heldout_gain < kSmallShare);
  }
  if (form_in_doubt && !is_fault(effects.front()))
    effects.front().mass = std::min(effects.front().mass, kMostInDoubt);
}

bool limit_by_rest(std::vector<FoundEffect>& effects, const BesideNames& rest) {
  bool likely = false;
  for (auto& effect : effects) {
    if (effect.is_unknown()) {
      if (rest.not_checked) effect.mass = std::min(effect.mass, kMostInDoubt);
      continue;
    }
    if (rest.unknown || rest.has_law) effect.mass *= rest.gap_closed;
    // The rest may be an error in the form of a named law, also if it was not looked at.
    if (rest.not_checked) effect.mass = std::min(effect.mass, kMostInDoubt);
    likely = likely || effect.mass > kLikelierThanNot;
  }
  if (!(rest.gap_closed > kLikelierThanNot) || !likely) return false;
  for (auto& effect : effects) {
    if (effect.is_unknown()) effect.mass = std::min(effect.mass, kLikelierThanNot);
    if (rest.unknown) effect.mass = std::min(effect.mass, kMostInDoubt);
  }
  return true;
}

double mass_of_unknown(double p_value) {
  return 1.0 - kLikelierThanNot * std::min(1.0, p_value / kSignificance);
}

}  // namespace sandhopper::diagnose
