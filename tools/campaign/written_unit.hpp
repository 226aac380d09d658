#pragma once
#include <optional>
#include <string>
#include <string_view>

namespace sandhopper {

// A unit as users write it: "mm", "N·m", "°", "deg/s", "1/min", "m/s²".
struct WrittenUnit {
  std::string text;            // as written, without brackets
  std::string dimension;       // "length", "force", … as in config/hint.hpp; empty: unknown unit
  double to_si = 0.0;          // 0: not a plain multiple of the SI unit
  bool is_certain = true;      // False for one letter after a blank, which may be a label ("Sensor A").
  bool beside_factor = false;  // A factor stands in the name ("Force x10 (N)"): an unknown unit.
};

// Reads a unit. Empty for a text that is no unit ("-", "", "total"); an unknown unit in brackets has no
// dimension. `in_brackets`: the text stood in [ ] or ( ) and therefore is meant as a unit.
std::optional<WrittenUnit> read_unit(std::string_view text, bool in_brackets);

// Unit at the end of a column's name: "Sinkage (mm)", "force_kN", "Winkel [°]", "Speed, rpm", "Kraft / N",
// "Kraft in N", or the whole name ("rpm").
std::optional<WrittenUnit> unit_in_name(std::string_view column);

// The unit of a column whose name holds a factor, as "Force x10" above N: unknown.
WrittenUnit unit_beside_factor(std::string_view column, std::string_view unit);

// Unit of a channel, from its suffix: "foot_z_m" is a length in m.
std::optional<WrittenUnit> unit_of_channel(std::string_view channel);

// Factor from numbers in `from` to numbers in `to`. Empty if the dimensions differ or a factor is not enough.
// "g" is an acceleration if `to` is one, else a mass.
std::optional<double> factor_between(const WrittenUnit& from, const WrittenUnit& to);

// True if `ratio` is that of two listed units of the dimension (1000, 57.3, 4.448 …), within kSameScale.
bool is_ratio_of_units(double ratio, std::string_view dimension);

// Scales with a smaller relative difference are the same, written with few digits (0.01745 for a degree). The
// nearest two units of one dimension, kgf and 10 N, differ by 2 %.
inline constexpr double kSameScale = 0.005;

}  // namespace sandhopper
