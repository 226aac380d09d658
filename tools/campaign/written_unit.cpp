#include "tools/campaign/written_unit.hpp"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <span>
#include <vector>

#include "config/hint.hpp"
#include "tools/campaign/name_factor.hpp"
#include "tools/campaign/spelled_units.hpp"
#include "tools/campaign/unit_spellings.hpp"
#include "tools/campaign/unit_text.hpp"

namespace sandhopper {
namespace {

// True for units that may be the whole name of a column. Shorter ones are ambiguous: "h" for height, "t" for
// time, "m" for mass.
bool stands_alone(std::string_view text) {
  constexpr std::array<std::string_view, 12> kAlone{"rpm", "RPM", "deg",    "degrees", "mm", "kN",
                                                    "dps", "Nm",  "millis", "micros",  "ms", "erpm"};
  return std::find(kAlone.begin(), kAlone.end(), text) != kAlone.end();
}

std::string_view trimmed(std::string_view text) {
  constexpr std::string_view kBlank = " \t";
  while (!text.empty() && kBlank.find(text.front()) != std::string_view::npos) text.remove_prefix(1);
  while (!text.empty() && kBlank.find(text.back()) != std::string_view::npos) text.remove_suffix(1);
  return text;
}

// Words in brackets that are not units: they select one of several, or name a processing step.
bool is_no_unit(std::string_view text) {
  constexpr std::array<std::string_view, 44> kWords{
      "left", "right", "front", "rear", "top",  "bottom", "up",    "down",  "upper", "lower", "x",
      "y",    "z",     "a",     "b",    "1st",  "2nd",    "avg",   "mean",  "rms",   "min.",  "max",
      "raw.", "filt",  "filt.", "cal",  "cal.", "comp",   "comp.", "tared", "net",   "gross", "abs",
      "rel",  "total", "old",   "new",  "ref",  "set",    "act",   "meas",  "est",   "sim",   "true"};
  std::string lower(text);
  std::transform(lower.begin(), lower.end(), lower.begin(),
                 [](char c) { return c >= 'A' && c <= 'Z' ? static_cast<char>(c + 32) : c; });
  const bool numbered = text.size() < 5 && text.find_first_of("0123456789") != std::string_view::npos;
  return numbered || std::find(kWords.begin(), kWords.end(), lower) != kWords.end();
}

std::string without_blanks(std::string_view text) {
  std::string out;
  for (const char c : text)
    if (c != ' ') out.push_back(c);
  return out;
}

std::optional<WrittenUnit> known_unit(std::string_view text) {
  const std::string name = without_blanks(text);
  if (name.empty()) return std::nullopt;
  for (const std::span<const Spelling> spellings :
       {std::span<const Spelling>(kSpellings), std::span<const Spelling>(kSpelledUnits)})
    for (const auto& spelling : spellings)
      if (spelling.written == name)
        return WrittenUnit{std::string(text), std::string(spelling.dimension), spelling.to_si};
  const auto listed = split_unit("x_" + name);
  if (listed && listed->quantity == "x")
    return WrittenUnit{std::string(text), std::string(listed->dimension), listed->to_si};
  return std::nullopt;
}

// Units of "pi rad", whose numbers are the multiples of pi.
std::optional<WrittenUnit> unit_of_pi(std::string_view text) {
  const std::string name = without_blanks(text);
  for (const std::string_view pi : {"pi*", "pi", "\xCF\x80*", "\xCF\x80"})
    if (name == std::string(pi) + "rad") return WrittenUnit{std::string(text), "angle", kPi};
  return std::nullopt;
}

// A unit with a factor: "x10 N", "0.01 mm", "1/100 mm", "10^-3 m", "1e3 N". A plain number from 1 on is none:
// "(500 N)" is the range of a load cell.
std::optional<WrittenUnit> scaled_unit(std::string_view text) {
  const std::string name = with_plain_powers(without_blanks(text));
  std::string_view rest = name;
  bool is_factor = false;
  for (const std::string_view mark : {"x", "X", "*", "\xC3\x97"})
    if (!is_factor && rest.starts_with(mark)) rest.remove_prefix(mark.size()), is_factor = true;
  double factor = 0.0;
  const auto number = std::from_chars(rest.data(), rest.data() + rest.size(), factor);
  if (number.ec != std::errc() || !(factor > 0.0)) return std::nullopt;
  const auto digits = rest.substr(0, static_cast<std::size_t>(number.ptr - rest.data()));
  is_factor = is_factor || factor < 1.0 || digits.find_first_of("eE") != std::string_view::npos;
  rest.remove_prefix(digits.size());
  if (factor == 1.0 && rest.starts_with("/")) {
    double divisor = 0.0;
    const auto whole = std::from_chars(rest.data() + 1, rest.data() + rest.size(), divisor);
    if (whole.ec != std::errc() || !(divisor > 1.0)) return std::nullopt;
    rest.remove_prefix(static_cast<std::size_t>(whole.ptr - rest.data()));
    factor = 1.0 / divisor;
    is_factor = true;
  }
  if (factor == 10.0 && rest.starts_with("^")) {
    int power = 0;
    rest.remove_prefix(rest.starts_with("^+") ? 2 : 1);
    const auto exponent = std::from_chars(rest.data(), rest.data() + rest.size(), power);
    if (exponent.ec != std::errc()) return std::nullopt;
    rest.remove_prefix(static_cast<std::size_t>(exponent.ptr - rest.data()));
    factor = std::pow(10.0, power);
    is_factor = true;
  }
  if (rest.starts_with("*")) rest.remove_prefix(1);
  const auto unit = is_factor ? known_unit(rest) : std::nullopt;
  if (!unit || !(unit->to_si > 0.0)) return std::nullopt;
  return WrittenUnit{std::string(text), unit->dimension, factor * unit->to_si};
}

bool is_small(char c) { return c >= 'a' && c <= 'z'; }
bool is_capital(char c) { return c >= 'A' && c <= 'Z'; }

std::string lower_case(std::string_view text) {
  std::string out(text);
  for (char& c : out)
    if (is_capital(c)) c = static_cast<char>(c + 32);
  return out;
}

// Units whose meaning does not depend on case: "DEG", "Ms", "NM" for a torque. Not MN and mN, MPa and mPa.
std::optional<WrittenUnit> unit_in_any_case(std::string_view text) {
  struct Spoken {
    std::string_view lower, unit;
  };
  constexpr std::array<Spoken, 25> kSpoken{
      {{"rad/s", "rad/s"}, {"deg/s", "deg/s"}, {"m/s", "m/s"}, {"mm/s", "mm/s"},   {"ms", "ms"},
       {"us", "us"},       {"ns", "ns"},       {"sec", "sec"}, {"mm", "mm"},       {"cm", "cm"},
       {"um", "um"},       {"deg", "deg"},     {"rad", "rad"}, {"rpm", "rpm"},     {"erpm", "erpm"},
       {"dps", "dps"},     {"nm", "Nm"},       {"kn", "kN"},   {"kg", "kg"},       {"lbf", "lbf"},
       {"kpa", "kPa"},     {"hz", "Hz"},       {"mps", "m/s"}, {"radps", "rad/s"}, {"newton", "newton"}}};
  const auto lower = lower_case(text);
  for (const auto& spoken : kSpoken)
    if (spoken.lower == lower) return known_unit(spoken.unit);
  // A word spelled out has one meaning in any case; short ones may have two (mN, MN).
  constexpr std::size_t kShortestWord = 5;
  const bool is_word = std::all_of(lower.begin(), lower.end(), is_small);
  return is_word && lower.size() >= kShortestWord ? known_unit(lower) : std::nullopt;
}

// True if the name begins with a whole word for a quantity and nothing stands behind it: "Force".
bool is_quantity(std::string_view name) {
  constexpr std::array<std::string_view, 12> kWords{"force",   "load",         "kraft",    "torque",
                                                    "moment",  "weight",       "speed",    "angle",
                                                    "voltage", "displacement", "position", "current"};
  return std::find(kWords.begin(), kWords.end(), lower_case(name)) != kWords.end();
}

// Unit after the last change from small to capital letters: "angleDeg", "timeMs", "tUs", "TimeUS". In
// "torquemNm" and "ForcekN" the small letter belongs to the unit, because a whole word stands before it. In
// "FzkN" it may belong to either: an unknown unit.
std::optional<WrittenUnit> unit_behind_a_hump(std::string_view column) {
  for (std::size_t i = column.size(); i-- > 1;) {
    if (!is_capital(column[i]) || !is_small(column[i - 1])) continue;
    if (const auto longer = known_unit(column.substr(i - 1))) {
      if (is_quantity(column.substr(0, i - 1))) return longer;
      return WrittenUnit{std::string(column.substr(i - 1)) + " or " + std::string(column.substr(i)), "", 0.0};
    }
    return unit_in_any_case(column.substr(i));
  }
  return std::nullopt;
}

// Unit in names without small letters: "TIME_MS", "FORCE KN".
std::optional<WrittenUnit> unit_in_capitals(std::string_view column) {
  const auto at = column.find_last_of("_ .");
  if (at == std::string_view::npos || std::any_of(column.begin(), column.end(), is_small))
    return std::nullopt;
  return unit_in_any_case(column.substr(at + 1));
}

// Units of several words at the end of a name: "motor_speed_rad_s", "Speed_mm_per_s", "acc_mm_s2".
std::optional<WrittenUnit> unit_of_words(std::string_view column) {
  struct Words {
    std::string_view words, unit, dimension;
    double to_si;
  };
  constexpr std::array<Words, 8> kWords{{{"rad_s", "rad/s", "angular rate", 1.0},
                                         {"deg_s", "deg/s", "angular rate", kPi / 180},
                                         {"m_s", "m/s", "speed", 1.0},
                                         {"cm_s", "cm/s", "speed", 1e-2},
                                         {"mm_s", "mm/s", "speed", 1e-3},
                                         {"m_s2", "m/s^2", "acceleration", 1.0},
                                         {"cm_s2", "cm/s^2", "acceleration", 1e-2},
                                         {"mm_s2", "mm/s^2", "acceleration", 1e-3}}};
  std::string name(column);
  if (const auto per = name.rfind("_per_s"); per != std::string::npos) name.erase(per, 4);
  for (const auto& [words, unit, dimension, to_si] : kWords) {
    if (!name.ends_with(words) || name.size() == words.size()) continue;
    const char before = name[name.size() - words.size() - 1];
    if (is_small(before) || is_capital(before)) continue;
    return WrittenUnit{std::string(unit), std::string(dimension), to_si};
  }
  return std::nullopt;
}

// A text of several words in brackets: "kN, filtered" is kN; "N, x1000" and one short or spelled-out word
// that nobody knows are unknown units; "left" and "raw data" are none.
std::optional<WrittenUnit> unit_among_words(std::string_view text) {
  const WrittenUnit unknown{std::string(text), "", 0.0};
  if (holds_factor(text)) return unknown;
  const auto words = words_beside_unit(text);
  if (words.size() == 1) {
    constexpr std::size_t kLongestSign = 6;
    const bool is_number = std::all_of(text.begin(), text.end(), [](char c) { return c >= '0' && c <= '9'; });
    const bool is_sign = characters_in(text) <= kLongestSign || begins_with_prefix(text);
    return is_sign && !is_number && !is_no_unit(text) ? std::optional(unknown) : std::nullopt;
  }
  // "500 N" is the range of a load cell.
  if (text.find_first_of("0123456789") != std::string_view::npos) return std::nullopt;
  std::optional<WrittenUnit> only;
  for (const auto& word : words) {
    auto unit = word == "in" && &word == words.data() ? std::nullopt : known_unit(word);
    if (unit && unit->dimension == "counts") unit.reset();  // "raw data", "Nm, raw"
    if (unit && only) return unknown;
    if (unit && unit->text.size() > 1) only = unit;
    if (unit && unit->text.size() == 1 && &word == words.data()) only = unit;
  }
  return only;
}

// A power of ten behind a name, as "Force*1000", "Time /1000" or "Load x10": an unknown unit. "Force/2" is
// the second of two.
std::optional<WrittenUnit> factor_behind(std::string_view column) {
  for (const std::string_view mark : {"*", "/", "\xC3\x97", " x", " X"}) {
    const auto at = column.rfind(mark);
    if (at == std::string_view::npos || at == 0) continue;
    const auto number = trimmed(column.substr(at + mark.size()));
    double factor = 0.0;
    const auto read = std::from_chars(number.data(), number.data() + number.size(), factor);
    const bool is_whole = read.ec == std::errc() && read.ptr == number.data() + number.size();
    const double power = is_whole && factor > 0.0 ? std::log10(factor) : 0.0;
    if ((power != 0.0 && power == std::round(power)) || number.starts_with("10^"))
      return WrittenUnit{std::string(trimmed(column.substr(at))), "", 0.0};
  }
  return std::nullopt;
}

// A degree sign directly behind a word, a unit in front of "since", and a unit of time behind t: "theta°",
// "ms since start", "tms".
std::optional<WrittenUnit> unit_without_mark(std::string_view column) {
  if (const auto since = column.find(" since "); since != std::string_view::npos)
    if (const auto unit = known_unit(column.substr(0, since)); unit && unit->dimension == "time") return unit;
  if (column.starts_with('t') && column.size() > 2)
    if (const auto unit = known_unit(column.substr(1)); unit && unit->dimension == "time") return unit;
  for (const std::string_view sign : {"\xC2\xB0", "\xC2\xBA", "\xCB\x9A"})
    if (column.ends_with(sign) && column.size() > sign.size()) return known_unit(sign);
  return std::nullopt;
}

// True for units divided by units, a quotient that no list may hold: "N/m", "1/s", "deg/s^2".
bool is_quotient_of_units(std::string_view text) {
  std::size_t parts = 0;
  for (;; ++parts) {
    const auto end = std::min(text.find('/'), text.size());
    auto part = trimmed(text.substr(0, end));
    if (parts > 0)  // a power: "s^2", "m2", "m²"
      for (const std::string_view power : {"\xC2\xB2", "\xC2\xB3", "2", "3", "^"})
        if (part.ends_with(power)) part.remove_suffix(power.size());
    if (!known_unit(part) && (parts > 0 || part != "1")) return false;
    if (end == text.size()) return parts > 0;
    text.remove_prefix(end + 1);
  }
}

// A unit that itself holds a slash, behind a slash as DIN 1313 writes it or behind another mark:
// "AngVel/rad/s", "v m/s", "speed_m/s". The longest tail is tried first, because "s" alone is a unit, too. A
// quotient of units that is not listed is an unknown unit: "c/N/m" is no length. One letter behind a blank or
// a point may be a label: "Sensor A/N".
std::optional<WrittenUnit> unit_with_slash(std::string_view column) {
  const auto last = column.rfind('/');
  if (last == std::string_view::npos) return std::nullopt;
  for (std::size_t at = column.find_first_of("/ _.,:|\\", 1); at < last;
       at = column.find_first_of("/ _.,:|\\", at + 1)) {
    const auto tail = trimmed(column.substr(at + 1));
    auto unit = known_unit(tail);
    if (!unit) unit = unit_in_any_case(tail);
    if (unit) return unit;
    const bool may_be_label = (column[at] == ' ' || column[at] == '.') && tail.find('/') < 2;
    if (!may_be_label && is_quotient_of_units(tail)) return WrittenUnit{std::string(tail), "", 0.0};
  }
  return std::nullopt;
}

// "F / 10^3 N", as ISO 80000-1 writes a quantity in multiples of a unit: 10^3 N. "Cell / 500 N" may be a
// range: unknown.
std::optional<WrittenUnit> unit_of_quotient(std::string_view column) {
  const auto slash = column.find('/');
  if (slash == std::string_view::npos || slash == 0) return std::nullopt;
  const auto divisor = trimmed(column.substr(slash + 1));
  if (const auto unit = scaled_unit(divisor)) return unit;
  const auto number = divisor.find_first_not_of("0123456789.");
  if (number == 0 || number == std::string_view::npos || !known_unit(divisor.substr(number)))
    return std::nullopt;
  return WrittenUnit{.text = std::string(divisor), .dimension = "", .to_si = 0.0, .beside_factor = true};
}

WrittenUnit as_acceleration(const WrittenUnit& unit, std::string_view wanted) {
  if ((unit.text != "g" && unit.text != "mg") || wanted != "acceleration") return unit;
  return {unit.text, "acceleration", unit.text == "g" ? 9.80665 : 9.80665e-3};
}

// Scales write kg and g for a force.
WrittenUnit as_wanted(const WrittenUnit& unit, std::string_view wanted) {
  if (wanted == "force" && unit.dimension == "mass" && unit.to_si > 0.0)
    return {unit.text, "force", 9.80665 * unit.to_si};
  if (wanted == "angular rate" && unit.text == "Hz") return {unit.text, "angular rate", 2 * kPi};
  return as_acceleration(unit, wanted);
}

}  // namespace

std::optional<WrittenUnit> read_unit(std::string_view written, bool in_brackets) {
  const std::string plain = in_plain_signs(trimmed(written));
  const auto text = trimmed(plain);
  if (const auto inner = text_in_brackets(text); inner && (text.front() == '[' || text.front() == '('))
    return read_unit(*inner, true);
  if (const auto unit = known_unit(text)) return unit;
  if (const auto unit = scaled_unit(text)) return unit;
  if (const auto unit = unit_of_pi(text)) return unit;
  if (!in_brackets || text.empty() || text == "-") return std::nullopt;
  if (const auto unit = unit_in_any_case(text)) return unit;
  return unit_among_words(text);
}

std::optional<WrittenUnit> unit_in_name(std::string_view written) {
  const std::string plain = in_plain_signs(trimmed(written));
  const auto column = trimmed(plain);
  if (const auto inner = text_in_brackets(column)) {
    auto unit = read_unit(*inner, true);
    if (unit && name_holds_factor(without_brackets(column))) return unit_beside_factor(column, unit->text);
    return unit;
  }
  if (const auto quotient = unit_of_quotient(column)) return quotient;
  if (stands_alone(column)) return known_unit(column);
  if (const auto unit = unit_in_capitals(column)) return unit;
  if (const auto unit = unit_of_words(column)) return unit;
  if (const auto unit = unit_without_mark(column)) return unit;
  if (const auto factor = factor_behind(column)) return factor;
  if (const auto unit = unit_with_slash(column)) return unit;
  if (const auto listed = split_unit(column))
    return WrittenUnit{std::string(listed->suffix), std::string(listed->dimension), listed->to_si};
  for (const std::string_view mark :
       {" in ", " en ", ", ", " / ", " - ", ": ", "/", "|", "\\", "_", ".", " "}) {
    const auto at = column.rfind(mark);
    if (at == std::string_view::npos || at == 0) continue;
    const auto behind = trimmed(column.substr(at + mark.size()));
    auto unit = known_unit(behind);
    if (!unit && behind.size() > 1 && mark != ".") unit = unit_in_any_case(behind);
    if (unit) unit->is_certain = unit->text.size() > 1 || (mark != " " && mark != ".");
    if (unit) return unit;
  }
  return unit_behind_a_hump(column);
}

WrittenUnit unit_beside_factor(std::string_view column, std::string_view unit) {
  const std::string name = without_brackets(column);
  std::string text;
  for (const auto word : words_beside_unit(name)) text += std::string(word) + " ";
  return {.text = text + std::string(unit), .dimension = "", .to_si = 0.0, .beside_factor = true};
}

std::optional<WrittenUnit> unit_of_channel(std::string_view channel) {
  const auto listed = split_unit(channel);
  if (!listed) return std::nullopt;
  return WrittenUnit{unit_of_key(channel), std::string(listed->dimension), listed->to_si};
}

std::optional<double> factor_between(const WrittenUnit& from, const WrittenUnit& to) {
  const auto meant = as_wanted(from, to.dimension);
  if (meant.dimension != to.dimension || meant.to_si == 0.0 || to.to_si == 0.0) return std::nullopt;
  return meant.to_si / to.to_si;
}

bool is_ratio_of_units(double ratio, std::string_view dimension) {
  std::vector<double> factors;
  for (const auto& spelling : kSpellings)
    if (spelling.dimension == dimension && spelling.to_si > 0.0) factors.push_back(spelling.to_si);
  factors.push_back(1.0);
  if (dimension == "length" || dimension == "force" || dimension == "torque")
    factors.insert(factors.end(), {1e-3, 1e-2, 1e3});
  for (const double a : factors)
    for (const double b : factors)
      if (std::abs(std::abs(ratio) / (a / b) - 1.0) < kSameScale) return true;
  return false;
}

}  // namespace sandhopper
