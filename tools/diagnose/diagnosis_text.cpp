#include "tools/diagnose/diagnosis_text.hpp"

#include <fmt/format.h>

namespace sandhopper::diagnose {
namespace {

std::string headline(const Diagnosis& d) {
  if (d.verdict == "consistent")
    return fmt::format(
        "Nothing is missing: {} trials agree with the simulation within their own repeatability.", d.trials);
  if (d.verdict == "insufficient_data") return fmt::format("{} trials are too little to say.", d.trials);
  if (d.verdict == "unknown_physics") return "Something is missing that is on no list.";
  if (d.detail == "data_fault") return "The physics agrees; the recording has faults.";
  if (d.detail == "one_of_class")
    return "Something is missing; these recordings leave more than one explanation.";
  if (d.detail == "known_and_rest") return "Something is missing; what was found does not explain all of it.";
  return "Something is missing.";
}

std::string joined(const std::vector<std::string>& words) {
  std::string text;
  for (const auto& word : words) text += (text.empty() ? "" : ", ") + word;
  return text;
}

}  // namespace

std::string to_text(const Diagnosis& d) {
  std::string text = headline(d) + "\n";
  for (const auto& e : d.effects) {
    text +=
        fmt::format("  {} (probability {:.2f}): {}\n    {}\n", e.id, e.probability, e.statement, e.equation);
    for (const auto& p : e.parameters)
      text +=
          fmt::format("    {} = {:.5g}, 95 % between {:.5g} and {:.5g}\n", p.name, p.value, p.low, p.high);
    if (!e.indistinguishable_from.empty())
      text += fmt::format("    cannot be told apart on these recordings from {}\n",
                          joined(e.indistinguishable_from));
  }
  for (const auto& w : d.where)
    text += fmt::format("  seen in {} during {}: {:.0f} % of the excess, {} {:.4g} to {:.4g}, p = {:.2g}\n",
                        w.channel, w.phase, 100.0 * w.share_of_excess, w.coordinate, w.range_low,
                        w.range_high, w.p_value);
  for (const auto& f : d.fits)
    text += fmt::format("  {}: held-out error {:.4g} before, {:.4g} after, floor {:.4g}\n", f.channel,
                        f.heldout.before, f.heldout.after, f.floor);
  for (const auto& note : d.notes) text += "  note: " + note + "\n";
  text += fmt::format("{} simulations in {:.1f} s ({:.0f} a second)", d.simulations, d.seconds,
                      static_cast<double>(d.simulations) / (d.seconds > 0.0 ? d.seconds : 1.0));
  return text;
}

}  // namespace sandhopper::diagnose
