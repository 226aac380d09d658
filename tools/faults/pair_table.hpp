#pragma once
#include <map>
#include <string>
#include <vector>

#include "tools/faults/run_pair.hpp"

namespace sandhopper::faults {

// Counts pairs and their ends by the first fault and the class of the second.
class PairTable {
 public:
  struct Count {
    int pairs = 0;
    int hidden = 0;  // the second cannot be seen beside the first
    int wrong = 0;
  };

  void add(const Pair& pair, const PairResult& result);

  const Count& total() const { return total_; }
  // By the first fault, then by the second's class.
  const std::map<std::string, std::map<std::string, Count>>& rows() const { return rows_; }
  // Columns of equal width; a wrong count is marked.
  std::vector<std::string> lines() const;

 private:
  std::map<std::string, std::map<std::string, Count>> rows_;
  Count total_;
};

}  // namespace sandhopper::faults
