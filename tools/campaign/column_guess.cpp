#include "tools/campaign/column_guess.hpp"

#include <algorithm>
#include <array>
#include <numeric>
#include <span>

namespace sandhopper {
namespace {

using enum CampaignPlant;

struct Naming {
  std::string_view channel;
  CampaignPlant plant;
  std::string_view dimension;
  std::array<std::string_view, 16> words;  // In lower case; one of them must be in the column's name.
  bool is_downward = false;                // The words mean a depth, but the channel counts upward.
};
constexpr std::array kNamings{
    Naming{"foot_z_m",
           intruder,
           "length",
           {"sinkage", "depth", "penetration", "einsink", "eindring", "tiefe", "indent", "enfonc", "profond",
            "diepte", "profund"},
           true},
    Naming{"foot_z_m",
           intruder,
           "length",
           {"foot_z", "position", "displacement", "extension", "crosshead", "travel", "height", "weg", "z"},
           false},
    Naming{"force_N",
           intruder,
           "force",
           {"force", "load", "kraft", "fz", "last", "kracht", "fuerza", "forza"},
           false},
    Naming{"foot_velocity_mps",
           intruder,
           "speed",
           {"velocity", "speed", "geschw", "snelheid", "vitesse", "velocidad"},
           false},
    Naming{"foot_accel_mps2", intruder, "acceleration", {"accel", "acc", "beschl"}, false},
    Naming{"height_m",
           falling_body,
           "length",
           {"height", "altitude", "hoehe", "höhe", "hoogte", "hauteur", "altura", "altezza", "position", "y",
            "z", "h"},
           false},
    Naming{"accel_mps2", falling_body, "acceleration", {"accel", "acc", "beschl"}, false},
    Naming{"pressure_Pa", falling_body, "pressure", {"pressure", "druck", "pore"}, false},
    Naming{"position_rad",
           rotary_axis,
           "angle",
           {"angle", "position", "theta", "phi", "winkel", "hoek", "angulo", "angolo", "encoder", "pos"},
           false},
    Naming{"velocity_radps",
           rotary_axis,
           "angular rate",
           {"speed", "velocity", "omega", "drehzahl", "geschw", "snelheid", "vitesse", "rpm", "vel"},
           false},
    Naming{"torque_Nm", rotary_axis, "torque", {"torque", "moment", "tau", "koppel", "coppia"}, false}};

ColumnGuess made(std::string_view channel, const std::optional<WrittenUnit>& unit, bool downward) {
  const auto wanted = unit_of_channel(channel);
  const auto factor = unit && wanted ? factor_between(*unit, *wanted) : std::nullopt;
  return {0, std::string(channel), factor ? unit : std::nullopt,
          factor.value_or(1.0) * (downward ? -1.0 : 1.0), downward};
}

bool has_any(std::string_view name, std::span<const std::string_view> words) {
  const auto lower = in_lower_case(name);
  return std::ranges::any_of(words,
                             [&](std::string_view word) { return lower.find(word) != std::string::npos; });
}

}  // namespace

bool is_setpoint_by_name(std::string_view name) {
  constexpr std::array<std::string_view, 15> kParts{
      "setpoint", "set_point", "set point", "cmd",     "command", "target",   "desired", "demand",
      "soll",     "reference", "consign",   "vorgabe", "comando", "kommando", "referenc"};
  constexpr std::array<std::string_view, 4> kWords{"ref", "sp", "goal", "des"};
  return has_any(name, kParts) || std::ranges::any_of(words_of_name(name), [&](const std::string& word) {
           return std::ranges::find(kWords, word) != kWords.end();
         });
}

bool is_filtered_by_name(std::string_view name) {
  constexpr std::array<std::string_view, 5> kWords{"filt", "smooth", "averag", "_avg", "lowpass"};
  return has_any(name, kWords);
}

std::vector<std::size_t> in_order_of_choice(const std::vector<std::string>& names) {
  std::vector<std::size_t> columns(names.size());
  std::iota(columns.begin(), columns.end(), std::size_t{0});
  std::ranges::stable_sort(columns, {}, [&](std::size_t i) {
    return is_setpoint_by_name(names[i]) ? 2 : is_filtered_by_name(names[i]) ? 1 : 0;
  });
  return columns;
}

std::vector<std::string> words_of_name(std::string_view name) {
  const auto is_upper = [](char c) { return c >= 'A' && c <= 'Z'; };
  const auto is_lower = [](char c) { return c >= 'a' && c <= 'z'; };
  std::vector<std::string> words;
  char before = ' ';
  for (const char c : name) {
    const bool is_letter = is_upper(c) || is_lower(c) || static_cast<unsigned char>(c) > 127;
    const bool begins = before == ' ' || (is_lower(before) && is_upper(c));
    if (is_letter && begins) words.emplace_back();
    if (is_letter) words.back() += in_lower_case({&c, 1});
    before = is_letter ? c : ' ';
  }
  return words;
}

std::string in_lower_case(std::string_view text) {
  std::string out(text);
  std::transform(out.begin(), out.end(), out.begin(),
                 [](char c) { return c >= 'A' && c <= 'Z' ? static_cast<char>(c + 32) : c; });
  return out;
}

bool has_word(const std::string& lower, std::string_view word) {
  if (word.empty()) return false;
  if (word.size() > 1) return lower.find(word) != std::string::npos;
  return lower.starts_with(word) &&
         (lower.size() == 1 || std::string_view(" _[(").find(lower[1]) != std::string_view::npos);
}

std::optional<ColumnGuess> guess_column(const std::string& name, const std::optional<WrittenUnit>& unit,
                                        CampaignPlant plant, const std::vector<ColumnGuess>& taken) {
  if (find_channel(plant, name) != nullptr) return made(name, unit, false);
  const auto is_taken = [&](std::string_view channel) {
    return std::ranges::find(taken, channel, &ColumnGuess::channel) != taken.end();
  };
  const bool is_setpoint = is_setpoint_by_name(name);
  const auto lower = in_lower_case(name);
  for (const bool by_word : {true, false})
    for (const auto& naming : kNamings) {
      if (naming.plant != plant || is_taken(naming.channel)) continue;
      // Many drives log no torque but the commanded one. A set-point of a motion is no measurement.
      if (is_setpoint && naming.dimension != "torque") continue;
      const bool word =
          std::ranges::any_of(naming.words, [&](std::string_view w) { return has_word(lower, w); });
      const auto wanted = unit_of_channel(naming.channel);
      const bool fits = unit && wanted && factor_between(*unit, *wanted);
      if (by_word ? word && (fits || !unit) : fits)
        return made(naming.channel, unit, word && naming.is_downward);
    }
  return std::nullopt;
}

std::optional<ColumnGuess> guess_torque_by_current(const std::vector<std::string>& names,
                                                   const std::vector<std::optional<WrittenUnit>>& units,
                                                   const std::vector<ColumnGuess>& taken) {
  if (std::ranges::find(taken, "torque_Nm", &ColumnGuess::channel) != taken.end()) return std::nullopt;
  std::optional<std::size_t> found;
  const auto is_of_torque = [&](std::size_t i) {
    const auto words = words_of_name(names[i]);
    return std::ranges::any_of(words, [](const std::string& word) { return word.starts_with("iq"); });
  };
  for (std::size_t i = 0; i < names.size(); ++i) {
    if (!units[i] || units[i]->dimension != "current" || is_setpoint_by_name(names[i])) continue;
    if (!found || (is_of_torque(i) && !is_of_torque(*found))) found = i;
  }
  if (!found) return std::nullopt;
  return ColumnGuess{
      .column = *found, .channel = "torque_Nm", .unit = units[*found], .scale = 1.0, .asks_scale = true};
}

}  // namespace sandhopper
