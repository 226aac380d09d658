#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "tools/diagnose/answer/diagnosis_text.hpp"
#include "tools/diagnose/answer/page/diagnosis_page.hpp"
#include "tools/diagnose/answer/spread_text.hpp"
#include "tools/diagnose/model/digits.hpp"
#include "tools/diagnose/model/quantity.hpp"

namespace sandhopper::diagnose {
namespace {

using Style = StudyAnswer::Style;

std::string p_text(double p) {
  return "p\u00a0" + (p < kLeastProbability ? "" : std::string("=\u00a0")) + probability_text(p);
}

std::string joined(const std::vector<std::string>& words, const char* last) {
  std::string text;
  for (std::size_t i = 0; i < words.size(); ++i)
    text += (i == 0 ? "" : i + 1 == words.size() ? fmt::format(" {} ", last) : ", ") + words[i];
  return text;
}

bool nothing_found(const Diagnosis& d) { return d.effects.empty(); }

std::string place_of(const Where& w) {
  const auto axis = quantity_of(w.coordinate);
  std::string text =
      fmt::format("{}, {}, {:.3g} to {:.3g} s", w.channel, w.phase_in_words(), w.from_s, w.to_s);
  const double width = std::abs(w.range_high - w.range_low);
  if (!w.coordinate.empty() && w.coordinate != "t_s")
    text += fmt::format("; {} {} to {} {}", axis.words, to_digits_of(w.range_low, width),
                        to_digits_of(w.range_high, width), axis.unit);
  return text + fmt::format("; {}, {}", w.share_in_words(), p_text(w.p_value));
}

std::vector<std::string> ports_of(const Diagnosis& d) {
  std::vector<std::string> ports;
  const auto add = [&](const std::string& port) {
    if (!port.empty() && std::find(ports.begin(), ports.end(), port) == ports.end()) ports.push_back(port);
  };
  for (const auto& w : d.where) add(w.port);
  for (const auto& e : d.effects) add(e.port);
  return ports;
}

StudyAnswer where(const Diagnosis& d) {
  StudyAnswer box{"Where", {}, {}, 3};
  if (nothing_found(d)) {
    box.lines.emplace_back(Style::lead, d.verdict == Verdict::consistent ? "Nowhere" : "Cannot be said");
    const PhaseError* worst = nullptr;
    for (const auto& e : d.phase_errors)
      if (e.samples >= 10 && (worst == nullptr || e.before / e.floor > worst->before / worst->floor))
        worst = &e;
    if (worst != nullptr)
      box.lines.emplace_back(
          Style::text,
          fmt::format("No channel differs from the simulation in any phase by more than trials "
                      "differ among themselves. Most: {}, {}, {}.",
                      worst->channel, in_words(worst->phase), times_the_floor(worst->before, worst->floor)));
    return box;
  }
  const auto ports = ports_of(d);
  box.lines.emplace_back(Style::lead, (ports.size() > 1 ? "Ports: " : "Port: ") + joined(ports, "and"));
  constexpr std::size_t kMost = 3;
  for (std::size_t i = 0; i < d.where.size() && i < kMost; ++i)
    box.lines.emplace_back(
        i == 0 ? Style::text : Style::quiet,
        (ports.size() > 1 && !d.where[i].port.empty() ? d.where[i].port + ": " : "") + place_of(d.where[i]));
  if (d.where.size() > kMost)
    box.lines.emplace_back(Style::quiet, fmt::format("and {} more, below", d.where.size() - kMost));
  if (d.where.empty())
    box.lines.emplace_back(Style::text,
                           d.detail == Detail::data_fault
                               ? "The faulty samples are left out; the rest agrees with the simulation."
                               : "No channel and phase alone shows it clearly.");
  return box;
}

std::string parameters_of(const FoundEffect& e) {
  std::string text;
  for (const auto& p : e.parameters) {
    const auto q = quantity_of(p.name);
    text += (text.empty() ? "" : ";  ") + q.words + " " + with_interval(p.value, p.low, p.high, q.unit) +
            (p.limit ? ", " + p.limit_in_words() : "");
  }
  return text;
}

StudyAnswer what(const Diagnosis& d) {
  StudyAnswer box{"What", {}, {}, 3};
  if (nothing_found(d)) {
    const auto beyond = beyond_spread(d);
    box.lines.emplace_back(Style::lead, d.verdict == Verdict::consistent && !beyond.empty()
                                            ? "Nothing, if numbers differ more than believed"
                                        : d.verdict == Verdict::consistent        ? "Nothing is missing"
                                        : d.verdict == Verdict::insufficient_time ? "Too little time"
                                                                                  : "Too few trials");
    if (d.verdict == Verdict::consistent && !beyond.empty())
      box.lines.emplace_back(Style::text, "Consistent only if " + beyond + ". " + otherwise(d));
    std::string bounds;
    for (std::size_t i = 0; i < d.absent.size() && i < 4; ++i) {
      const auto q = quantity_of(d.absent[i].parameter);
      bounds += fmt::format("{}{}: {} {} {}{}", bounds.empty() ? "" : ";  ", d.absent[i].id, q.words,
                            d.absent[i].is_lower ? "above" : "below", plain_number(d.absent[i].value, 2),
                            q.unit.empty() ? "" : " " + q.unit);
    }
    if (!bounds.empty())
      box.lines.emplace_back(Style::text, "Hardest to exclude: " + bounds + ". All bounds below.");
    return box;
  }
  const std::size_t most = d.effects.size() > 2 ? 3 : 2;
  for (std::size_t i = 0; i < d.effects.size() && i < most; ++i) {
    const auto& e = d.effects[i];
    box.lines.emplace_back(Style::lead, e.id + (e.channel.empty() ? "" : " on " + e.channel));
    box.lines.emplace_back(Style::text, e.statement);
    if (e.may_be_zero())
      box.lines.emplace_back(Style::text, "Suspected, not found: its 95 % interval contains zero.");
    if (d.effects.size() < 3) box.lines.emplace_back(Style::equation, e.equation);
    if (!e.parameters.empty()) box.lines.emplace_back(Style::text, parameters_of(e));
  }
  if (d.effects.size() > most)
    box.lines.emplace_back(Style::quiet, fmt::format("and {} more, below", d.effects.size() - most));
  return box;
}

StudyAnswer how_sure(const Diagnosis& d) {
  StudyAnswer box{"How sure", {}, {}, 2};
  if (nothing_found(d)) {
    box.lines.emplace_back(Style::lead, fmt::format("{} trials", d.trials));
    box.lines.emplace_back(
        Style::text,
        d.verdict == Verdict::consistent
            ? fmt::format("No listed effect is needed. The recordings bound the size of {} effects, see "
                          "\"What is absent\".",
                          d.absent.size())
        : d.verdict == Verdict::insufficient_time
            ? "The limit of time ended the search before an effect was found needed."
            : "The scatter between trials is not known well enough to distinguish an effect from chance.");
    return box;
  }
  bool classes = false;
  for (const auto& e : d.effects) classes = classes || !e.indistinguishable_from.empty();
  box.lines.emplace_back(Style::lead, classes ? "More than one explanation is left" : "Probability");
  for (const auto& e : d.effects) {
    box.bars.push_back(
        {e.id, e.probability, fmt::format("{:.2f}", e.probability), e.probability >= 0.8 ? "green" : "sand"});
    if (!e.indistinguishable_from.empty())
      box.lines.emplace_back(Style::text, fmt::format("{} cannot be told apart on these recordings from {}.",
                                                      e.id, joined(e.indistinguishable_from, "or")));
  }
  if (!d.unknown.empty())
    box.lines.emplace_back(
        Style::text,
        fmt::format("A free law of {} at {}, which no listed effect describes, predicts trials to which it "
                    "was not fitted ({}). It closes {:.0f} % of the gap between simulation and recording.",
                    d.unknown.front().curve.variable, d.unknown.front().port,
                    p_text(d.unknown.front().p_value), 100.0 * d.unknown.front().share));
  else if (!classes && d.detail == Detail::known && d.stopped_in.empty())
    box.lines.emplace_back(Style::text, "No other effect explains these recordings as well.");
  if (d.detail == Detail::data_fault) box.lines.emplace_back(Style::text, "The samples themselves show it.");
  return box;
}

StudyAnswer how_much_better(const Diagnosis& d) {
  StudyAnswer box{"How much better", {}, {}, 2};
  if (d.fits.empty()) {
    box.lines.emplace_back(Style::lead, "No error to show");
    return box;
  }
  const auto& f = d.fits.front();
  const auto q = quantity_of(f.channel);
  const double most = std::max({f.heldout.before, f.heldout.after, f.floor, 1e-300});
  const auto bar = [&](const char* label, double value, const char* color) {
    box.bars.push_back({label, value / most, plain_number(value, 3) + " " + q.unit, color});
  };
  const bool changed = is_changed(d);
  box.lines.emplace_back(Style::lead, fmt::format("{}: held-out error {}", f.channel,
                                                  changed ? times_the_floor(f.heldout, f.floor)
                                                          : times_the_floor(f.heldout.before, f.floor)));
  bar(changed ? "before" : "error", f.heldout.before, "orange");
  if (changed) bar("after", f.heldout.after, "blue");
  bar("noise floor", f.floor, "grey");
  box.lines.emplace_back(
      Style::quiet,
      fmt::format(
          "Root mean square{}. Noise floor: noise ({} a sample), uncertain inputs and model error together.",
          changed ? " on trials held out of the fit" : "", plain_number(f.noise, 2) + " " + q.unit));
  if (const auto left = remainder_text(d); !left.empty()) box.lines.emplace_back(Style::text, left);
  if (const auto before = taken_up_before(d); !before.empty()) box.lines.emplace_back(Style::text, before);
  for (const auto& noise : d.noise)
    if (noise.is_raised)
      box.lines.emplace_back(Style::text, fmt::format("The noise of {} is raised to {} times what {}; see "
                                                      "Noise of the sensors.",
                                                      noise.channel, two_digits(noise.times()),
                                                      noise.stated > 0.0 ? "is stated" : "its samples show"));
  return box;
}

StudyAnswer what_next(const Diagnosis& d) {
  StudyAnswer box{"What next", {}, {}, 2};
  if (!d.next.is_recommended()) {
    box.lines.emplace_back(Style::lead, "No trial to recommend");
    if (!d.next.why.empty()) box.lines.emplace_back(Style::text, d.next.why);
    if (!d.stopped_in.empty())
      box.lines.emplace_back(Style::quiet, "Not chosen: the limit of time ended the search before.");
    return box;
  }
  box.lines.emplace_back(Style::lead, d.next.order);
  if (d.next.beyond_recorded && d.next.reason().find("beyond the recorded") == std::string::npos)
    box.lines.emplace_back(Style::quiet, "Beyond the recorded set-ups; the campaign states no limit.");
  box.lines.emplace_back(Style::text, d.next.reason());
  return box;
}

}  // namespace

bool is_changed(const Diagnosis& d) { return !nothing_found(d) && d.detail != Detail::data_fault; }

std::vector<StudyAnswer> page_answers(const Diagnosis& d) {
  return {where(d), what(d), how_sure(d), how_much_better(d), what_next(d)};
}

}  // namespace sandhopper::diagnose
