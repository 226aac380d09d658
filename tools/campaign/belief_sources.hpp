#pragma once
#include <functional>
#include <map>
#include <string>
#include <string_view>
#include <vector>

#include "tools/campaign/campaign.hpp"

namespace sandhopper {

// All numbers of a belief. Key: "table.key". Empty optional values are left out; true is 1.
std::map<std::string, double> numbers_of(const Belief& belief);

// One number that an answer depends on, and its source.
struct UsedNumber {
  enum class Source : std::uint8_t { model_file, trial_setup, plant_default };
  std::string key;               // "terrain.stiffness_N_per_m"
  double value = 0.0;            // value of the campaign; trials may have their own
  double low = 0.0, high = 0.0;  // smallest and largest value over the trials
  std::string unit{};
  Source source = Source::plant_default;
  std::string source_text{};  // "nominal.toml, line 5", "set-up of 3 trials", "default: <reason>"
  // Half a unit of the last digit that was written, through the conversion that was done; 0: nobody wrote it.
  double written_error = 0.0;
};

// Numbers of the belief that the model file or a set-up states, and defaults that are not 0 of keys that the
// plant uses. `off` counts the defaults that are 0 (effect switched off). Defaults of [sensors] and [spread]
// of the simple plants have no effect and are left out.
struct UsedNumbers {
  std::vector<UsedNumber> numbers;
  std::size_t off = 0;
};
UsedNumbers used_numbers(const Campaign& campaign);

// Largest error to be expected from how a number is written: half a unit of its last digit. For a default
// that nobody stated: its full size; for gravity: its variation over the Earth.
double usual_error(const UsedNumber& number);

// Standard deviation of the rounding of each number in the model file, uniform within half a unit h of its
// last digit, h / sqrt(3). Without numbers for which [known_to] or [spread] says more, without [sensors],
// and without whole numbers, which may be exact (a factor of 1.0).
std::vector<KeySpread> rounding_of(const UsedNumbers& used, const Campaign& campaign);

// False for a default of [sensors] and [spread]. These stand together in one line, `defaults_of_sensors`.
bool is_listed(const UsedNumber& number);
std::string defaults_of_sensors(const UsedNumbers& used);  // empty if there are none

std::string to_string(const UsedNumber& number);  // "axis.inertia_kg_m2 = 0.1 kg m^2 (nominal.toml, line 3)"

// A line for each effect that [effects] of the model file puts in place, with its parameters and its line.
std::vector<std::string> stated_effects(const Campaign& campaign);

// One finding for each number that the plant needs (belief_notes.hpp) and that neither the model file nor
// every trial states. None for a hopper, because its belief is this project's robot.
std::vector<Finding> missing_numbers(const Campaign& campaign);

// The same as notes of a verb that computes with the placeholders, for the keys that it uses.
std::vector<Finding> placeholder_notes(const Campaign& campaign,
                                       const std::function<bool(std::string_view key)>& is_used);

// A note for each key that the model states, that no tool uses on this plant, and that stands in the place of
// a key that is used and not stated: sensors.position_noise_m where mocap_noise_m counts.
std::vector<Finding> unused_key_notes(const Campaign& campaign);

// True for the stiffness of a bed whose law is that with a stiffness per area.
bool is_replaced(std::string_view path, const Belief& belief);

}  // namespace sandhopper
