#include "tools/diagnose/answer/spread_text.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <string_view>

#include "tools/diagnose/answer/diagnosis_text.hpp"
#include "tools/diagnose/model/quantity.hpp"
#include "tools/report/digits.hpp"

namespace sandhopper::diagnose {
namespace {

constexpr std::string_view kRelative = "_relative";

double mean_square(double mean, double sd) { return mean * mean + sd * sd; }

// "-9.0 +- 8.0 %"
std::string mean_and_sd(const TrialToTrial& n, double mean, double sd) {
  const bool relative = n.name.ends_with(kRelative);
  auto unit = relative ? std::string("%") : quantity_of(n.name).unit;
  const bool in_mm = unit == "m" && std::abs(n.believed_sd) < kShort_m;  // as the believed spread beside it
  if (in_mm) unit = "mm";
  const double scale = relative ? 100.0 : in_mm ? 1e3 : 1.0;
  const auto text = [&](double value) { return digits_by(value, scale * sd).value_or(two_digits(value)); };
  return fmt::format("{} +- {}{}{}", text(scale * mean), text(scale * sd), unit.empty() ? "" : " ", unit);
}

std::string beyond(const TrialToTrial& n) {
  const auto most =
      std::ranges::max_element(n.values, {}, [](const auto& value) { return std::abs(value.after); });
  const auto exceed = std::ranges::count_if(n.values, &SpreadValue::exceeds_after);
  std::string text = fmt::format("{} differs by {} in {}, {} times the {} {}", subject_of(n),
                                 amount_in_words(n, most->after), most->trial,
                                 two_digits(std::abs(most->after) / n.believed_sd),
                                 n.is_default ? "assumed" : "stated", amount_in_words(n, n.believed_sd));
  if (exceed > 1) text += fmt::format(", and too far in {} other trial{}", exceed - 1, exceed > 2 ? "s" : "");
  if (!n.goes_with.empty()) text += "; it " + n.goes_with;
  return text;
}

std::string alike(const TrialToTrial& n) {
  return fmt::format("{} is off by {} alike in {} trials; its spread is not stated, and {} was assumed",
                     subject_of(n), amount_in_words(n, n.mean_after), n.values.size(),
                     amount_in_words(n, n.believed_sd));
}

}  // namespace

bool TrialToTrial::exceeds_before() const {
  return std::ranges::any_of(values, &SpreadValue::exceeds_before);
}
bool TrialToTrial::exceeds_after() const { return std::ranges::any_of(values, &SpreadValue::exceeds_after); }

std::string amount_in_words(const TrialToTrial& n, double value) {
  return n.name.ends_with(kRelative) ? fmt::format("{} %", two_digits(100.0 * value))
                                     : measured(value, quantity_of(n.name).unit);
}

std::string subject_of(const TrialToTrial& n) {
  return n.name.ends_with(kRelative) ? n.name.substr(0, n.name.size() - kRelative.size()) : n.name;
}

std::string beyond_spread(const Diagnosis& d) {
  std::string text;
  for (const auto& n : d.trial_to_trial)
    if (n.exceeds_after() || n.shifts_alike)
      text += (text.empty() ? "" : "; and if ") + (n.exceeds_after() ? beyond(n) : alike(n));
  return text;
}

std::string otherwise(const Diagnosis& d) {
  return std::ranges::any_of(d.trial_to_trial, &TrialToTrial::exceeds_after)
             ? "Either the believed spread is too small, or something unlisted acts there."
             : "Correct what all trials share, or state the spread, and diagnose again.";
}

std::string taken_up_before(const Diagnosis& d) {
  if (d.effects.empty()) return "";
  std::string text;
  for (const auto& n : d.trial_to_trial) {
    if (!n.exceeds_before() ||
        mean_square(n.mean_before, n.sd_before) <= mean_square(n.mean_after, n.sd_after))
      continue;
    text += fmt::format("{}{} had to move by {} over the trials ({} sd {}); after, by {}",
                        text.empty() ? "" : "; ", subject_of(n), mean_and_sd(n, n.mean_before, n.sd_before),
                        n.is_default ? "assumed" : "stated", amount_in_words(n, n.believed_sd),
                        mean_and_sd(n, n.mean_after, n.sd_after));
  }
  return text.empty()
             ? ""
             : "To come so near without what was found, the fit moved other numbers: before, " + text + ".";
}

}  // namespace sandhopper::diagnose
