#include <algorithm>
#include <cmath>
#include <limits>

#include "tools/diagnose/answer/report_parts.hpp"
#include "tools/diagnose/fit/levels.hpp"
#include "tools/diagnose/fit/linearise.hpp"
#include "tools/diagnose/fit/statistics.hpp"

namespace sandhopper::diagnose {
namespace {

constexpr double kShareMoved = 0.01;  // Relative change of a number for its derivative.
// Number of trials used if the simulation is costly.
constexpr std::size_t kTrialsOfCostly = 8;

Edits with_number(Edits edits, const std::string& key) {
  const auto simulated = simulated_key(key);
  edits.scale(simulated, simulated == key ? 1.0 + kShareMoved : 1.0 / (1.0 + kShareMoved));
  return edits;
}

// A tolerance on a number, by its key, in the number's unit.
void take_known_to(const Problem& problem, const Point& answer, BelievedNumber& number) {
  for (std::size_t i = 0; i < problem.tolerances.size(); ++i) {
    const Tolerance& tolerance = problem.tolerances[i];
    const bool is_of_it = std::ranges::any_of(problem.context.belief.known_to, [&](const KeySpread& known) {
      return known.key == number.key && known.name == tolerance.name;
    });
    if (!tolerance.is_stated || !is_of_it) continue;
    number.known_sd = tolerance.scale * (tolerance.is_relative ? number.size() : 1.0);
    number.asked_for = answer.tolerances[i] * number.known_sd;
  }
}

}  // namespace

// g_i(r): whitened derivative of trial i by the relative change of a number, with the nuisances integrated
// out. The recordings determine the number with relative standard deviation 1 / sqrt(sum_i |g_i|^2).
void report_belief(const Problem& problem, const Point& answer, Diagnosis& diagnosis) {
  std::vector<Direction> directions;
  std::vector<BelievedNumber*> numbers;
  const Edits edits = edits_for(problem, answer.hypothesis, answer.tolerances);
  for (auto& number : diagnosis.belief) {
    number.error_that_shows = std::numeric_limits<double>::infinity();
    take_known_to(problem, answer, number);
    const bool simulated = !number.key.starts_with("sensors.") && !states_uncertainty(number.key);
    if (!simulated || number.size() == 0.0) continue;
    directions.push_back({with_number(edits, number.key), kShareMoved});
    numbers.push_back(&number);
  }
  if (directions.empty() || problem.trials.empty()) return;
  LineariseOptions options;
  if (problem.plant->is_costly())
    options.every = std::max<std::size_t>(1, problem.trials.size() / kTrialsOfCostly);
  const auto trials = linearise_all(problem, answer, directions, options);
  std::size_t looked_at = 0;
  std::vector<double> information(numbers.size(), 0.0);
  for (const auto& trial : trials) {
    if (trial.gram.rows() <= static_cast<Eigen::Index>(numbers.size())) continue;
    ++looked_at;
    for (std::size_t k = 0; k < numbers.size(); ++k) {
      const auto i = static_cast<Eigen::Index>(k) + 1;
      information[k] += trial.gram(i, i);
    }
  }
  const double share =
      looked_at == 0 ? 1.0 : static_cast<double>(problem.trials.size()) / static_cast<double>(looked_at);
  for (std::size_t k = 0; k < numbers.size(); ++k)
    if (information[k] > 0.0)
      numbers[k]->error_that_shows =
          normal_quantile(kLevel) / std::sqrt(share * information[k]) * numbers[k]->size();
}

}  // namespace sandhopper::diagnose
