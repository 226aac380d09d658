#include "config/hint.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <numbers>
#include <numeric>

namespace sandhopper {
namespace {

// Suffixes of keys. Units of one dimension convert by `to_si`; 0 means that a unit does not convert.
struct Unit {
  std::string_view suffix;
  std::string_view written;
  std::string_view dimension;
  double to_si;
};

constexpr double kDegree = std::numbers::pi / 180.0;
constexpr std::array kUnits{
    Unit{"m", "m", "length", 1.0},
    Unit{"mm", "mm", "length", 1e-3},
    Unit{"cm", "cm", "length", 1e-2},
    Unit{"um", "um", "length", 1e-6},
    Unit{"kg", "kg", "mass", 1.0},
    Unit{"g", "g", "mass", 1e-3},
    Unit{"s", "s", "time", 1.0},
    Unit{"in", "in", "length", 0.0254},
    Unit{"ft", "ft", "length", 0.3048},
    Unit{"ms", "ms", "time", 1e-3},
    Unit{"us", "us", "time", 1e-6},
    Unit{"ns", "ns", "time", 1e-9},
    Unit{"Hz", "Hz", "frequency", 1.0},
    Unit{"kHz", "kHz", "frequency", 1e3},
    Unit{"MHz", "MHz", "frequency", 1e6},
    Unit{"rad", "rad", "angle", 1.0},
    Unit{"mrad", "mrad", "angle", 1e-3},
    Unit{"deg", "deg", "angle", kDegree},
    Unit{"radps", "rad/s", "angular rate", 1.0},
    Unit{"degps", "deg/s", "angular rate", kDegree},
    Unit{"rpm", "rpm", "angular rate", std::numbers::pi / 30.0},
    Unit{"radps2", "rad/s^2", "angular acceleration", 1.0},
    Unit{"mps", "m/s", "speed", 1.0},
    Unit{"mmps", "mm/s", "speed", 1e-3},
    Unit{"cmps", "cm/s", "speed", 1e-2},
    Unit{"mps2", "m/s^2", "acceleration", 1.0},
    Unit{"mmps2", "mm/s^2", "acceleration", 1e-3},
    Unit{"N", "N", "force", 1.0},
    Unit{"kN", "kN", "force", 1e3},
    Unit{"mN", "mN", "force", 1e-3},
    Unit{"lbf", "lbf", "force", 4.4482216152605},
    Unit{"kgf", "kgf", "force", 9.80665},
    Unit{"gf", "gf", "force", 9.80665e-3},
    Unit{"Pa", "Pa", "pressure", 1.0},
    Unit{"hPa", "hPa", "pressure", 1e2},
    Unit{"kPa", "kPa", "pressure", 1e3},
    Unit{"MPa", "MPa", "pressure", 1e6},
    Unit{"bar", "bar", "pressure", 1e5},
    Unit{"mbar", "mbar", "pressure", 1e2},
    Unit{"psi", "psi", "pressure", 6894.757293168},
    Unit{"Nm", "N m", "torque", 1.0},
    Unit{"mNm", "mN m", "torque", 1e-3},
    Unit{"Ncm", "N cm", "torque", 1e-2},
    Unit{"N_per_m", "N/m", "stiffness", 1.0},
    Unit{"N_per_cm", "N/cm", "stiffness", 1e2},
    Unit{"N_per_mm", "N/mm", "stiffness", 1e3},
    Unit{"kN_per_m", "kN/m", "stiffness", 1e3},
    Unit{"N_s_per_m", "N s/m", "damping", 1.0},
    Unit{"Nm_per_A", "N m/A", "torque constant", 1.0},
    Unit{"mNm_per_A", "mN m/A", "torque constant", 1e-3},
    Unit{"Nm_per_rad", "N m/rad", "angular stiffness", 1.0},
    Unit{"Nm_s_per_rad", "N m s/rad", "angular damping", 1.0},
    Unit{"N_per_V", "N/V", "gain", 1.0},
    Unit{"kg_m2", "kg m^2", "inertia", 1.0},
    Unit{"kg_cm2", "kg cm^2", "inertia", 1e-4},
    Unit{"g_cm2", "g cm^2", "inertia", 1e-7},
    Unit{"Nm_s", "N m s", "angular damping", 1.0},
    Unit{"m_per_N", "m/N", "compliance", 1.0},
    Unit{"N_per_m3", "N/m^3", "stiffness per area", 1.0},
    Unit{"m2", "m^2", "area", 1.0},
    Unit{"m3", "m^3", "volume", 1.0},
    Unit{"per_rev", "per turn", "number in a turn", 1.0},
    Unit{"kg_per_m", "kg/m", "mass gradient", 1.0},
    Unit{"kg_per_m3", "kg/m^3", "density", 1.0},
    Unit{"s2_per_m", "s^2/m", "inverse acceleration", 1.0},
    Unit{"per_s", "1/s", "rate", 1.0},
    Unit{"per_m", "1/m", "gradient", 1.0},
    Unit{"A", "A", "current", 1.0},
    Unit{"mA", "mA", "current", 1e-3},
    Unit{"V", "V", "voltage", 1.0},
    Unit{"mV", "mV", "voltage", 1e-3},
    Unit{"C", "degrees C", "temperature", 1.0},
    Unit{"K", "K", "temperature", 0.0},
    Unit{"F", "degrees F", "temperature", 0.0},
    Unit{"percent", "%", "share", 1e-2},
};

struct KeyParts {
  std::string_view quantity;
  const Unit* unit = nullptr;
};

KeyParts split_key(std::string_view key) {
  KeyParts parts{key, nullptr};
  for (const auto& unit : kUnits) {
    const auto length = unit.suffix.size() + 1;
    if (key.size() <= length || !key.ends_with(unit.suffix) || key[key.size() - length] != '_') continue;
    if (parts.unit && parts.unit->suffix.size() >= unit.suffix.size()) continue;
    parts = {key.substr(0, key.size() - length), &unit};
  }
  return parts;
}

// Number of edits (insert, delete, replace, swap of neighbours) that turn `a` into `b`, ignoring case.
std::size_t edit_distance(std::string_view a, std::string_view b) {
  const auto same = [](char x, char y) {
    return std::tolower(static_cast<unsigned char>(x)) == std::tolower(static_cast<unsigned char>(y));
  };
  std::vector<std::size_t> before(b.size() + 1), row(b.size() + 1), next(b.size() + 1);
  std::iota(row.begin(), row.end(), 0U);
  for (std::size_t i = 1; i <= a.size(); ++i) {
    next[0] = i;
    for (std::size_t j = 1; j <= b.size(); ++j) {
      next[j] = std::min({row[j] + 1, next[j - 1] + 1, row[j - 1] + (same(a[i - 1], b[j - 1]) ? 0U : 1U)});
      if (i > 1 && j > 1 && same(a[i - 1], b[j - 2]) && same(a[i - 2], b[j - 1]))
        next[j] = std::min(next[j], before[j - 2] + 1);
    }
    before.swap(row);
    row.swap(next);
  }
  return row[b.size()];
}

bool contains_words(std::string_view text, std::string_view words) {
  return fmt::format("_{}_", text).find(fmt::format("_{}_", words)) != std::string::npos;
}

std::string write_instead(std::string_view expected, const Unit& given, const Unit& wanted,
                          std::optional<double> value) {
  if (!value || given.to_si == 0.0 || wanted.to_si == 0.0)
    return fmt::format("write '{}', in {}", expected, wanted.written);
  return fmt::format("the unit is {}: write '{} = {:.6g}'", wanted.written, expected,
                     *value * given.to_si / wanted.to_si);
}

}  // namespace

std::vector<std::string> nearest_words(std::string_view word, std::span<const std::string> known,
                                       std::size_t limit) {
  std::vector<std::pair<std::size_t, std::string>> ranked;
  const auto tolerance = std::max<std::size_t>(2, word.size() / 4);
  for (const auto& candidate : known) {
    const auto distance = edit_distance(word, candidate);
    if (distance <= tolerance && distance < std::max(word.size(), candidate.size()))
      ranked.emplace_back(distance, candidate);
  }
  std::stable_sort(ranked.begin(), ranked.end(), [](auto& a, auto& b) { return a.first < b.first; });
  std::vector<std::string> nearest;
  for (const auto& [distance, candidate] : ranked)
    if (nearest.size() < limit && distance <= ranked.front().first + 1) nearest.push_back(candidate);
  return nearest;
}

std::string either(std::span<const std::string> words) {
  std::string text;
  for (std::size_t i = 0; i < words.size(); ++i)
    text += fmt::format("{}'{}'", i == 0 ? "" : i + 1 == words.size() ? " or " : ", ", words[i]);
  return text;
}

std::optional<UnitOfKey> split_unit(std::string_view key) {
  const auto parts = split_key(key);
  if (!parts.unit) return std::nullopt;
  return UnitOfKey{parts.quantity, parts.unit->suffix, parts.unit->dimension, parts.unit->to_si};
}

std::string_view last_key(std::string_view path) {
  if (const auto bracket = path.find_last_of('['); bracket != std::string_view::npos && path.back() == ']')
    path = path.substr(0, bracket);
  const auto dot = path.find_last_of('.');
  return dot == std::string_view::npos ? path : path.substr(dot + 1);
}

std::string unit_of_key(std::string_view key) {
  const auto unit = split_key(key).unit;
  return unit ? std::string(unit->written) : std::string();
}

std::string cure_for_unknown_key(std::string_view key, std::optional<double> value,
                                 std::span<const std::string> candidates) {
  const auto given = split_key(key);
  std::vector<std::string> related;
  for (const auto& candidate : candidates) {
    const auto wanted = split_key(candidate);
    const bool comparable = given.unit && wanted.unit && given.unit->dimension == wanted.unit->dimension;
    if (wanted.quantity == given.quantity && comparable)
      return write_instead(candidate, *given.unit, *wanted.unit, value);
    const bool partial =
        contains_words(wanted.quantity, given.quantity) || contains_words(given.quantity, wanted.quantity);
    if (partial && (comparable || !given.unit || given.quantity == wanted.quantity))
      related.push_back(candidate);
  }
  const auto spelling = nearest_words(key, candidates);
  const auto& suggestions = spelling.empty() ? related : spelling;
  if (suggestions.empty()) return fmt::format("the keys here are {}", fmt::join(candidates, ", "));
  const auto shown = std::span(suggestions).first(std::min<std::size_t>(4, suggestions.size()));
  const auto wanted = split_key(suggestions.front());
  const bool other_unit = given.unit && wanted.unit && given.unit != wanted.unit;
  return fmt::format("did you mean {}{}?", either(shown),
                     other_unit ? fmt::format(" (in {})", wanted.unit->written) : "");
}

}  // namespace sandhopper
