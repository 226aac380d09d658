#include "tools/diagnose/model/reach.hpp"

#include <algorithm>
#include <utility>

namespace sandhopper::diagnose {

Reach Reach::anything() {
  Reach reach;
  reach.anything_ = true;
  return reach;
}

Reach::Reach(const std::vector<Trial>& recorded, Available available,
             std::map<std::string, std::set<std::string>> words)
    : available_(std::move(available)), words_(std::move(words)) {
  for (const auto& trial : recorded)
    for (const auto& [key, value] : trial.setup) recorded_[key].insert(value);
}

std::vector<double> Reach::settings(const std::string& key, const std::vector<double>& grid) const {
  if (anything_) return grid;
  double low = 0.0, high = 0.0;
  if (const auto listed = available_.find(key); listed != available_.end()) {
    if (!listed->second.is_range) return listed->second.values;
    low = listed->second.values.front();
    high = listed->second.values.back();
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
  if (anything_ || available_.contains(key)) return settings(key, grid);
  const auto recorded = recorded_.find(key);
  if (recorded == recorded_.end()) return {};
  return {recorded->second.begin(), recorded->second.end()};
}

bool Reach::allows(const std::string& key, const std::string& word) const {
  if (anything_) return true;
  const auto listed = available_.find(key);
  if (listed != available_.end() && std::ranges::count(listed->second.words, word) > 0) return true;
  const auto recorded = words_.find(key);
  if (recorded != words_.end()) return recorded->second.contains(word);
  return listed == available_.end();
}

}  // namespace sandhopper::diagnose
