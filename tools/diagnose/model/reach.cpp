#include "tools/diagnose/model/reach.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "tools/diagnose/model/quantity.hpp"

namespace sandhopper::diagnose {
namespace {

constexpr double kRounding = 1e-6;  // A value this close to the end of a range lies in it; relative.

bool is_between(double value, double low, double high) {
  const double slack = kRounding * std::max(std::abs(low), std::abs(high));
  return value >= low - slack && value <= high + slack;
}

}  // namespace

Reach::Reach(const std::vector<Trial>& recorded, Available available,
             std::map<std::string, std::set<std::string>> words)
    : available_(std::move(available)), words_(std::move(words)) {
  for (const auto& trial : recorded)
    for (const auto& [key, value] : trial.setup) recorded_[key].insert(value);
}

Reach Reach::with_free_numbers() const {
  Reach reach = *this;
  reach.width_ = Width::free_numbers;
  return reach;
}

Reach Reach::with_any_part() const {
  Reach reach = *this;
  reach.width_ = Width::any_part;
  return reach;
}

std::vector<double> Reach::settings(const std::string& key, const std::vector<double>& grid) const {
  double low = 0.0, high = 0.0;
  if (const auto listed = available_.find(key); listed != available_.end()) {
    if (!listed->second.is_range) return listed->second.values;
    low = listed->second.values.front();
    high = listed->second.values.back();
  } else if (has_free_numbers()) {
    return grid;
  } else if (const auto recorded = recorded_.find(key); recorded != recorded_.end()) {
    low = *recorded->second.begin();
    high = *recorded->second.rbegin();
  } else {
    return {};
  }
  std::set<double> values{low, high};
  for (const double value : grid)
    if (value > low && value < high) values.insert(value);
  return {values.begin(), values.end()};
}

std::vector<double> Reach::parts(const std::string& key, const std::vector<double>& grid) const {
  if (has_any_part() || lists(key)) return settings(key, grid);
  const auto recorded = recorded_.find(key);
  if (recorded == recorded_.end()) return {};
  return {recorded->second.begin(), recorded->second.end()};
}

bool Reach::allows(const std::string& key, const std::string& word) const {
  const auto listed = available_.find(key);
  if (listed == available_.end() && has_free_numbers()) return true;
  if (listed != available_.end() && std::ranges::count(listed->second.words, word) > 0) return true;
  const auto recorded = words_.find(key);
  if (recorded != words_.end()) return recorded->second.contains(word);
  return listed == available_.end();
}

bool Reach::allows(const std::string& key, double value) const {
  const auto listed = available_.find(key);
  if (listed == available_.end()) return true;
  const auto& values = listed->second.values;
  if (listed->second.is_range) return is_between(value, values.front(), values.back());
  return std::ranges::any_of(values, [&](double one) { return is_between(value, one, one); });
}

std::string Reach::ranges_left_by(const std::map<std::string, double>& setup) const {
  std::string text;
  for (const auto& [key, value] : setup) {
    const auto recorded = recorded_.find(key);
    if (lists(key) || recorded == recorded_.end() || key == "duration_s") continue;
    const double low = *recorded->second.begin(), high = *recorded->second.rbegin();
    if (is_between(value, low, high)) continue;
    const auto quantity = quantity_of(key);
    text += fmt::format("{}{} {}", text.empty() ? "" : ", ", quantity.words,
                        low == high ? measured(high, quantity.unit)
                                    : number(low) + " to " + number(high) + " " + quantity.unit);
  }
  return text;
}

}  // namespace sandhopper::diagnose
