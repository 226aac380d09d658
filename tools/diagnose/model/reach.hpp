#pragma once
#include <cstdint>
#include <map>
#include <set>
#include <string>
#include <vector>

#include "tools/campaign/available.hpp"
#include "tools/diagnose/model/trial.hpp"

namespace sandhopper::diagnose {

// Set-ups that the lab can make: what the campaign lists under [available], and what it has recorded. What
// [available] lists for a key always holds. The wider reaches differ only in the keys that it does not list.
class Reach {
 public:
  // `words`: recorded set-up values that are words, by key.
  Reach(const std::vector<Trial>& recorded, Available available,
        std::map<std::string, std::set<std::string>> words);
  // The same with any number and word that a lab chooses freely, e.g. a release height or a profile.
  Reach with_free_numbers() const;
  // The same with any part, too, e.g. a plate, a weight or a drive.
  Reach with_any_part() const;

  bool has_free_numbers() const { return width_ >= Width::free_numbers; }
  bool has_any_part() const { return width_ == Width::any_part; }
  bool lists(const std::string& key) const { return available_.contains(key); }
  bool knows(const std::string& key) const { return lists(key) || recorded_.contains(key); }

  // Values of a continuous key: those of `grid` within the reachable range, and the ends of that range. If
  // the campaign lists single values, exactly these. Empty if the key is neither listed nor recorded, unless
  // numbers are free: then `grid`.
  std::vector<double> settings(const std::string& key, const std::vector<double>& grid) const;
  // Values of a key that stands for a physical part, e.g. a plate or a weight: only listed or recorded ones,
  // unless any part is in reach.
  std::vector<double> parts(const std::string& key, const std::vector<double>& grid) const;
  // True if the set-up value `word` is reachable, or if the key is neither listed nor recorded.
  bool allows(const std::string& key, const std::string& word) const;
  // False if the campaign lists this key without this value.
  bool allows(const std::string& key, double value) const;
  // Recorded ranges that this set-up leaves: "release height 0.05 to 0.12 m". Empty: it leaves none. Keys
  // that the campaign lists do not count.
  std::string ranges_left_by(const std::map<std::string, double>& setup) const;

 private:
  enum class Width : std::uint8_t { recorded, free_numbers, any_part };

  Width width_ = Width::recorded;
  Available available_;
  std::map<std::string, std::set<double>> recorded_;
  std::map<std::string, std::set<std::string>> words_;
};

}  // namespace sandhopper::diagnose
