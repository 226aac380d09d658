#include "tools/campaign/written_unit.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <vector>

#include "config/hint.hpp"

namespace sandhopper {
namespace {

constexpr double kPi = std::numbers::pi;

struct Spelling {
  std::string_view written;  // without blanks, case-sensitive
  std::string_view dimension;
  double to_si;
};

// In addition to the suffixes of config/hint.hpp. Factors: BIPM, The International System of Units, 9th ed.
// (2019), table 8; pound, foot, inch: NIST SP 811 (2008), appendix B; kgf = 9.80665 N (CGPM 1901).
constexpr std::array kSpellings{
    Spelling{"\xC2\xB5m", "length", 1e-6},
    Spelling{"\xCE\xBCm", "length", 1e-6},
    Spelling{"micron", "length", 1e-6},
    Spelling{"millimeter", "length", 1e-3},
    Spelling{"millimeters", "length", 1e-3},
    Spelling{"millimetre", "length", 1e-3},
    Spelling{"millimetres", "length", 1e-3},
    Spelling{"centimeter", "length", 1e-2},
    Spelling{"centimeters", "length", 1e-2},
    Spelling{"meter", "length", 1.0},
    Spelling{"meters", "length", 1.0},
    Spelling{"metre", "length", 1.0},
    Spelling{"metres", "length", 1.0},
    Spelling{"inch", "length", 0.0254},
    Spelling{"inches", "length", 0.0254},
    Spelling{"\"", "length", 0.0254},
    Spelling{"feet", "length", 0.3048},
    Spelling{"mil", "length", 2.54e-5},
    Spelling{"mils", "length", 2.54e-5},
    Spelling{"thou", "length", 2.54e-5},
    Spelling{"km", "length", 1e3},
    Spelling{"nm", "length", 1e-9},
    Spelling{"sec", "time", 1.0},
    Spelling{"secs", "time", 1.0},
    Spelling{"second", "time", 1.0},
    Spelling{"seconds", "time", 1.0},
    Spelling{"Sekunden", "time", 1.0},
    Spelling{"msec", "time", 1e-3},
    Spelling{"millis", "time", 1e-3},
    Spelling{"milliseconds", "time", 1e-3},
    Spelling{"usec", "time", 1e-6},
    Spelling{"micros", "time", 1e-6},
    Spelling{"microseconds", "time", 1e-6},
    Spelling{"\xC2\xB5s", "time", 1e-6},
    Spelling{"\xCE\xBCs", "time", 1e-6},
    Spelling{"nsec", "time", 1e-9},
    Spelling{"nanos", "time", 1e-9},
    Spelling{"nanoseconds", "time", 1e-9},
    Spelling{"min", "time", 60.0},
    Spelling{"h", "time", 3600.0},
    Spelling{"hr", "time", 3600.0},
    Spelling{"\xC2\xB0", "angle", kPi / 180},
    Spelling{"degree", "angle", kPi / 180},
    Spelling{"degrees", "angle", kPi / 180},
    Spelling{"Grad", "angle", kPi / 180},
    Spelling{"DEG", "angle", kPi / 180},
    Spelling{"Deg", "angle", kPi / 180},
    Spelling{"radian", "angle", 1.0},
    Spelling{"radians", "angle", 1.0},
    Spelling{"rev", "angle", 2 * kPi},
    Spelling{"revs", "angle", 2 * kPi},
    Spelling{"turn", "angle", 2 * kPi},
    Spelling{"turns", "angle", 2 * kPi},
    Spelling{"gon", "angle", kPi / 200},
    Spelling{"rad/s", "angular rate", 1.0},
    Spelling{"rads", "angular rate", 1.0},
    Spelling{"rad/sec", "angular rate", 1.0},
    Spelling{"rads-1", "angular rate", 1.0},
    Spelling{"rad*s^-1", "angular rate", 1.0},
    Spelling{"rads^-1", "angular rate", 1.0},
    Spelling{"deg/s", "angular rate", kPi / 180},
    Spelling{"deg/sec", "angular rate", kPi / 180},
    Spelling{"dps", "angular rate", kPi / 180},
    Spelling{"\xC2\xB0/s", "angular rate", kPi / 180},
    Spelling{"mrad/s", "angular rate", 1e-3},
    Spelling{"RPM", "angular rate", kPi / 30},
    Spelling{"1/min", "angular rate", kPi / 30},
    Spelling{"U/min", "angular rate", kPi / 30},
    Spelling{"rev/min", "angular rate", kPi / 30},
    Spelling{"r/min", "angular rate", kPi / 30},
    Spelling{"tr/min", "angular rate", kPi / 30},
    Spelling{"min-1", "angular rate", kPi / 30},
    Spelling{"min^-1", "angular rate", kPi / 30},
    Spelling{"rev/s", "angular rate", 2 * kPi},
    Spelling{"rps", "angular rate", 2 * kPi},
    Spelling{"turns/s", "angular rate", 2 * kPi},
    Spelling{"m/s", "speed", 1.0},
    Spelling{"m/sec", "speed", 1.0},
    Spelling{"ms-1", "speed", 1.0},
    Spelling{"ms^-1", "speed", 1.0},
    Spelling{"mm/s", "speed", 1e-3},
    Spelling{"mm/sec", "speed", 1e-3},
    Spelling{"cm/s", "speed", 1e-2},
    Spelling{"mm/min", "speed", 1e-3 / 60},
    Spelling{"km/h", "speed", 1 / 3.6},
    Spelling{"kmh", "speed", 1 / 3.6},
    Spelling{"in/s", "speed", 0.0254},
    Spelling{"ft/s", "speed", 0.3048},
    Spelling{"m/s^2", "acceleration", 1.0},
    Spelling{"m/s2", "acceleration", 1.0},
    Spelling{"m/s\xC2\xB2", "acceleration", 1.0},
    Spelling{"m/s/s", "acceleration", 1.0},
    Spelling{"ms-2", "acceleration", 1.0},
    Spelling{"m*s^-2", "acceleration", 1.0},
    Spelling{"mm/s^2", "acceleration", 1e-3},
    Spelling{"mm/s2", "acceleration", 1e-3},
    Spelling{"cm/s^2", "acceleration", 1e-2},
    Spelling{"Gal", "acceleration", 1e-2},
    Spelling{"G", "acceleration", 9.80665},
    Spelling{"g0", "acceleration", 9.80665},
    Spelling{"mG", "acceleration", 9.80665e-3},
    Spelling{"ft/s^2", "acceleration", 0.3048},
    Spelling{"newton", "force", 1.0},
    Spelling{"newtons", "force", 1.0},
    Spelling{"Newton", "force", 1.0},
    Spelling{"Newtons", "force", 1.0},
    Spelling{"MN", "force", 1e6},
    Spelling{"uN", "force", 1e-6},
    Spelling{"lb", "force", 4.4482216152605},
    Spelling{"lbs", "force", 4.4482216152605},
    Spelling{"kp", "force", 9.80665},
    Spelling{"daN", "force", 10.0},
    Spelling{"dyn", "force", 1e-5},
    Spelling{"ozf", "force", 0.27801385},
    Spelling{"kN/m2", "pressure", 1e3},
    Spelling{"kN/m\xC2\xB2", "pressure", 1e3},
    Spelling{"N/m2", "pressure", 1.0},
    Spelling{"N/m\xC2\xB2", "pressure", 1.0},
    Spelling{"N/mm2", "pressure", 1e6},
    Spelling{"N/mm\xC2\xB2", "pressure", 1e6},
    Spelling{"N/cm2", "pressure", 1e4},
    Spelling{"N/cm\xC2\xB2", "pressure", 1e4},
    Spelling{"atm", "pressure", 101325.0},
    Spelling{"N*m", "torque", 1.0},
    Spelling{"N.m", "torque", 1.0},
    Spelling{"N-m", "torque", 1.0},
    Spelling{"N\xC2\xB7m", "torque", 1.0},
    Spelling{"N\xE2\x8B\x85m", "torque", 1.0},
    Spelling{"mN*m", "torque", 1e-3},
    Spelling{"mN.m", "torque", 1e-3},
    Spelling{"mN\xC2\xB7m", "torque", 1e-3},
    Spelling{"Nmm", "torque", 1e-3},
    Spelling{"N.mm", "torque", 1e-3},
    Spelling{"N*mm", "torque", 1e-3},
    Spelling{"kNm", "torque", 1e3},
    Spelling{"N\xC2\xB7"
             "cm",
             "torque", 1e-2},
    Spelling{"kgf.cm", "torque", 0.0980665},
    Spelling{"kgf*cm", "torque", 0.0980665},
    Spelling{"kgcm", "torque", 0.0980665},
    Spelling{"kg.cm", "torque", 0.0980665},
    Spelling{"kg*cm", "torque", 0.0980665},
    Spelling{"lbf*in", "torque", 0.1129848},
    Spelling{"in-lb", "torque", 0.1129848},
    Spelling{"lb-in", "torque", 0.1129848},
    Spelling{"ft-lb", "torque", 1.3558179},
    Spelling{"lb-ft", "torque", 1.3558179},
    Spelling{"ozin", "torque", 0.00706155},
    Spelling{"oz-in", "torque", 0.00706155},
    Spelling{"amps", "current", 1.0},
    Spelling{"Amps", "current", 1.0},
    Spelling{"Ampere", "current", 1.0},
    Spelling{"volt", "voltage", 1.0},
    Spelling{"volts", "voltage", 1.0},
    Spelling{"Volts", "voltage", 1.0},
    Spelling{"uV", "voltage", 1e-6},
    Spelling{"mV/V", "voltage ratio", 1e-3},
    Spelling{"\xC2\xB0\x43", "temperature", 1.0},
    Spelling{"degC", "temperature", 1.0},
    Spelling{"Celsius", "temperature", 1.0},
    Spelling{"degF", "temperature", 0.0},
    Spelling{"%", "share", 1e-2},
    Spelling{"oz", "mass", 0.0283495},
    Spelling{"t", "mass", 1e3},
    Spelling{"kilogram", "mass", 1.0},
    Spelling{"grams", "mass", 1e-3},
    Spelling{"erpm", "electrical speed: that of the axis times its pole pairs", 0.0},
    Spelling{"ERPM", "electrical speed: that of the axis times its pole pairs", 0.0},
    Spelling{"counts", "counts", 0.0},
    Spelling{"count", "counts", 0.0},
    Spelling{"cnt", "counts", 0.0},
    Spelling{"ticks", "counts", 0.0},
    Spelling{"raw", "counts", 0.0},
    Spelling{"LSB", "counts", 0.0},
    Spelling{"adc", "counts", 0.0},
    Spelling{"ADC", "counts", 0.0},
    Spelling{"bits", "counts", 0.0},
    Spelling{"digits", "counts", 0.0}};

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
  for (const auto& spelling : kSpellings)
    if (spelling.written == name)
      return WrittenUnit{std::string(text), std::string(spelling.dimension), spelling.to_si};
  const auto listed = split_unit("x_" + name);
  if (listed && listed->quantity == "x")
    return WrittenUnit{std::string(text), std::string(listed->dimension), listed->to_si};
  return std::nullopt;
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
  constexpr std::array<Spoken, 21> kSpoken{
      {{"ms", "ms"},        {"us", "us"},   {"ns", "ns"},   {"sec", "sec"}, {"mm", "mm"},
       {"cm", "cm"},        {"um", "um"},   {"deg", "deg"}, {"rad", "rad"}, {"rpm", "rpm"},
       {"erpm", "erpm"},    {"dps", "dps"}, {"nm", "Nm"},   {"kn", "kN"},   {"kg", "kg"},
       {"lbf", "lbf"},      {"kpa", "kPa"}, {"hz", "Hz"},   {"mps", "m/s"}, {"radps", "rad/s"},
       {"newton", "newton"}}};
  const auto lower = lower_case(text);
  for (const auto& spoken : kSpoken)
    if (spoken.lower == lower) return known_unit(spoken.unit);
  return std::nullopt;
}

// Unit after the last change from small to capital letters: "angleDeg", "timeMs", "tUs", "TimeUS". Ambiguous
// names give none: in "torquemNm" the m may belong to the word or to the unit.
std::optional<WrittenUnit> unit_behind_a_hump(std::string_view column) {
  for (std::size_t i = column.size(); i-- > 1;) {
    if (!is_capital(column[i]) || !is_small(column[i - 1])) continue;
    if (known_unit(column.substr(i - 1))) return std::nullopt;
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

// Text in the last brackets of the name.
std::optional<std::string_view> bracketed(std::string_view name) {
  for (const auto& [open, close] : {std::pair{'[', ']'}, std::pair{'(', ')'}}) {
    const auto end = name.rfind(close);
    const auto begin = name.rfind(open, end);
    if (end == std::string_view::npos || begin == std::string_view::npos || end < begin + 2) continue;
    return trimmed(name.substr(begin + 1, end - begin - 1));
  }
  return std::nullopt;
}

WrittenUnit as_acceleration(const WrittenUnit& unit, std::string_view wanted) {
  if (unit.text != "g" || wanted != "acceleration") return unit;
  return {unit.text, "acceleration", 9.80665};
}

// Scales write kg and g for a force.
WrittenUnit as_wanted(const WrittenUnit& unit, std::string_view wanted) {
  if (wanted == "force" && unit.dimension == "mass" && unit.to_si > 0.0)
    return {unit.text, "force", 9.80665 * unit.to_si};
  if (wanted == "angular rate" && unit.text == "Hz") return {unit.text, "angular rate", 2 * kPi};
  return as_acceleration(unit, wanted);
}

}  // namespace

std::optional<WrittenUnit> read_unit(std::string_view text, bool in_brackets) {
  text = trimmed(text);
  if (const auto inner = bracketed(text); inner && (text.front() == '[' || text.front() == '('))
    return read_unit(*inner, true);
  if (const auto unit = known_unit(text)) return unit;
  // One short word in brackets is taken as an unknown unit; "(left)", "(raw data)" and "(1)" are not units.
  const bool worded =
      text.find(' ') != std::string_view::npos || text.size() > 6 || text.empty() || text == "-";
  const bool numbered = std::all_of(text.begin(), text.end(), [](char c) { return c >= '0' && c <= '9'; });
  if (!in_brackets || worded || numbered || is_no_unit(text)) return std::nullopt;
  return WrittenUnit{std::string(text), "", 0.0};
}

std::optional<WrittenUnit> unit_in_name(std::string_view column) {
  column = trimmed(column);
  if (const auto inner = bracketed(column)) return read_unit(*inner, true);
  if (stands_alone(column)) return known_unit(column);
  if (const auto unit = unit_in_capitals(column)) return unit;
  // Units of several words: "motor_speed_rad_s", "force_N_per_m".
  if (column.ends_with("rad_s")) return WrittenUnit{"rad/s", "angular rate", 1.0};
  if (column.ends_with("deg_s")) return WrittenUnit{"deg/s", "angular rate", kPi / 180};
  if (column.ends_with("m_s2")) return WrittenUnit{"m/s^2", "acceleration", 1.0};
  if (column.ends_with("mm_s")) return WrittenUnit{"mm/s", "speed", 1e-3};
  if (column.ends_with("_m_s")) return WrittenUnit{"m/s", "speed", 1.0};
  if (const auto listed = split_unit(column))
    return WrittenUnit{std::string(listed->suffix), std::string(listed->dimension), listed->to_si};
  for (const std::string_view mark : {" in ", ", ", " / ", "/", "_", ".", " "}) {
    const auto at = column.rfind(mark);
    if (at == std::string_view::npos || at == 0) continue;
    auto unit = known_unit(column.substr(at + mark.size()));
    if (unit) unit->is_certain = unit->text.size() > 1 || (mark != " " && mark != ".");
    if (unit) return unit;
  }
  return unit_behind_a_hump(column);
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
