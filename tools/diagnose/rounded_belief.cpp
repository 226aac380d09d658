#include "tools/diagnose/rounded_belief.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "config/hint.hpp"

namespace sandhopper::diagnose {
namespace {

// Those of `rounding` whose error of half a digit is larger than one that the recordings would show.
std::vector<KeySpread> that_show(const std::vector<KeySpread>& rounding, const Diagnosis& diagnosis) {
  std::vector<KeySpread> shown;
  for (const auto& known : rounding) {
    const auto number = std::ranges::find(diagnosis.belief, known.key, &BelievedNumber::key);
    if (number != diagnosis.belief.end() && number->matters()) shown.push_back(known);
  }
  return shown;
}

Recordings known_to(Recordings recordings, const std::vector<KeySpread>& rounding) {
  const auto add = [&](Belief& belief) {
    belief.known_to.insert(belief.known_to.end(), rounding.begin(), rounding.end());
  };
  add(recordings.belief);
  for (auto& belief : recordings.beliefs) add(belief);
  return recordings;
}

// No rounding is larger than half a digit: a number that is off by more is wrong, and that is an effect.
bool within_half_a_digit(const std::vector<KeySpread>& rounding, const Diagnosis& d) {
  return std::ranges::all_of(rounding, [&](const KeySpread& known) {
    const auto number = std::ranges::find(d.belief, known.key, &BelievedNumber::key);
    return number != d.belief.end() && std::abs(number->asked_for) <= std::sqrt(3.0) * known.sd;
  });
}

// True if a named effect, or one that cannot be told from it, changes one of these numbers by no more than
// half a digit. How far a member of a class would change its number is not known here.
bool may_be_rounding(const std::vector<KeySpread>& rounding, const Diagnosis& d) {
  const auto effects = known_effects();
  const auto rounding_of = [&](const std::string& id) {
    const auto effect = std::ranges::find(effects, id, &Effect::id);
    return effect == effects.end() || effect->belief_key.empty()
               ? rounding.end()
               : std::ranges::find(rounding, effect->belief_key, &KeySpread::key);
  };
  return std::ranges::any_of(d.effects, [&](const FoundEffect& found) {
    if (const auto own = rounding_of(found.id); own != rounding.end()) {
      const auto change = std::ranges::find_if(found.parameters, &FoundParameter::is_change);
      if (change != found.parameters.end() && std::abs(change->value) <= std::sqrt(3.0) * own->sd)
        return true;
    }
    return std::ranges::any_of(found.indistinguishable_from,
                               [&](const std::string& id) { return rounding_of(id) != rounding.end(); });
  });
}

bool has_unknown(const Diagnosis& d) { return std::ranges::any_of(d.effects, &FoundEffect::is_unknown); }

void note_rounding(const std::vector<KeySpread>& rounding, Diagnosis& diagnosis) {
  for (const auto& known : rounding) {
    const auto number = std::ranges::find(diagnosis.belief, known.key, &BelievedNumber::key);
    if (number == diagnosis.belief.end()) continue;
    diagnosis.notes.push_back(fmt::format(
        "{} = {:.6g} is known to the last digit that is written, +-{:.2g}, and that error would show "
        "here: it is taken to be off by {:+.2g}. Write more digits, or under [known_to] how well you know "
        "it: {} = {:.2g}",
        known.key, number->size(), std::sqrt(3.0) * known.sd, number->asked_for, last_key(known.key),
        known.sd));
  }
}

}  // namespace

Diagnosis diagnose_as_written(const Recordings& recordings, const EngineOptions& options,
                              const std::vector<KeySpread>& rounding) {
  auto exact = diagnose(recordings, options);
  if (exact.effects.empty() || !exact.stopped_in.empty() || recordings.plant == PlantKind::hopper)
    return exact;
  const auto shown = that_show(rounding, exact);
  if (shown.empty() || !may_be_rounding(shown, exact)) return exact;
  EngineOptions again = options;
  again.first_verdict = [](const std::string&) {};
  again.progress = [&](double share, const char*) { options.progress(share, "again, with rounded numbers"); };
  auto rounded = diagnose(known_to(recordings, shown), again);
  const bool is_worse = (has_unknown(rounded) && !has_unknown(exact)) || !within_half_a_digit(shown, rounded);
  if (!rounded.stopped_in.empty() || is_worse || rounded.effects.size() >= exact.effects.size()) return exact;
  rounded.simulations += exact.simulations;
  rounded.seconds += exact.seconds;
  note_rounding(shown, rounded);
  return rounded;
}

}  // namespace sandhopper::diagnose
