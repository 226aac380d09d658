#include <algorithm>
#include <array>
#include <cmath>

#include "tools/diagnose/answer/report_parts.hpp"
#include "tools/diagnose/fit/levels.hpp"
#include "tools/diagnose/fit/statistics.hpp"

namespace sandhopper::diagnose {
namespace {

using Eigen::Index;

// Stages of a trial by name, and the stage of every row: the plant's phases, or thirds of the trial's time.
struct Stages {
  std::vector<std::string> names;
  std::vector<std::vector<std::size_t>> of;  // [trial][row]
};

Stages stages_of(const Problem& problem) {
  const bool by_phase = problem.plant->phases_are_stages();
  Stages stages;
  stages.names = by_phase ? problem.phases : std::vector<std::string>{"early", "middle", "late"};
  for (const auto& trial : problem.trials) {
    auto& of = stages.of.emplace_back();
    if (by_phase) {
      for (const Row& row : trial->rows) of.push_back(row.phase);
      continue;
    }
    if (trial->rows.empty()) continue;
    const auto [first, last] = std::ranges::minmax(trial->rows, {}, &Row::time_s);
    for (const Row& row : trial->rows) {
      const double length_s = std::max(last.time_s - first.time_s, 1e-300);
      const double thirds = 3.0 * (row.time_s - first.time_s) / length_s;
      of.push_back(std::min(std::size_t{2}, static_cast<std::size_t>(thirds)));
    }
  }
  return stages;
}

// The difference between belief and recordings that the cells show, and the residual beside it.
struct Gap {
  bool unexplained = false;                   // nothing was found: the error of the simulation as believed
  const std::vector<Eigen::VectorXd>& of;     // [trial]: change by what was found, or that error
  const std::vector<Eigen::VectorXd>& after;  // [trial]: residual with what was found
};

Gap gap_of(const Residuals& residuals) {
  const bool found = std::ranges::any_of(residuals.found, [](const auto& v) { return v.norm() > 0.0; });
  if (found) return {false, residuals.found, residuals.after};
  return {true, residuals.before, residuals.after};
}

// One channel in one stage.
class Cell {
 public:
  Cell(const Problem& problem, const Stages& stages, const Gap& gap, std::size_t channel, std::size_t stage)
      : problem_(problem), stages_(stages), gap_(gap), channel_(channel), stage_(stage) {
    where_.channel = problem.channels[channel];
    where_.phase = stages.names[stage];
    where_.unexplained = gap.unexplained;
    for (std::size_t t = 0; t < problem.trials.size(); ++t) add(t);
  }

  // Calls visit(trial, row) for each row that counts.
  template <class Visit>
  void each_of(std::size_t t, Visit&& visit) const {
    const auto& rows = problem_.trials[t]->rows;
    for (std::size_t k = 0; k < rows.size(); ++k)
      if (rows[k].channel == channel_ && stages_.of[t][k] == stage_ && problem_.used[t][k]) visit(t, k);
  }
  template <class Visit>
  void each(Visit&& visit) const {
    for (std::size_t t = 0; t < problem_.trials.size(); ++t) each_of(t, visit);
  }
  double gap(std::size_t t, std::size_t k) const { return gap_.of[t][static_cast<Index>(k)]; }

  bool is_empty() const { return evidence_.score.empty(); }
  bool exceeds_noise() const { return !where_.trials.empty(); }
  double energy() const { return energy_; }
  double p_value() const { return evidence_.size() > 0.0 ? 0.5 * evidence_.p_value() : 1.0; }
  Where& where() { return where_; }

 private:
  // Scores of one trial. Found: of the size s of the change in this cell, which is 1 if it is true and 0 if
  // not. Unexplained: of the excess variance s, relative to the noise, whose information is n / 2.
  void add(std::size_t t) {
    double own = 0.0, both = 0.0, n = 0.0, first = 1e300, last = -1e300;
    each_of(t, [&](std::size_t, std::size_t k) {
      const Row& row = problem_.trials[t]->rows[k];
      const double sd = problem_.noise.sd(*problem_.trials[t], row);
      const double g = gap(t, k) / sd;
      own += g * g;
      both += g * (g + gap_.after[t][static_cast<Index>(k)] / sd);
      ++n;
      if (std::abs(g) < 1.0) return;
      first = std::min(first, row.time_s);
      last = std::max(last, row.time_s);
    });
    if (n < 1.0) return;
    const double above = gap_.unexplained ? own - n : own;
    evidence_.score.push_back(gap_.unexplained ? 0.5 * above : both);
    evidence_.information.push_back(gap_.unexplained ? 0.5 * n : own);
    energy_ += above;
    if (above < n) return;
    if (where_.trials.empty()) where_.from_s = first, where_.to_s = last;
    where_.from_s = std::min(where_.from_s, first);
    where_.to_s = std::max(where_.to_s, last);
    where_.trials.push_back(problem_.trials[t]->name);
  }

