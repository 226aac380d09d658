#include "tools/campaign/column_names.hpp"

#include <fmt/format.h>

#include "config/hint.hpp"

namespace sandhopper {
namespace {

struct Parts {
  std::string quantity;
  std::string unit;
};

// Unit after a quantity: "kN" for the column "load_cell_force_kN" or "load_cell_force [kN]" and the quantity
// "load_cell_force".
std::optional<std::string> unit_after(std::string_view column, std::string_view quantity) {
  if (column.size() <= quantity.size() || !column.starts_with(quantity)) return std::nullopt;
  std::string_view rest = column.substr(quantity.size());
  const bool bracket = rest.find_first_of("[(") != std::string_view::npos;
  while (!rest.empty() && std::string_view(" _[(").find(rest.front()) != std::string_view::npos)
    rest.remove_prefix(1);
  while (!rest.empty() && std::string_view(" ])").find(rest.back()) != std::string_view::npos)
    rest.remove_suffix(1);
  const bool separated = bracket || column[quantity.size()] == '_' || column[quantity.size()] == ' ';
  if (!separated || rest.empty()) return std::nullopt;
  return std::string(rest);
}

std::optional<double> scale_between(std::string_view given, std::string_view wanted,
                                    std::string_view dimension) {
  if (given == "g" && dimension == "acceleration") return 9.80665;
  const auto from = split_unit(fmt::format("x_{}", given));
  const auto to = split_unit(fmt::format("x_{}", wanted));
  if (!from || !to || from->dimension != to->dimension || from->to_si == 0.0 || to->to_si == 0.0)
    return std::nullopt;
  return from->to_si / to->to_si;
}

}  // namespace

std::optional<MisnamedUnit> misnamed_unit(std::string_view column, CampaignPlant plant) {
  std::optional<MisnamedUnit> best;
  std::size_t longest = 0;
  const auto consider = [&](std::string_view channel) {
    const auto parts = split_unit(channel);
    if (!parts || parts->quantity.size() <= longest) return;
    const auto unit = unit_after(column, parts->quantity);
    // The rest must look like a unit: one word, or a unit listed here.
    if (!unit || *unit == parts->suffix) return;
    const auto scale = scale_between(*unit, parts->suffix, parts->dimension);
    const bool one_word = unit->find('_') == std::string::npos;
    if (!scale && (!one_word || unit->size() > 6)) return;
    longest = parts->quantity.size();
    best = {std::string(channel), *unit, scale};
  };
  consider("t_s");
  for (const auto& channel : known_channels())
    if (channel.plant == plant) consider(channel.name);
  return best;
}

}  // namespace sandhopper
