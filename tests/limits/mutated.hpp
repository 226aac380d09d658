#pragma once
#include <cstdlib>
#include <string_view>

namespace sandhopper {

// The value of a constant, halved or doubled if the environment asks for that: SANDHOPPER_LIMIT=NAME=FACTOR.
// Only mutate_limits.mjs writes calls of it, in a copy of the tree.
template <class Value>
Value mutated(std::string_view name, Value value) {
  const char* asked = std::getenv("SANDHOPPER_LIMIT");
  if (asked == nullptr) return value;
  const std::string_view text = asked;
  const auto equals = text.rfind('=');
  if (equals == text.npos || text.substr(0, equals) != name) return value;
  return static_cast<Value>(static_cast<double>(value) * std::atof(asked + equals + 1));
}

}  // namespace sandhopper
