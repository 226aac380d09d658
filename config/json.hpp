#pragma once
#include <nlohmann/json.hpp>

#include "config/dump.hpp"

namespace sandhopper {

// Keys are in the order of `fields`. Numbers that JSON cannot represent (NaN, infinities) become null.
nlohmann::ordered_json to_json(const ConfigNode& node);

template <HasFields T>
nlohmann::ordered_json to_json(const T& value) {
  return to_json(to_node(value));
}

}  // namespace sandhopper
