#pragma once
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "tools/campaign/plant_kind.hpp"
#include "tools/campaign/written_unit.hpp"

// Guesses the channel of a foreign column from the words in its name and from its unit.
namespace sandhopper {

// A column of the table and the channel it may be. channel = scale x column.
struct ColumnGuess {
  std::size_t column = 0;  // index in the table
  std::string channel{};
  std::optional<WrittenUnit> unit{};
  double scale = 1.0;
  bool is_downward = false;  // The name means a depth, but the channel counts upward.
  bool asks_scale = false;   // A current for a torque: only the user knows the torque constant.
};

// Words take precedence over units. Returns an empty optional if nothing fits a channel of the plant that is
// not in `taken`.
std::optional<ColumnGuess> guess_column(const std::string& name, const std::optional<WrittenUnit>& unit,
                                        CampaignPlant plant, const std::vector<ColumnGuess>& taken);

// The current that stands for an axis's torque, if no column is one: that of the torque (Iq), else the first
// that is no set-point.
std::optional<ColumnGuess> guess_torque_by_current(const std::vector<std::string>& names,
                                                   const std::vector<std::optional<WrittenUnit>>& units,
                                                   const std::vector<ColumnGuess>& taken);

// True if the name is that of a set-point, which is asked for and not measured; true if it is that of a value
// that was filtered or averaged, which is late.
bool is_setpoint_by_name(std::string_view name);
bool is_filtered_by_name(std::string_view name);

// Indices of the columns in the order in which a channel takes the first that fits: measured, filtered,
// set-points.
std::vector<std::size_t> in_order_of_choice(const std::vector<std::string>& names);

// Words of a name in lower case: "pos", "ref", "deg" for "posRef_deg".
std::vector<std::string> words_of_name(std::string_view name);

// Only the letters A to Z are changed.
std::string in_lower_case(std::string_view text);
// True if `lower` (lower-case text) contains the word. A single letter must be the whole quantity: "z (mm)",
// not the z in "size".
bool has_word(const std::string& lower, std::string_view word);

}  // namespace sandhopper
