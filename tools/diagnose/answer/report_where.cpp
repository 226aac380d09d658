#include <algorithm>
#include <cmath>

#include "tools/diagnose/answer/report_parts.hpp"

namespace sandhopper::diagnose {
namespace {

using Eigen::Index;

// Finds the coordinate along which the mean residual of ten bins varies most (variance of the bin means /
// total), and the range of the bins whose mean is at least half of the largest.
void place_on_axis(const Problem& problem, const std::vector<Eigen::VectorXd>& residual, std::size_t channel,
                   std::size_t phase, Where& where) {
  constexpr std::size_t kBins = 10;
  double best_ratio = 0.0;
  if (problem.trials.empty()) return;
  for (std::size_t a = 0; a < problem.trials.front()->coordinates.size(); ++a) {
    double low = 1e300, high = -1e300;
    const auto each = [&](auto&& visit) {
      for (std::size_t t = 0; t < problem.trials.size(); ++t) {
        const auto& trial = *problem.trials[t];
        for (std::size_t k = 0; k < trial.rows.size(); ++k)
          if (trial.rows[k].channel == channel && trial.rows[k].phase == phase && problem.used[t][k])
            visit(trial.coordinates[a].values[k], residual[t][static_cast<Index>(k)]);
      }
    };
    each([&](double x, double) {
      low = std::min(low, x);
      high = std::max(high, x);
    });
    if (!(high > low)) continue;
    std::vector<double> sum(kBins, 0.0), count(kBins, 0.0);
    each([&](double x, double r) {
      const auto b = std::min(kBins - 1, static_cast<std::size_t>((x - low) / (high - low) * kBins));
      sum[b] += r;
      ++count[b];
    });
    double total = 0.0, n = 0.0, between = 0.0, largest = 0.0;
    each([&](double, double r) {
      total += r * r;
      ++n;
    });
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
                         std::size_t channel, std::size_t phase, const Diagnosis& diagnosis) {
  if (!diagnosis.unknown.empty()) return diagnosis.unknown.front().port;
  const auto& found = search.best().fit.point.hypothesis.candidates;
  std::vector<double> energy(found.size(), 0.0);
  for (std::size_t t = 0; t < problem.trials.size(); ++t)
    for (std::size_t k = 0; k < problem.trials[t]->rows.size(); ++k) {
      const Row& row = problem.trials[t]->rows[k];
      if (row.channel != channel || row.phase != phase || !problem.used[t][k]) continue;
      for (std::size_t e = 0; e < found.size(); ++e)
        energy[e] += std::pow(residuals.change[t][e][static_cast<Index>(k)], 2);
    }
  const auto most = std::max_element(energy.begin(), energy.end());
  if (most == energy.end() || *most <= 0.0) return "";
  return port_of(problem.candidates[found[static_cast<std::size_t>(most - energy.begin())]]);
}

}  // namespace

// Residual of the null by channel and phase, above the noise floor. The p-value is Student's t over trials.
// Cells with p < 0.05 and more than 3 % of the excess are reported.
void report_where(const Problem& problem, const Search& search, const Residuals& residuals,
                  Diagnosis& diagnosis) {
  if (diagnosis.verdict == Verdict::consistent || is_open(diagnosis.verdict)) return;
  const auto& residual = residuals.before;
  const std::size_t channels = problem.channels.size(), phases = problem.phases.size();
  double whole = 0.0;
  std::vector<Where> found;
  for (std::size_t c = 0; c < channels; ++c)
    for (std::size_t p = 0; p < phases; ++p) {
      if (!problem.context.has(problem.channels[c])) continue;
      Where where;
      where.channel = problem.channels[c];
      where.phase = problem.phases[p];
      std::vector<double> excess;
      double earliest = 1e300, latest = -1e300, total = 0.0;
      for (std::size_t t = 0; t < problem.trials.size(); ++t) {
        const auto& trial = *problem.trials[t];
        double sum = 0.0, count = 0.0;
        for (std::size_t k = 0; k < trial.rows.size(); ++k) {
          const auto& row = trial.rows[k];
          if (row.channel != c || row.phase != p || !problem.used[t][k]) continue;
          const double sd = problem.noise.channel(c).sd_of_phase[p];
          sum += std::pow(residual[t][static_cast<Index>(k)] / sd, 2) - 1.0;
          ++count;
          earliest = std::min(earliest, row.time_s);
          latest = std::max(latest, row.time_s);
        }
        if (count < 3.0) continue;
        excess.push_back(sum / count);
        if (sum > 0.0) {
          where.trials.push_back(trial.name);
          total += sum;
        }
      }
      if (excess.empty() || total <= 0.0) continue;
      double mean = 0.0, square = 0.0;
      for (const double e : excess) mean += e / static_cast<double>(excess.size());
      for (const double e : excess) square += std::pow(e - mean, 2);
      const double n = static_cast<double>(excess.size());
      const double se = std::sqrt((4.0 * 0.02 + square) / (n + 3.0) / n);
      where.p_value = mean > 0.0 ? 0.5 * student_t_two_sided(mean / se, n + 3.0) : 1.0;
      where.from_s = earliest;
      where.to_s = latest;
      where.share_of_excess = total;
      whole += total;
      place_on_axis(problem, residual, c, p, where);
      where.port = port_in_cell(problem, search, residuals, c, p, diagnosis);
      found.push_back(std::move(where));
    }
  for (auto& where : found) where.share_of_excess /= std::max(whole, 1e-300);
  std::sort(found.begin(), found.end(),
            [](const Where& a, const Where& b) { return a.share_of_excess > b.share_of_excess; });
  for (auto& where : found)
    if (where.share_of_excess > 0.03 && where.p_value < 0.05) diagnosis.where.push_back(std::move(where));
}

}  // namespace sandhopper::diagnose
