#include <fmt/format.h>

#include "tools/diagnose/answer/page/diagnosis_page.hpp"
#include "tools/diagnose/model/quantity.hpp"

namespace sandhopper::diagnose {
namespace {

using Mark = StudySeries::Mark;

StudyFigure recorded_and_simulated(const Trace& trace, bool found) {
  const auto q = quantity_of(trace.channel);
  StudyFigure figure{q.words, "time, s", q.label(), {}};
  figure.note = found ? "This trial was not used for the fit: the sizes come from the other trials."
                      : "Recorded samples and the simulation as believed.";
  figure.series.push_back({"recorded", trace.time_s, trace.measured, {}, {}, Mark::points, "grey"});
  figure.series.push_back({.label = found ? "simulation before" : "simulation",
                           .x = trace.time_s,
                           .y = trace.before,
                           .mark = Mark::line,
                           .color = "orange",
                           .dashed = found});
  if (found)
    figure.series.push_back({"simulation after", trace.time_s, trace.after, {}, {}, Mark::line, "blue"});
  return figure;
}

std::vector<double> difference(const std::vector<double>& a, const std::vector<double>& b) {
  std::vector<double> out(a.size());
  for (std::size_t i = 0; i < a.size(); ++i) out[i] = a[i] - b[i];
  return out;
}

// Band of two standard deviations around 0.
StudySeries noise_band(const std::string& label, const std::vector<double>& time_s,
                       const std::vector<double>& sds) {
  StudySeries band{label + ", ± 2 sd", time_s, {}, {}, {}, Mark::band, "grey"};
  for (const double sd : sds) {
    band.y.push_back(0.0);
    band.low.push_back(-2.0 * sd);
    band.high.push_back(2.0 * sd);
  }
  return band;
}

StudyFigure recorded_less_simulated(const Trace& trace, bool found) {
  const auto q = quantity_of(trace.channel);
  StudyFigure figure{q.words + ", recorded less simulated", "time, s", q.label(), {}};
  figure.note = "Points in the band differ by no more than noise, uncertain inputs and model error allow.";
  figure.series.push_back(noise_band("noise floor", trace.time_s, trace.floor));
  figure.series.push_back({found ? "before" : "recorded less simulated",
                           trace.time_s,
                           difference(trace.measured, trace.before),
                           {},
                           {},
                           Mark::points,
                           "orange"});
  if (found)
    figure.series.push_back(
        {"after", trace.time_s, difference(trace.measured, trace.after), {}, {}, Mark::points, "blue"});
  return figure;
}

}  // namespace

StudySection trial_section(const Diagnosis& d, const std::string& trial) {
  const bool found = is_changed(d);
  StudySection section{"Trial " + trial + ": recorded and simulated", {}};
  for (const auto& fit : d.fits)  // largest error first
    for (const auto& trace : d.traces) {
      if (trace.trial != trial || trace.channel != fit.channel) continue;
      if (section.items.empty())
        section.items.emplace_back(fmt::format("{}. {}", trace.setup,
                                               found ? "After: what was found is added with the sizes that "
                                                       "the other trials give; this one was held out."
                                                     : "The simulation is the one believed."));
      section.items.emplace_back(recorded_and_simulated(trace, found));
      section.items.emplace_back(recorded_less_simulated(trace, found));
    }
  return section;
}

StudySection next_trial_section(const Diagnosis& d) {
  const auto& next = d.next;
  const auto q = quantity_of(next.channel);
  StudySection section{"The next trial", {next.why}};
  StudyFigure both{"What it would record: " + q.words, "time, s", q.label(), {}};
  both.series.push_back({next.first, next.time_s, next.by_first, {}, {}, Mark::line, "blue"});
  both.series.push_back({.label = next.second,
                         .x = next.time_s,
                         .y = next.by_second,
                         .mark = Mark::line,
                         .color = "orange",
                         .dashed = true});
  StudyFigure apart{"Difference of the two: " + q.words, "time, s", q.label(), {}};
  apart.series.push_back(
      noise_band("noise", next.time_s, std::vector<double>(next.time_s.size(), next.noise)));
  apart.series.push_back({next.second + " less " + next.first,
                          next.time_s,
                          difference(next.by_second, next.by_first),
                          {},
                          {},
                          Mark::line,
                          "purple"});
  section.items.emplace_back(both);
  section.items.emplace_back(apart);
  return section;
}

}  // namespace sandhopper::diagnose
