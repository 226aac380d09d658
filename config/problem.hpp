#pragma once
#include <stdexcept>
#include <string>
#include <vector>

#include "config/node.hpp"

namespace sandhopper {

// One error in a configuration. Line 0 means the file as a whole.
struct ConfigProblem {
  std::string file;
  ConfigPosition position;
  std::string key;       // full path, "motor[1].can_id"; empty for the file as a whole
  std::string text;      // the error, the expected and the actual value, and the cure
  bool missing = false;  // true if the key is missing
};

// "file:line:column: text"
std::string to_string(const ConfigProblem& problem);

// All errors in the order of the file; what() has one line for each.
class ConfigError : public std::runtime_error {
 public:
  explicit ConfigError(const std::vector<ConfigProblem>& problems);
  const std::vector<ConfigProblem>& problems() const noexcept { return problems_; }

 private:
  std::vector<ConfigProblem> problems_;
};

}  // namespace sandhopper
