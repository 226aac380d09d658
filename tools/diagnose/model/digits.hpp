#pragma once
#include <string>

#include "tools/diagnose/model/quantity.hpp"
#include "tools/report/digits.hpp"

namespace sandhopper::diagnose {

// digits_by(); without an uncertainty number().
inline std::string to_digits_of(double value, double uncertainty) {
  return digits_by(value, uncertainty).value_or(number(value));
}

constexpr double kLeastProbability = 1e-4;  // Below it, tails of distributions are not known so well.

// A p value: "0.0025", or "< 0.0001".
inline std::string probability_text(double p) {
  return p < kLeastProbability ? "<\u00a00.0001" : plain_number(p, 2);
}

}  // namespace sandhopper::diagnose
