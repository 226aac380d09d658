#pragma once
#include <string>
#include <string_view>
#include <vector>

namespace sandhopper {

// A running cycle as its operator has it: words in (arm, release, stop, disarm, quit), lines of JSON out
// (firmware/operator_text.hpp), whichever board it runs on.
class CycleLink {
 public:
  virtual ~CycleLink() = default;
  virtual void send(std::string_view word) = 0;
  // Can be read, as poll(2) has it, when there are lines to take or it has ended.
  virtual int descriptor() const = 0;
  // Adds what was said since; false: it has ended, and that was all. Does not wait.
  virtual bool take(std::vector<std::string>& lines) = 0;
};

}  // namespace sandhopper
