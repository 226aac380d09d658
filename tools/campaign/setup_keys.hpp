#pragma once
#include <optional>
#include <string>
#include <string_view>

namespace sandhopper {

// Translates a set-up key with another name: `rest_min` is `wait_s` times 60, `intrusion_number` is
// `pushes_since_preparation` plus one.
struct SetupMeaning {
  std::string key;          // wait_s, bed_depth_m or pushes_since_preparation
  double scale = 1.0;       // factor to that key's unit
  bool is_ordinal = false;  // The smallest value in the campaign counts as 0.
};

// Empty for a key with its usual name, and for a key with none of these meanings.
std::optional<SetupMeaning> meaning_of_setup(std::string_view key);

}  // namespace sandhopper
