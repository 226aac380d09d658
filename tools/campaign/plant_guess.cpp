#include "tools/campaign/plant_guess.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "tools/campaign/column_guess.hpp"
#include "tools/campaign/column_rivals.hpp"
#include "tools/campaign/key_reference.hpp"
#include "tools/campaign/read_table.hpp"

namespace sandhopper {
namespace {

using enum CampaignPlant;

struct Sign {
  std::string_view text;
  CampaignPlant plant;
};

// Parts of a column's name in lower case that only one plant has: English, German, Dutch, French, Spanish and
// Italian.
constexpr std::array kWords{
    Sign{"torque", rotary_axis},    Sign{"angle", rotary_axis},    Sign{"drehmoment", rotary_axis},
    Sign{"winkel", rotary_axis},    Sign{"drehzahl", rotary_axis}, Sign{"moment", rotary_axis},
    Sign{"hoek", rotary_axis},      Sign{"koppel", rotary_axis},   Sign{"angulo", rotary_axis},
    Sign{"angolo", rotary_axis},    Sign{"coppia", rotary_axis},   Sign{"force", intruder},
    Sign{"sinkage", intruder},      Sign{"depth", intruder},       Sign{"kraft", intruder},
    Sign{"tiefe", intruder},        Sign{"einsink", intruder},     Sign{"kracht", intruder},
    Sign{"diepte", intruder},       Sign{"profond", intruder},     Sign{"fuerza", intruder},
    Sign{"profundidad", intruder},  Sign{"forza", intruder},       Sign{"height", falling_body},
    Sign{"altitude", falling_body}, Sign{"hoehe", falling_body},   Sign{"h\xC3\xB6he", falling_body},
    Sign{"hoogte", falling_body},   Sign{"hauteur", falling_body}, Sign{"altura", falling_body},
    Sign{"altezza", falling_body}};

// A unit tells more than a name. Accelerations and pressures are recorded on other plants, too.
struct UnitSign {
  std::string_view dimension;
  CampaignPlant plant;
  int votes;
};
constexpr std::array kUnits{
    UnitSign{"angle", rotary_axis, 3},         UnitSign{"angular rate", rotary_axis, 3},
    UnitSign{"torque", rotary_axis, 3},        UnitSign{"force", intruder, 3},
    UnitSign{"acceleration", falling_body, 2}, UnitSign{"pressure", falling_body, 2}};

// In the order of CampaignPlant.
constexpr std::array<std::string_view, EnumNames<CampaignPlant>::value.size()> kNeeds{
    "angle and current of each motor of the leg", "the depth of the plate and the force on it",
    "a height or an acceleration", "an angle, and the torque of the drive if there is one"};

std::string first_value(const std::vector<double>& values) {
  const auto first = std::ranges::find_if(values, [](double value) { return !std::isnan(value); });
  return first == values.end() ? "no number" : fmt::format("first value {:.9g}", *first);
}

// True for the number of a row, a frame or a sample: whole numbers that grow evenly.
bool is_counter(const std::vector<double>& values) {
  if (values.size() < 3) return false;
  const double step = values[1] - values[0];
  for (std::size_t row = 1; row < values.size(); ++row)
    if (values[row] - values[row - 1] != step || std::floor(values[row]) != values[row]) return false;
  return step > 0.0;
}

// True for the ticks of a clock: whole numbers that never fall.
bool are_ticks(const std::vector<double>& values) {
  const bool whole = std::ranges::all_of(values, [](double value) { return std::floor(value) == value; });
  return whole && std::ranges::is_sorted(values) && !values.empty() && values.front() < values.back();
}

// A motion along one axis, without any other quantity: a height or an acceleration, perhaps beside a speed.
struct LoneMotion {
  ColumnGuess guess;
  bool has_speed = false;
};

// The only column besides times, counters and one speed, as a channel of a falling body.
std::optional<LoneMotion> lone_motion(const CsvTable& table) {
  const auto time = time_like_column(table, falling_body);
  std::optional<std::size_t> lone, speed;
  for (std::size_t i = 0; i < table.names.size(); ++i) {
    if (time == i || is_called_time(table.names[i]) || is_counter(table.columns[i])) continue;
    const auto unit = unit_of_column(table, i);
    if (!unit && are_ticks(table.columns[i])) continue;
    auto& taken = unit && unit->dimension == "speed" ? speed : lone;
    if (taken) return std::nullopt;
    taken = i;
  }
  if (!time || !lone || is_setpoint_by_name(table.names[*lone])) return std::nullopt;
  auto guess = guess_column(table.names[*lone], unit_of_column(table, *lone), falling_body, {});
  if (!guess) return std::nullopt;
  guess->column = *lone;
  return LoneMotion{*guess, speed.has_value()};
}

// True for a vertical axis: a length or an acceleration along x may be that of a linear stage, and a column
// in g may be a mass.
bool is_vertical_by_name(std::string_view name) {
  constexpr std::array<std::string_view, 16> kVertical{
      "y",      "z",      "h",       "height", "altitude", "hoehe", "h\xC3\xB6he", "hauteur",
      "hoogte", "altura", "altezza", "a",      "ay",       "az",    "acc",         "accel"};
  return std::ranges::any_of(words_of_name(name), [&](const std::string& word) {
    return std::ranges::find(kVertical, word) != kVertical.end();
  });
}

}  // namespace

std::string why_falling_body(const CsvTable& table) {
  const auto motion = lone_motion(table);
  if (!motion || !motion->guess.unit || !is_vertical_by_name(table.names[motion->guess.column])) return "";
  const auto name =
      fmt::format("{} (\"{}\")", motion->guess.channel == "height_m" ? "a height" : "an acceleration",
                  table.names[motion->guess.column]);
  return motion->has_speed ? fmt::format("because a time, {} and a speed alone fit no other plant", name)
                           : fmt::format("because a time and {} alone fit no other plant", name);
}

std::optional<CampaignPlant> guess_plant(const CsvTable& table) {
  for (const auto& name : table.names)
    if (const auto plant = plant_with_channel(name)) return plant;
  if (has_two_motors(table)) return hopper;
  std::array<int, EnumNames<CampaignPlant>::value.size()> votes{};
  const auto add = [&](CampaignPlant plant, int count) { votes[static_cast<std::size_t>(plant)] += count; };
  for (std::size_t i = 0; i < table.names.size(); ++i) {
    const auto unit = unit_of_column(table, i);
    const auto lower = in_lower_case(table.names[i]);
    for (const auto& word : kWords)
      if (has_word(lower, word.text)) add(word.plant, 1);
    for (const auto& sign : kUnits)
      if (unit && unit->dimension == sign.dimension) add(sign.plant, sign.votes);
  }
  const auto most = std::ranges::max_element(votes);
  if (*most == 0 && !why_falling_body(table).empty()) return falling_body;
  if (*most == 0) return std::nullopt;
  return static_cast<CampaignPlant>(most - votes.begin());
}

std::vector<std::string> describe_columns(const CsvTable& table) {
  std::vector<std::string> lines{table.layout.header_line == 0
                                     ? fmt::format("{} columns with the given names:", table.names.size())
                                     : fmt::format("{} columns, with the names in line {}:",
                                                   table.names.size(), table.layout.header_line)};
  for (std::size_t i = 0; i < table.names.size(); ++i) {
    const auto unit = unit_of_column(table, i);
    lines.push_back(fmt::format("  \"{}\": {}, {}", table.names[i],
                                unit ? "unit " + unit->text : std::string("no unit"),
                                first_value(table.columns[i])));
  }
  lines.emplace_back("a plant needs these columns:");
  for (std::size_t i = 0; i < kNeeds.size(); ++i)
    lines.push_back(fmt::format("  --plant {:12} {}: {}", EnumNames<CampaignPlant>::value[i],
                                meaning_of(static_cast<CampaignPlant>(i)), kNeeds[i]));
  if (const auto motion = lone_motion(table))
    lines.push_back(fmt::format("falling_body fits if \"{}\" is its {}: then give --plant falling_body",
                                table.names[motion->guess.column], motion->guess.channel));
  return lines;
}

}  // namespace sandhopper
