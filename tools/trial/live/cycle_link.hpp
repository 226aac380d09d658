#pragma once
#include <string>
#include <string_view>
#include <vector>

namespace sandhopper {

// Operator's connection to a running cycle on any board: words in (arm, release, stop, disarm, quit), lines
// of JSON out (firmware/operator_text.hpp).
class CycleLink {
 public:
  virtual ~CycleLink() = default;
  virtual void send(std::string_view word) = 0;
  // Readable for poll(2) when there are lines to take or the cycle has ended.
  virtual int descriptor() const = 0;
  // Appends the new lines without waiting. False if it has ended and there are no more.
  virtual bool take(std::vector<std::string>& lines) = 0;
};

}  // namespace sandhopper
