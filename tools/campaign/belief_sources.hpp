#pragma once
#include <map>
#include <string>
#include <vector>

#include "tools/campaign/campaign.hpp"

namespace sandhopper {

// Every number of a belief under "table.key"; absent options are absent, true is 1.
std::map<std::string, double> numbers_of(const Belief& belief);

// One number that an answer rests on, and who said it.
struct UsedNumber {
  enum class Source : std::uint8_t { model_file, trial_setup, plant_default };
  std::string key;               // "terrain.stiffness_N_per_m"
  double value = 0.0;            // of the campaign; trials may have their own
  double low = 0.0, high = 0.0;  // over the trials
  std::string unit{};
  Source source = Source::plant_default;
  std::string said_by{};  // "nominal.toml, line 5", "set-up of 3 trials", "default: <reason>"
};

// Those of the plant's own tables and of [sensors] and [spread] that the file or a set-up states, and
// defaults that are not 0. What is 0 by default is off and only counted (`off`). Without effect are [sensors]
// and [spread] of simple plants, whose defaults limit and disturb nothing; they are not listed.
struct UsedNumbers {
  std::vector<UsedNumber> numbers;
  std::size_t off = 0;
};
UsedNumbers used_numbers(const Campaign& campaign);

// As far as a number may be off by the way it was written: half a unit of its last digit (1.20 counts
// as 1.2). A default may be off by its whole size, for nobody stated it; gravity by what it differs over the
// Earth.
double usual_error(const UsedNumber& number);

std::string to_string(const UsedNumber& number);  // "axis.inertia_kg_m2 = 0.1 kg m^2 (nominal.toml, line 3)"

// A finding for each number that the plant cannot do without (belief_notes.hpp) and that neither the model
// file nor the set-up of every trial states. None for the hopper: its belief is this project's robot.
std::vector<Finding> missing_numbers(const Campaign& campaign);

}  // namespace sandhopper
