#pragma once
#include <optional>
#include <string>
#include <string_view>

namespace sandhopper {

// A unit as people write it: "mm", "N·m", "°", "deg/s", "1/min", "m/s²".
struct WrittenUnit {
  std::string text;       // as written, without brackets
  std::string dimension;  // "length", "force", … as in config/hint.hpp; empty: no unit that is known here
  double to_si = 0.0;     // 0: not a plain multiple of the SI unit
  bool is_certain =
      true;  // false for one letter behind a blank, which may be a number's or a side's ("Sensor A")
};

// Nothing for a text that is no unit ("-", "", "total"); a unit in brackets that is not known here comes back
// without a dimension. `in_brackets`: the text stood in [ ] or ( ) and is therefore meant as a unit.
std::optional<WrittenUnit> read_unit(std::string_view text, bool in_brackets);

// The unit at the end of a column's name: "Sinkage (mm)", "force_kN", "Winkel [°]", "Speed, rpm", "Kraft /
// N", "Kraft in N", or the whole name ("rpm").
std::optional<WrittenUnit> unit_in_name(std::string_view column);

// The unit of a channel, from its suffix: "foot_z_m" is a length in m.
std::optional<WrittenUnit> unit_of_channel(std::string_view channel);

// Factor from numbers in `from` to numbers in `to`; nothing where the dimensions differ or a factor alone
// does not do it. "g" is an acceleration where an acceleration is wanted, else a mass.
std::optional<double> factor_between(const WrittenUnit& from, const WrittenUnit& to);

// True where `ratio` is that of two listed units of the dimension (1000, 57.3, 4.448 …), within kSameScale.
bool is_ratio_of_units(double ratio, std::string_view dimension);

// Scales that differ by less are one scale, written with few digits (0.01745 for a degree). The nearest two
// units of one dimension, kgf and 10 N, differ by 2 %.
inline constexpr double kSameScale = 0.005;

}  // namespace sandhopper
