#pragma once
#include <cstdint>
#include <string_view>

#include "tools/trial/trace/findings.hpp"

namespace sandhopper::trace {

// Digits behind the point of a trace's times. A program that prints seconds and microseconds as two whole
// numbers with a point between them writes 260 us as ".260", which is read as 260 ms. Such fractions differ
// in length, none begins with 0 and some end with 0. Fractions without their last zeros, ".00026", differ in
// length too, but none of them ends with 0.
class TimeDigits {
 public:
  void see(std::string_view line);
  bool unpadded() const { return shortest_ < longest_ && !leading_zero_ && trailing_zero_; }
  // `file` is named in the cure.
  Findings findings(std::string_view file) const;

 private:
  std::size_t shortest_ = SIZE_MAX, longest_ = 0;
  bool leading_zero_ = false, trailing_zero_ = false;
};

}  // namespace sandhopper::trace
