#pragma once
#include <nlohmann/json.hpp>

#include "tools/benchmark/interval.hpp"
#include "tools/benchmark/judge.hpp"

namespace sandhopper::benchmark {

// One row of the table of targets: a fraction and the limit that it must keep
// (tools/docs/guide/benchmark.md).
struct Figure {
  std::string name;
  std::size_t count = 0, of = 0;
  double must = 0.0, aim = 0.0;
  // `must`: limit that is checked. `aim`: limit of a good result.
  bool less_is_better = false;

  double value() const { return of ? static_cast<double>(count) / static_cast<double>(of) : 0.0; }
  bool met() const { return of > 0 && (less_is_better ? value() <= must : value() >= must); }
};

// Claims with a stated probability between `from` and `to`, and how many of them are right.
struct Bin {
  double from, to;
  std::size_t count = 0, right = 0;
  double probability_sum = 0.0;
};

// Results of the single-effect cases with sizes between `from` and `to`.
struct LadderStep {
  double from, to;  // size relative to typical
  std::size_t cases = 0, noticed = 0, right = 0, confident_wrong = 0;
};

// Outcomes of the cases that hid one effect: a row of the table by effect.
struct Fate {
  std::size_t cases = 0, right_alone = 0, right_in_class = 0, unknown = 0, nothing = 0, too_little = 0,
              no_answer = 0;
  std::map<std::string, std::size_t> other_names;
};

// All results over one set of cases.
struct Score {
  std::vector<Figure> figures;
  double mean_class_size = 0.0;  // class size of the right answers at typical size
  std::vector<Bin> reliability;
  double expected_calibration_error = 0.0;
  std::size_t names_claimed = 0;
  std::vector<LadderStep> ladder;
  std::map<std::string, Fate> by_effect;
  std::map<std::string, Figure> right_by_plant;
  std::size_t intervals_without_counterpart = 0;
  Localisation localisation;
  std::map<std::string, Localisation> localisation_by_plant;
  std::vector<Judged> cases;
};

// Sizes counted as typical: within a factor of two.
constexpr double kTypicalFrom = 0.5, kTypicalTo = 2.0;

// Counts all figures over the judged cases.
Score score(std::vector<Judged> cases);
nlohmann::ordered_json to_json(const Figure& figure);
nlohmann::ordered_json to_json(const Score& score);

}  // namespace sandhopper::benchmark
