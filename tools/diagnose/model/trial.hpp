#pragma once
#include <cmath>
#include <map>
#include <string>
#include <vector>

namespace sandhopper::diagnose {

// One recorded trial: rows in time, channels under the names of the recording. NaN: no sample in that row.
// Times count from the first row, or for falling bodies from the common start of all trials.
struct Trial {
  std::string name;  // for the reader of the answer only
  std::string kind;
  std::map<std::string, double> setup;
  std::vector<double> time_s;
  std::map<std::string, std::vector<double>> channels;

  const std::vector<double>* find(const std::string& channel) const {
    const auto it = channels.find(channel);
    return it == channels.end() ? nullptr : &it->second;
  }
  double setup_or(const std::string& key, double otherwise) const {
    const auto it = setup.find(key);
    return it == setup.end() ? otherwise : it->second;
  }
};

}  // namespace sandhopper::diagnose
