#pragma once
#include <string>

#include "tools/diagnose/model/quantity.hpp"
#include "tools/report/digits.hpp"

namespace sandhopper::diagnose {

// digits_by(); without an uncertainty number().
inline std::string to_digits_of(double value, double uncertainty) {
  return digits_by(value, uncertainty).value_or(number(value));
}

}  // namespace sandhopper::diagnose
