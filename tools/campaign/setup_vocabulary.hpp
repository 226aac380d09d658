#pragma once
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "tools/campaign/plant_kind.hpp"

namespace sandhopper {

// A set-up key that changes an answer.
struct SetupWord {
  std::string key;                 // "plate_diameter_m"
  std::vector<std::string> names;  // quantity without unit, in plain_name(): with and without its table
  std::string dimension;           // "length"; empty for a key without a unit
  double to_si = 1.0;
  std::string path{};        // of the belief's number that it replaces; empty: none, or a diameter
  bool takes_number = true;  // False for true/false and for words.
};

// Set-up keys of a plant: those of nominal.toml, the diameters, and the keys that the tools read from a
// trial.
std::vector<SetupWord> setup_words(CampaignPlant plant);

// A key's quantity and unit. The unit may be written as in a file: "speed_mm_s", "density_g_per_cm3".
struct KeyParts {
  std::string quantity;
  std::string unit{};       // as written: "mm/s"; empty: none
  std::string dimension{};  // empty without a unit
  double to_si = 1.0;
};
KeyParts parts_of_key(std::string_view key);

// The quantity's words in one order and spelling, without signs between them, so that "Plate_Diam" and
// "diameter_plate" are the same.
std::string plain_name(std::string_view quantity);

// A number with a unit in a text, such as "50 mm"; the unit may be missing.
struct WrittenNumber {
  double value = 0.0;
  std::string dimension{};
  double to_si = 1.0;
};
std::optional<WrittenNumber> number_in_text(std::string_view text);

}  // namespace sandhopper
