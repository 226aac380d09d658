#pragma once
#include <map>
#include <set>
#include <string>
#include <vector>

#include "tools/campaign/available.hpp"
#include "tools/diagnose/model/trial.hpp"

namespace sandhopper::diagnose {

// Set-ups that the lab can make: what the campaign lists under [available], and what it has recorded.
class Reach {
 public:
  // Every set-up that a plant can plan, without regard to what the lab has.
  static Reach anything();
  // `words`: recorded set-up values that are words, by key.
  Reach(const std::vector<Trial>& recorded, Available available,
        std::map<std::string, std::set<std::string>> words);

  bool is_anything() const { return anything_; }
  // Values of a continuous key: those of `grid` within the reachable range, and the ends of that range. If
  // the campaign lists single values, exactly these. Empty if the key is neither listed nor recorded.
  std::vector<double> settings(const std::string& key, const std::vector<double>& grid) const;
  // Values of a key that stands for a physical part, e.g. a plate or a weight: only listed or recorded ones.
  std::vector<double> parts(const std::string& key, const std::vector<double>& grid) const;
  // True if the set-up value `word` is reachable, or if the key is neither listed nor recorded.
  bool allows(const std::string& key, const std::string& word) const;

 private:
  Reach() = default;

  bool anything_ = false;
  Available available_;
  std::map<std::string, std::set<double>> recorded_;
  std::map<std::string, std::set<std::string>> words_;
};

}  // namespace sandhopper::diagnose
