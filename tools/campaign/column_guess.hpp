#pragma once
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "tools/campaign/plant_kind.hpp"
#include "tools/campaign/written_unit.hpp"

// A foreign column's channel, by the words in its name and by its unit.
namespace sandhopper {

struct ColumnGuess {
  std::size_t column = 0;  // of the table
  std::string channel{};
  std::optional<WrittenUnit> unit{};
  double scale = 1.0;
  bool is_downward = false;  // the name means a depth: the channel counts upward
};

// Words go before units. Nothing where neither fits a channel of the plant that `taken` leaves.
std::optional<ColumnGuess> guess_column(const std::string& name, const std::optional<WrittenUnit>& unit,
                                        CampaignPlant plant, const std::vector<ColumnGuess>& taken);

std::string in_lower_case(std::string_view text);
// One letter must be the whole quantity: "z (mm)", not the z in "size". `lower` is in lower case.
bool has_word(const std::string& lower, std::string_view word);

}  // namespace sandhopper
