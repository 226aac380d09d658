#include "tools/benchmark/localisation.hpp"

#include <algorithm>
#include <iterator>

namespace sandhopper::benchmark {
namespace {

std::optional<double> share(std::size_t count, std::size_t of) {
  return of ? std::optional(static_cast<double>(count) / static_cast<double>(of)) : std::nullopt;
}

nlohmann::ordered_json or_null(const std::optional<double>& value) {
  return value ? nlohmann::ordered_json(*value) : nlohmann::ordered_json();
}

}  // namespace

std::optional<double> Localisation::precision() const {
  return share(true_positives, true_positives + false_positives);
}

std::optional<double> Localisation::recall() const { return share(true_positives, true_positives + missed); }

std::optional<double> Localisation::f1() const {
  return share(2 * true_positives, 2 * true_positives + false_positives + missed);
}

Localisation& Localisation::operator+=(const Localisation& other) {
  campaigns += other.campaigns;
  true_positives += other.true_positives;
  false_positives += other.false_positives;
  missed += other.missed;
  return *this;
}

std::optional<Localisation> localise(const Truth& truth, const Diagnosis& diagnosis) {
  const auto hidden = truth.cells();
  if (!diagnosis.says_missing() || hidden.empty()) return std::nullopt;
  const auto& reported = diagnosis.where;
  std::vector<Cell> both;
  std::set_intersection(reported.begin(), reported.end(), hidden.begin(), hidden.end(),
                        std::back_inserter(both));
  return Localisation{1, both.size(), reported.size() - both.size(), hidden.size() - both.size()};
}

nlohmann::ordered_json to_json(const Localisation& l) {
  return {{"campaigns", l.campaigns},
          {"true_positives", l.true_positives},
          {"false_positives", l.false_positives},
          {"missed", l.missed},
          {"precision", or_null(l.precision())},
          {"recall", or_null(l.recall())},
          {"f1", or_null(l.f1())}};
}

}  // namespace sandhopper::benchmark
