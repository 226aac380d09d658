#pragma once
#include <map>
#include <string>
#include <vector>

#include "tools/faults/run_pair.hpp"

namespace sandhopper::faults {

// Counts pairs and wrong results by the first fault and the class of the second.
class PairTable {
 public:
  struct Count {
    int pairs = 0;
    int hidden = 0;  // pairs in which one fault keeps the other from being seen
    int wrong = 0;
  };

  void add(const Pair& pair, const PairResult& result);

  const Count& total() const { return total_; }
  // Key: first fault; inner key: class of the second.
  const std::map<std::string, std::map<std::string, Count>>& rows() const { return rows_; }
  // The table as text in columns of equal width; a count with wrong pairs is marked.
  std::vector<std::string> lines() const;

 private:
  std::map<std::string, std::map<std::string, Count>> rows_;
  Count total_;
};

}  // namespace sandhopper::faults