  const Problem& problem_;
  const Stages& stages_;
  const Gap& gap_;
  std::size_t channel_, stage_;
  TrialEvidence evidence_;
  double energy_ = 0.0;  // sum of the squared gap over the noise
  Where where_;
};

// Finds the coordinate along which the mean gap of ten bins varies most (variance of the bin means / total),
// and the range of the bins whose mean is at least half of the largest.
void place_on_axis(const Problem& problem, Cell& cell) {
  constexpr std::size_t kBins = 10;  // of equal width
  double best_ratio = 0.0;
  Where& where = cell.where();
  for (std::size_t a = 0; a < problem.trials.front()->coordinates.size(); ++a) {
    double low = 1e300, high = -1e300;
    const auto value = [&](std::size_t t, std::size_t k) {
      return problem.trials[t]->coordinates[a].values[k];
    };
    cell.each([&](std::size_t t, std::size_t k) {
      low = std::min(low, value(t, k));
      high = std::max(high, value(t, k));
    });
    if (!(high > low)) continue;
    std::array<double, kBins> sum{}, count{};
    double total = 0.0;
    cell.each([&](std::size_t t, std::size_t k) {
      const auto b =
          std::min(kBins - 1, static_cast<std::size_t>((value(t, k) - low) / (high - low) * kBins));
      sum[b] += cell.gap(t, k);
      ++count[b];
      total += std::pow(cell.gap(t, k), 2);
    });
    double between = 0.0, largest = 0.0;
    for (std::size_t b = 0; b < kBins; ++b) {
      if (count[b] < 3.0) continue;
      between += sum[b] * sum[b] / count[b];
      largest = std::max(largest, std::abs(sum[b] / count[b]));
    }
    const double ratio = total > 0.0 ? between / total : 0.0;
    if (ratio <= best_ratio) continue;
    best_ratio = ratio;
    where.coordinate = problem.trials.front()->coordinates[a].name;
    where.range_low = high;
    where.range_high = low;
    for (std::size_t b = 0; b < kBins; ++b)
      if (count[b] >= 3.0 && std::abs(sum[b] / count[b]) >= 0.5 * largest) {
        const double width = (high - low) / kBins;
        where.range_low = std::min(where.range_low, low + width * static_cast<double>(b));
        where.range_high = std::max(where.range_high, low + width * static_cast<double>(b + 1));
      }
  }
}

// Port of the effect that changes this cell most, or of the unknown force if there is one.
std::string port_in_cell(const Problem& problem, const Search& search, const Residuals& residuals,
                         const Cell& cell, const Diagnosis& diagnosis) {
  if (!diagnosis.unknown.empty()) return diagnosis.unknown.front().port;
  const auto& found = search.best().fit.point.hypothesis.candidates;
  std::vector<double> energy(found.size(), 0.0);
  cell.each([&](std::size_t t, std::size_t k) {
    for (std::size_t e = 0; e < found.size(); ++e)
      energy[e] += std::pow(residuals.change[t][e][static_cast<Index>(k)], 2);
  });
  const auto most = std::max_element(energy.begin(), energy.end());
  if (most == energy.end() || *most <= 0.0) return "";
  return port_of(problem.candidates[found[static_cast<std::size_t>(most - energy.begin())]]);
}

}  // namespace

// A cell (channel and stage) is reported if the recordings there change by more than the noise in at least
// one trial, and the trials together show this change; false discovery rate over all cells 5 %. The change is
// that by all that was found, or, if nothing was, the error of the simulation as believed.
void report_where(const Problem& problem, const Search& search, const Residuals& residuals,
                  Diagnosis& diagnosis) {
  if (diagnosis.verdict == Verdict::consistent || is_open(diagnosis.verdict) || problem.trials.empty())
    return;
  const Stages stages = stages_of(problem);
  const Gap gap = gap_of(residuals);
  std::vector<Cell> cells;
  for (std::size_t c = 0; c < problem.channels.size(); ++c)
    for (std::size_t s = 0; s < stages.names.size(); ++s) {
      if (!problem.context.has(problem.channels[c])) continue;
      Cell cell(problem, stages, gap, c, s);
      if (!cell.is_empty()) cells.push_back(std::move(cell));
    }
  double whole = 0.0;
  std::vector<double> p_values;
  for (const Cell& cell : cells) {
    whole += std::max(0.0, cell.energy());
    p_values.push_back(cell.p_value());
  }
  const auto seen = rejected_at_false_discovery_rate(p_values, kLevel);
  for (std::size_t i = 0; i < cells.size(); ++i) {
    if (!seen[i] || !cells[i].exceeds_noise()) continue;
    place_on_axis(problem, cells[i]);
    Where& where = cells[i].where();
    where.port = port_in_cell(problem, search, residuals, cells[i], diagnosis);
    where.p_value = p_values[i];
    where.share_of_excess = cells[i].energy() / whole;
    diagnosis.where.push_back(std::move(where));
  }
  std::ranges::stable_sort(diagnosis.where, std::greater{}, &Where::share_of_excess);
}

}  // namespace sandhopper::diagnose
