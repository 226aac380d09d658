#include "tools/diagnose/answer/diagnosis_text.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <ranges>

#include "tools/diagnose/answer/spread_text.hpp"
#include "tools/diagnose/discrepancy/left_over.hpp"
#include "tools/diagnose/model/quantity.hpp"
#include "tools/report/digits.hpp"

namespace sandhopper::diagnose {
namespace {

constexpr std::size_t kMostCells = 3;
constexpr std::size_t kMostChannels = 3;
constexpr std::size_t kMostBounds = 4;

std::string joined(const std::vector<std::string>& words) {
  std::string text;
  for (const auto& word : words) text += (text.empty() ? "" : ", ") + word;
  return text;
}

// A value in the unit of its channel, as in the tables beside it: a page has one unit for one quantity.
std::string in_unit(double value, const std::string& unit) {
  return plain_number(value, 3) + (unit.empty() ? "" : " " + unit);
}

// At most "99 %": the rest is never exactly zero.
std::string percent(double share) { return fmt::format("{:.0f} %", std::min(99.0, 100.0 * share)); }

std::string effect_text(const FoundEffect& e) {
  std::string text =
      fmt::format("{} {} (probability {:.2f}): {}\n       {}\n", e.may_be_zero() ? "maybe " : "what  ", e.id,
                  e.probability, e.statement, e.equation);
  for (const auto& p : e.parameters)
    text +=
        fmt::format("       {} = {}, 95 % between {} and {}{}{}\n", p.name, plain_number(p.value, 4),
                    plain_number(p.low, 4), plain_number(p.high, 4), p.limit ? "; " : "", p.limit_in_words());
  if (e.may_be_zero()) text += "       suspected, not found: its 95 % interval contains zero\n";
  if (!e.indistinguishable_from.empty())
    text += fmt::format("       cannot be told apart on these recordings from {}\n",
                        joined(e.indistinguishable_from));
  return text;
}

std::string where_text(const Where& w) {
  std::string text = "where  ";
  if (!w.port.empty()) text += w.port + ": ";
  text += fmt::format("{} during {}, {}", w.channel, w.phase_in_words(), w.share_in_words());
  if (!w.coordinate.empty())
    text += fmt::format(", {} {} to {}", w.coordinate, plain_number(w.range_low, 3),
                        plain_number(w.range_high, 3));
  return text + fmt::format(", p = {:.1g}\n", w.p_value);
}

// With nothing found, before and after are the same fit.
std::string error_text(const ChannelFit& f, bool changed) {
  const auto unit = quantity_of(f.channel).unit;
  return fmt::format(
      "error  {}: {} on held-out trials (rms {}{}; noise floor {}, noise of a sample {}{}{})\n", f.channel,
      changed ? times_the_floor(f.heldout, f.floor) : times_the_floor(f.heldout.before, f.floor),
      plain_number(f.heldout.before, 4), changed ? " and " + plain_number(f.heldout.after, 4) : "",
      plain_number(f.floor, 4), plain_number(f.noise, 4), unit.empty() ? "" : ", all in ", unit);
}

std::string next_text(const NextTrial& next) {
  if (!next.is_recommended()) return next.why.empty() ? "" : "next   " + next.why + "\n";
  return fmt::format("next   {}:\n       {}\n", next.order, next.reason());
}

// The widest bounds, and the number of the others.
std::string absent_text(const std::vector<Bound>& absent) {
  if (absent.empty()) return "";
  std::string text = "absent ";
  for (std::size_t i = 0; i < absent.size() && i < kMostBounds; ++i)
    text += fmt::format("{}{}: {} {} {}", i == 0 ? "" : "; ", absent[i].id, absent[i].parameter,
                        absent[i].is_lower ? ">" : "<", plain_number(absent[i].value, 2));
  if (absent.size() > kMostBounds)
    text += fmt::format("; {} more with smaller bounds", absent.size() - kMostBounds);
  return text + "\n";
}

// The listed effects; those that are more likely not there than there, or whose interval holds zero, follow
// as a guess.
std::string names_in_words(const Diagnosis& d) {
  std::vector<std::string> likely, guesses;
  for (const auto& e : d.effects)
    if (!e.is_unknown()) (e.probability < 0.5 || e.may_be_zero() ? guesses : likely).push_back(e.id);
  if (guesses.empty()) return joined(likely);
  return likely.empty() ? "perhaps " + joined(guesses) : joined(likely) + ", perhaps " + joined(guesses);
}

// True if at least half of the held-out error remains in the channel with the largest error.
bool explains_little(const Diagnosis& d) {
  return !d.fits.empty() && d.fits.front().heldout.after >= 0.5 * d.fits.front().heldout.before;
}

// True if the headline holds remainder_text().
bool is_in_headline(const Diagnosis& d) { return d.first && d.verdict == Verdict::unknown_physics; }

}  // namespace

bool FoundEffect::may_be_zero() const {
  if (parameters.empty()) return false;
  // For a number of the belief, its change decides, not its value.
  const bool next = !parameters[0].derived && parameters.size() > 1 && parameters[1].derived;
  const auto& size = parameters[next ? 1 : 0];
  return size.low <= 0.0 && size.high >= 0.0 && size.low < size.high;
}

std::string NextTrial::reason() const {
  return order.empty() || !why.starts_with(order + ": ") ? why : why.substr(order.size() + 2);
}

std::string Where::share_in_words() const {
  const bool is_small = share_of_excess < 0.005;
  return fmt::format(
      "{} % of {}", is_small ? "less than 1" : fmt::format("{:.0f}", 100.0 * share_of_excess),
      unexplained ? "the squared error above the noise" : "the change that the correction makes");
}

std::string Where::phase_in_words() const {
  if (phase == "early") return "the first third";
  if (phase == "middle") return "the second third";
  return phase == "late" ? "the last third" : in_words(phase);
}

std::string two_digits(double value) {
  const double tens = std::pow(10.0, std::floor(std::log10(std::max(std::abs(value), 1e-300))) - 1.0);
  if (std::abs(value) >= 99.5 && std::abs(value) < 1e6)
    return fmt::format("{:.0f}", tens * std::round(value / tens));
  auto text = fmt::format("{:.2g}", value);
  return text.size() == 1 && text != "0" ? text + ".0" : text;
}

std::string times_the_floor(const ErrorBeforeAfter& error, double floor) {
  return fmt::format("{} times the noise floor before, {} after", two_digits(error.before / floor),
                     two_digits(error.after / floor));
}

std::string times_the_floor(double error, double floor) {
  return fmt::format("{} times the noise floor", two_digits(error / floor));
}

std::string FoundParameter::limit_in_words() const {
  if (!limit) return "";
  return fmt::format("at its limit of {}: the true value may lie beyond",
                     in_unit(*limit, quantity_of(name).unit));
}

std::string SensorNoise::in_words() const {
  const auto unit = quantity_of(channel).unit;
  std::string text = in_unit(used, unit);
  if (stated > 0.0)
    text += fmt::format(
        ", {} times the {} stated{}. From sample to sample it scatters by {}: ", two_digits(times()),
        in_unit(stated, unit), source.empty() ? "" : " (" + source + ")", in_unit(measured, unit));
  else
    text += fmt::format(", {} times the {} by which it scatters from sample to sample: ", two_digits(times()),
                        in_unit(measured, unit));
  if (is_sensor_worse) text += "the sensor is worse than stated";
  if (used > kQuietChannel * measured || !is_sensor_worse)
    text += fmt::format("{}the rest changes slowly, so it is an error of the model, or the sensor drifts",
                        is_sensor_worse ? ", and " : "");
  text += ".";
  return text + " Errors, intervals and bounds are computed with the larger noise.";
}

double beyond_floor(double error, double floor) {
  return std::sqrt(std::max(0.0, error * error - floor * floor));
}

std::string remainder_text(const Diagnosis& d) {
  if (d.fits.empty() || d.effects.empty()) return "";
  const auto& f = *std::ranges::max_element(
      d.fits, {}, [](const ChannelFit& fit) { return fit.heldout.after / std::max(fit.floor, 1e-300); });
  const bool is_clear = f.heldout.after > kMoreThanNoise * f.floor;
  if (!is_clear && std::ranges::none_of(d.effects, &FoundEffect::is_unknown)) return "";
  const auto unit = quantity_of(f.channel).unit;
  const double left = beyond_floor(f.heldout.after, f.floor),
               before = beyond_floor(f.heldout.before, f.floor);
  const auto share = [&](double of) { return fmt::format("{} %", two_digits(100.0 * left / of)); };
  if (left == 0.0) return fmt::format("{}: what remains is not larger than the noise floor.", f.channel);
  std::string text =
      fmt::format("{}: what remains is {} rms beyond the noise floor", f.channel, in_unit(left, unit));
  if (f.range > 0.0) text += fmt::format(", {} of the range of {}", share(f.range), in_unit(f.range, unit));
  if (d.first && d.first->error.contains(f.channel) && d.first->error.at(f.channel) > 0.0) {
    const double of_first = d.first->error.at(f.channel);
    return text + fmt::format(", and {} of the {} that the first model left ({}).", share(of_first),
                              in_unit(of_first, unit), d.first->file);
  }
  const bool improved = std::ranges::any_of(d.effects, [](const auto& e) { return !e.is_unknown(); });
  if (improved && before > 0.0)
    text += fmt::format(", and {} of the {} before", share(before), in_unit(before, unit));
  return text + ".";
}

std::string below_the_floor(const Diagnosis& d) {
  const auto is_low = [](const ChannelFit& f) { return f.heldout.before < kMoreThanNoise * f.floor; };
  if (d.effects.empty() || d.detail == Detail::data_fault || !std::ranges::all_of(d.fits, is_low) ||
      !taken_up_before(d).empty())
    return "";
  return "No channel's error is clearly above its noise floor before: what was found shows in the shape of "
         "the errors over time, which is the same in all trials, and not in their size.";
}

std::string headline(const Diagnosis& d) {
  const auto beyond = beyond_spread(d);
  if (d.verdict == Verdict::consistent && !beyond.empty())
    return fmt::format("{} trials agree with the simulation: consistent only if {}. {}", d.trials, beyond,
                       otherwise(d));
  if (d.verdict == Verdict::consistent)
    return fmt::format(
        "Nothing is missing: {} trials agree with the simulation within their own repeatability.", d.trials);
  if (d.verdict == Verdict::insufficient_data)
    return fmt::format("{} trials are too few to say what is missing.", d.trials);
  if (d.verdict == Verdict::insufficient_time)
    return "The limit of time ended the search before anything was known: give it more time (--limit-s).";
  if (d.verdict == Verdict::unknown_physics)
    return d.first
               ? "Something unlisted is left, beside what the corrected model contains. " + remainder_text(d)
           : explains_little(d)
               ? "Something is missing, and no listed effect explains half of it: check units, signs, "
                 "columns, the selected part of each recording and the believed numbers first (hop campaign "
                 "check)."
               : "Something is missing that no listed effect describes.";
  const std::string names = names_in_words(d);
  const auto is_name = [](const FoundEffect& e) { return !e.is_unknown(); };
  if (!names.empty() &&
      std::ranges::all_of(d.effects | std::views::filter(is_name), &FoundEffect::may_be_zero)) {
    std::vector<std::string> ids;
    for (const auto& e : d.effects | std::views::filter(is_name)) ids.push_back(e.id);
    return fmt::format("Something may be missing: {}; {} 95 % interval holds zero.", joined(ids),
                       ids.size() > 1 ? "each" : "its");
  }
  if (d.detail == Detail::data_fault) return "The physics agrees; the recording has faults.";
  if (d.detail == Detail::one_of_class)
    return "Something is missing; these recordings leave more than one explanation.";
  if (d.detail == Detail::known_and_rest)
    return fmt::format(
        "Something is missing: {}. This closes {} of the gap between simulation and recordings; the rest is "
        "on no list.",
        names, percent(d.gap_closed));
  return "Something is missing: " + names + ".";
}

double simulations_per_second(const Diagnosis& d) {
  return static_cast<double>(d.simulations) / std::max(d.seconds, 1e-3);
}

std::string limit_text(const Diagnosis& d) {
  if (d.stopped_in.empty()) return "";
  return fmt::format(
      "The limit of time ended the search while {}. What follows is known so far: another set of effects may "
      "explain the recordings better. Not checked: unlisted physics, bounds of absent effects, the next "
      "trial.",
      d.stopped_in);
}

std::string to_text(const Diagnosis& d) {
  std::string text = fmt::format("verdict: {}. {}\n", name_of(d.verdict, d.detail), headline(d));
  if (const auto limit = limit_text(d); !limit.empty()) text += "limit  " + limit + "\n";
  for (const auto& e : d.effects) text += effect_text(e);
  for (std::size_t i = 0; i < d.where.size() && i < kMostCells; ++i) text += where_text(d.where[i]);
  for (std::size_t i = 0; i < d.fits.size() && i < kMostChannels; ++i)
    text += error_text(d.fits[i], !d.effects.empty());
  if (const auto left = remainder_text(d); !left.empty() && !is_in_headline(d))
    text += "left   " + left + "\n";
  if (const auto below = below_the_floor(d); !below.empty()) text += "       " + below + "\n";
  if (const auto before = taken_up_before(d); !before.empty()) text += "       " + before + "\n";
  if (const auto beyond = beyond_spread(d); !beyond.empty() && d.verdict != Verdict::consistent)
    text += "spread even with this answer, " + beyond + "\n";
  for (const auto& noise : d.noise)
    if (noise.is_raised) text += fmt::format("noise  {}: {}\n", noise.channel, noise.in_words());
  text += next_text(d.next) + absent_text(d.absent);
  for (const auto& note : d.notes) text += "note   " + note + "\n";
  text += fmt::format("{} simulations in {:.1f} s ({:.0f} a second)", d.simulations, d.seconds,
                      simulations_per_second(d));
  return text;
}

}  // namespace sandhopper::diagnose
