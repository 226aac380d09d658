#pragma once
#include <optional>
#include <string>
#include <string_view>

namespace sandhopper {

// What a set-up key says where the experimenter named it otherwise: `rest_min` is `wait_s` times 60,
// `intrusion_number` one more than `pushes_since_preparation`.
struct SetupMeaning {
  std::string key;          // wait_s, bed_depth_m or pushes_since_preparation
  double scale = 1.0;       // to its unit
  bool is_ordinal = false;  // counts from the campaign's least, not from nothing
};

// Nothing for a key that has its usual name, and for one that says none of these.
std::optional<SetupMeaning> meaning_of_setup(std::string_view key);

}  // namespace sandhopper
