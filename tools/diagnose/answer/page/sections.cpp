#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <ranges>

#include "tools/diagnose/answer/diagnosis_text.hpp"
#include "tools/diagnose/answer/page/diagnosis_page.hpp"
#include "tools/diagnose/model/digits.hpp"
#include "tools/diagnose/model/quantity.hpp"
#include "tools/report/unit_text.hpp"

namespace sandhopper::diagnose {
namespace {

// Colour of an error: 0 up to 1.1 times the noise floor, 1 from eleven times it.
double shade(double error_over_floor) {
  return std::clamp(std::log10(std::max(error_over_floor, 1.0) / 1.1), 0.0, 1.0);
}

StudySection errors_section(const Diagnosis& d) {
  std::vector<std::string> channels, phases;
  const auto add = [](std::vector<std::string>& names, const std::string& name) {
    if (std::find(names.begin(), names.end(), name) == names.end()) names.push_back(name);
  };
  for (const auto& fit : d.fits) add(channels, fit.channel);
  for (const auto& e : d.phase_errors) add(phases, e.phase);
  StudyTable table;
  table.columns = {"channel"};
  for (const auto& phase : phases) table.columns.push_back(in_words(phase));
  const bool found = is_changed(d);
  if (found)
    table.columns.insert(table.columns.end(), {"all, before", "all, after", "noise floor"});
  else
    table.columns.insert(table.columns.end(), {"all phases", "noise floor"});
  for (const auto& channel : channels) {
    std::vector<std::string> row{channel};
    std::vector<std::pair<double, double>> shades{{0.0, 0.0}};
    for (const auto& phase : phases) {
      const auto cell = std::find_if(d.phase_errors.begin(), d.phase_errors.end(), [&](const PhaseError& e) {
        return e.channel == channel && e.phase == phase;
      });
      if (cell == d.phase_errors.end()) {
        row.emplace_back("");
        shades.emplace_back(0.0, 0.0);
        continue;
      }
      const double before = cell->before / cell->floor, after = cell->after / cell->floor;
      row.push_back(found ? fmt::format("{:.2f} → {:.2f}", before, after) : fmt::format("{:.2f}", before));
      shades.emplace_back(shade(before), shade(found ? after : before));
    }
    const auto fit =
        std::find_if(d.fits.begin(), d.fits.end(), [&](const ChannelFit& f) { return f.channel == channel; });
    const auto unit = quantity_of(channel).unit;
    std::vector<double> values{fit->heldout.before};
    if (found) values.push_back(fit->heldout.after);
    values.push_back(fit->floor);
    for (const double value : values) {
      row.push_back(plain_number(value, 3) + " " + unit);
      shades.emplace_back(0.0, 0.0);
    }
    table.rows.push_back(std::move(row));
    table.shades.push_back(std::move(shades));
  }
  table.note =
      found ? "Held-out error as a multiple of the noise floor of its channel and phase, before → after what "
              "was "
              "found is added. 1.00: as large as the noise floor; the stronger the colour, the "
              "more is missing."
            : "Held-out error as a multiple of the noise floor of its channel and phase. 1.00: as large as "
              "the noise floor; the stronger the colour, the more is missing.";
  if (const auto below = below_the_floor(d); !below.empty()) table.note += " " + below;
  return {found ? "Before and after, by channel and phase" : "Error by channel and phase", {table}};
}

StudySection noise_section(const Diagnosis& d) {
  StudyTable table;
  table.columns = {"channel",         "source of the stated noise", "what it means",
                   "stated",          "from sample to sample",      "used by the fit",
                   "used over stated"};
  table.text_columns = 3;
  table.whole = true;
  const auto size = [](const SensorNoise& n, double sd) {
    return sd > 0.0 ? plain_number(sd, 3) + " " + quantity_of(n.channel).unit : "–";
  };
  for (const auto& n : d.noise) {
    table.rows.push_back({n.channel, n.source.empty() ? "nobody" : n.source,
                          n.is_raised ? "raised, see below" : "as the sensor's own", size(n, n.stated),
                          size(n, n.measured), size(n, n.used),
                          n.stated > 0.0 ? fmt::format("{:.2f}", n.times()) : "–"});
    table.row_marks.emplace_back(n.is_raised ? "partly" : "");
  }
  table.note =
      "Noise: standard deviation of one sample. From sample to sample: what changes at once, which only a "
      "sensor does. Used by the fit: what the recordings differ by from the best simulation, without model "
      "error. The noise floor that errors are compared with holds this noise, the uncertainty of recorded "
      "inputs (a depth, a time) and the model error.";
  // Beside the table: a column of sentences would be squeezed on a small screen.
  StudySection section{"Noise of the sensors", {table}};
  for (const auto& n : d.noise)
    if (n.is_raised) section.items.emplace_back(fmt::format("Noise of {}: {}", n.channel, n.in_words()));
  return section;
}

// A share in per cent: "84", "< 1", "> 99".
std::string in_percent(double share) {
  if (share > 0.995 && share < 1.0) return ">\u00a099";
  return share > 0.0 && share < 0.005 ? "<\u00a01" : fmt::format("{:.0f}", 100.0 * share);
}

std::string name_of(const FoundEffect& e) { return e.id + (e.channel.empty() ? "" : "\n" + e.channel); }

std::string mark_of(const FoundEffect& e) {
  return e.probability >= 0.8 && !e.may_be_zero() ? "good" : "partly";
}

// The parameters of all effects; they stand apart, so that the sentences of the effects have room.
StudyTable sizes_table(const Diagnosis& d) {
  StudyTable table;
  table.title = "Their sizes";
  table.columns = {"effect", "parameter", "value", "95 % interval", "remark"};
  table.text_columns = 2;
  table.whole = true;
  bool remarks = false;
  for (const auto& e : d.effects)
    for (const auto& p : e.parameters) {
      const double half = 0.5 * std::abs(p.high - p.low);
      table.rows.push_back({&p == &e.parameters.front() ? name_of(e) : "", quantity_of(p.name).label(),
                            to_digits_of(p.value, half),
                            fmt::format("{} to {}", to_digits_of(p.low, half), to_digits_of(p.high, half)),
                            p.limit_in_words()});
      table.row_marks.push_back(mark_of(e));
      remarks = remarks || p.limit;
    }
  if (!remarks) {
    table.columns.pop_back();
    for (auto& row : table.rows) row.pop_back();
  }
  return table;
}

StudySection effects_section(const Diagnosis& d) {
  StudyTable table;
  table.columns = {
      "effect", "what it says", "equation", "probability", "share of the gain, %", "times the typical size",
      "p"};
  table.text_columns = 3;
  table.whole = true;
  for (const auto& e : d.effects) {
    table.rows.push_back({name_of(e), e.statement, e.equation, fmt::format("{:.2f}", e.probability),
                          in_percent(e.heldout_gain), e.typicals > 0.0 ? plain_number(e.typicals, 2) : "",
                          e.p_value < 1.0 ? probability_text(e.p_value) : ""});
    table.row_marks.push_back(mark_of(e));
  }
  table.note =
      "Equation: += adds to the force, torque or reading that the belief gives. Probability: the chance that "
      "this effect is what is missing. Share of the gain: the part of the whole gain in held-out error that "
      "is lost if this effect alone is left out; effects that can stand for one another have small shares. "
      "Typical size: a size at which the effect would matter on this rig. p: the chance to see such a gain "
      "if nothing were missing.";
  StudyTable sizes = sizes_table(d);
  StudySection section{"What was found", {table}};
  if (!sizes.rows.empty()) section.items.emplace_back(std::move(sizes));
  for (const auto& e : d.effects)
    if (e.may_be_zero())
      section.items.emplace_back(
          fmt::format("{} is suspected, not found: its 95 % interval contains zero.", e.id));
  for (const auto& e : d.effects)
    if (!e.indistinguishable_from.empty()) {
      std::string others;
      for (const auto& other : e.indistinguishable_from) others += (others.empty() ? "" : ", ") + other;
      section.items.emplace_back(fmt::format("{} or {}{}: they explain these recordings equally well.", e.id,
                                             e.indistinguishable_from.size() > 1 ? "one of " : "", others));
    }
  return section;
}

StudySection unknown_section(const Diagnosis& d) {
  StudySection section{"The unlisted force", {}};
  for (const auto& u : d.unknown) {
    StudySeries band{"estimate with 95 % band", u.curve.at, u.curve.value, {}, {},
                     StudySeries::Mark::band,   "purple"};
    for (std::size_t i = 0; i < u.curve.value.size(); ++i) {
      band.low.push_back(u.curve.value[i] - 1.96 * u.curve.sd[i]);
      band.high.push_back(u.curve.value[i] + 1.96 * u.curve.sd[i]);
    }
    const auto q = quantity_of(u.curve.variable);
    StudyFigure figure{"What acts at " + u.port, q.label(), quantity_of(u.quantity).label(), {band}};
    figure.note =
        "The line is the estimate, the band its 95 % interval. Drawn where there are recordings; straight "
        "between the points at which it is estimated.";
    section.items.emplace_back(figure);
  }
  return section;
}

StudySection where_section(const Diagnosis& d) {
  StudyTable table;
  table.columns = {"channel", "phase", "port", "axis", "from", "to", "share of the change, %", "p", "trials"};
  table.text_columns = 4;
  // A hopper has up to 84 cells; the first ones have the largest shares.
  constexpr std::size_t kMostRows = 15;
  for (const auto& w : d.where | std::views::take(kMostRows))
    table.rows.push_back({w.channel, w.phase_in_words(), w.port, quantity_of(w.coordinate).label(),
                          to_digits_of(w.range_low, w.range_high - w.range_low),
                          to_digits_of(w.range_high, w.range_high - w.range_low),
                          in_percent(w.share_of_excess), probability_text(w.p_value),
                          fmt::format("{}", w.trials.size())});
  table.note =
      "Channels and phases (or thirds of a trial) in which what was found changes the recordings by more "
      "than "
      "their noise in at least one trial; if nothing was named, in which the simulation as believed errs by "
      "more. At most one in twenty is there by chance. Share: of the squared change, relative to the noise, "
      "over all channels and phases. The axis is the quantity along which the change is least even, with the "
      "range of its larger values. Trials: in how many the change is above the noise.";
  if (d.where.size() > kMostRows)
    table.note += fmt::format(" The {} smaller ones are in diagnosis.json.", d.where.size() - kMostRows);
  return {"Where it shows", {table}};
}

StudySection absent_section(const Diagnosis& d) {
  StudyTable table;
  table.columns = {"effect", "parameter", "magnitude", "largest size, times the typical one"};
  table.text_columns = 2;
  for (const auto& b : d.absent)
    table.rows.push_back({b.id, quantity_of(b.parameter).label(),
                          (b.is_lower ? "above " : "below ") + plain_number(b.value, 2),
                          plain_number(b.typicals, 2)});
  table.note =
      "Bounds of what was looked for and not found: the largest size that each may have beside what was "
      "found, "
      "or in its place, so they are wider than the errors of the belief that would show; a stiffness or a "
      "limit "
      "is "
      "bounded from below. All of them hold "
      "together with 95 % confidence. A bound above 1 typical size is wide: an effect of the usual size "
      "could hide below it.";
  return {"What is absent", {table}};
}

StudySection belief_section(const Diagnosis& d) {
  StudyTable table;
  table.columns = {"number", "source", "value", "unit", "usual error", "error that would show", "matters"};
  table.text_columns = 2;
  for (const auto& n : d.belief) {
    auto value = n.low == n.high ? number(n.low) : fmt::format("{} to {}", number(n.low), number(n.high));
    if (n.known_sd > 0.0)
      value += fmt::format(" (known to {}; beside what was found the recordings ask for {})",
                           number(n.known_sd), signed_number(n.asked_for, 2));
    table.rows.push_back({n.key, n.source, value, with_powers(n.unit), number(n.usual_error),
                          n.error_that_shows == 0.0           ? std::string("not looked at")
                          : std::isfinite(n.error_that_shows) ? plain_number(n.error_that_shows, 2)
                                                              : std::string("none"),
                          n.error_that_shows > 0.0 && n.matters() ? "yes" : ""});
  }
  table.note =
      "Every number that the answer uses. Usual error: half a unit of the last digit that was written, "
      "or the "
      "whole of a default that nobody stated. Beyond the error that would show, the recordings contradict "
      "the number "
      "(95 %), with what differs from trial to trial fitted along. A number matters where its usual error is "
      "larger: "
      "then the answer depends on how well it is known.";
  return {"What was believed", {table}};
}

StudySection remarks_section(const Diagnosis& d, const PageFacts& facts) {
  StudyTable table;
  table.columns = {"remark"};
  table.whole = true;
  for (const auto& finding : facts.findings) table.rows.push_back({finding});
  for (const auto& note : d.notes) table.rows.push_back({note});
  return {"Recordings: what is broken, missing, and what that rules out", {table}};
}

StudySection log_section(const Diagnosis& d) {
  StudyTable table;
  table.columns = {"step of the search"};
  for (const auto& line : d.log) table.rows.push_back({line});
  table.note =
      "For readers who want to follow the search. Deviance: squared residuals over their variances; a gain "
      "of 10 is a difference that noise hardly makes. Criterion: deviance with a price for each parameter; "
      "the set with the least wins, if its effects are needed. Linear: by the derivative, before a fit.";
  StudySection section{"What was tried", {table}};
  section.folded = true;
  return section;
}

}  // namespace

std::vector<StudySection> page_sections(const Diagnosis& d, const PageFacts& facts) {
  std::vector<StudySection> sections;
  std::vector<std::string> trials;
  for (const auto& trace : d.traces)
    if (std::find(trials.begin(), trials.end(), trace.trial) == trials.end()) trials.push_back(trace.trial);
  if (!trials.empty()) sections.push_back(trial_section(d, trials.front()));
  if (!d.phase_errors.empty()) sections.push_back(errors_section(d));
  if (!d.effects.empty()) sections.push_back(effects_section(d));
  if (!d.noise.empty()) sections.push_back(noise_section(d));
  if (!d.unknown.empty()) sections.push_back(unknown_section(d));
  if (!d.where.empty()) sections.push_back(where_section(d));
  if (!d.trial_to_trial.empty()) sections.push_back(trial_to_trial_section(d));
  if (!d.next.time_s.empty()) sections.push_back(next_trial_section(d));
  if (!d.absent.empty()) sections.push_back(absent_section(d));
  if (!d.belief.empty()) sections.push_back(belief_section(d));
  if (!facts.findings.empty() || !d.notes.empty()) sections.push_back(remarks_section(d, facts));
  for (std::size_t i = 1; i < trials.size(); ++i) {
    sections.push_back(trial_section(d, trials[i]));
    sections.back().folded = true;
  }
  if (!d.log.empty()) sections.push_back(log_section(d));
  return sections;
}

}  // namespace sandhopper::diagnose
