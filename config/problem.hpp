#pragma once
#include <stdexcept>
#include <string>
#include <vector>

#include "config/node.hpp"

namespace sandhopper {

// One thing wrong with a configuration. Line 0: the file as a whole.
struct ConfigProblem {
  std::string file;
  ConfigPosition position;
  std::string key;       // full path, "motor[1].can_id"; empty for the file as a whole
  std::string text;      // what is wrong, what was expected, what was found, and the cure
  bool missing = false;  // a key that is not there
};

// "file:line:column: text"
std::string to_string(const ConfigProblem& problem);

// Everything that is wrong, in the order of the file; what() has one line each.
class ConfigError : public std::runtime_error {
 public:
  explicit ConfigError(const std::vector<ConfigProblem>& problems);
  const std::vector<ConfigProblem>& problems() const noexcept { return problems_; }

 private:
  std::vector<ConfigProblem> problems_;
};

}  // namespace sandhopper
