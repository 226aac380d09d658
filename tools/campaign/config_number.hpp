#pragma once
#include <optional>

#include "config/node.hpp"

namespace sandhopper {

// The value of an integer or real node; empty for other kinds.
inline std::optional<double> number_of(const ConfigNode& node) {
  if (node.kind == ConfigNode::Kind::real) return node.real;
  if (node.kind == ConfigNode::Kind::integer) return static_cast<double>(node.integer);
  return std::nullopt;
}

}  // namespace sandhopper
