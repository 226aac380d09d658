#pragma once
#include <cstdint>
#include <string>
#include <vector>

#include "config/fields.hpp"

namespace sandhopper {

// What is wrong with a recording or with the campaign's own file.
enum class FindingKind : std::uint8_t {
  missing_file,
  unreadable_file,
  empty_file,
  no_header,
  no_time,
  ragged_row,
  non_numeric_cell,
  nan_cell,
  time_backwards,
  time_stands_still,
  duplicate_column,
  unknown_unit,
  unknown_column,
  missing_column,
  gap,
  saturated,
  stuck,
  wrong_plant,
  set_up,
  file_format,     // how the file is written, where that is unusual or not known
  unit_disagrees,  // the file and campaign.toml state different units
  coarse_time,     // times with too few digits
  held_samples,    // values repeated, or zeros filled in, between true samples
  implausible      // not possible on this plant: a unit is likely to be wrong
};
template <>
struct EnumNames<FindingKind> {
  static constexpr std::array<std::string_view, 24> value{"missing_file",
                                                          "unreadable_file",
                                                          "empty_file",
                                                          "no_header",
                                                          "no_time",
                                                          "ragged_row",
                                                          "non_numeric_cell",
                                                          "nan_cell",
                                                          "time_backwards",
                                                          "time_stands_still",
                                                          "duplicate_column",
                                                          "unknown_unit",
                                                          "unknown_column",
                                                          "missing_column",
                                                          "gap",
                                                          "saturated",
                                                          "stuck",
                                                          "wrong_plant",
                                                          "set_up",
                                                          "file_format",
                                                          "unit_disagrees",
                                                          "coarse_time",
                                                          "held_samples",
                                                          "implausible"};
};

// What it costs: nothing but what the text says was left out, the whole channel, or the whole trial.
enum class FindingSeverity : std::uint8_t { note, channel_unusable, trial_unusable };
template <>
struct EnumNames<FindingSeverity> {
  static constexpr std::array<std::string_view, 3> value{"note", "channel_unusable", "trial_unusable"};
};

// One thing that is wrong, where, and what the user can do about it.
struct Finding {
  FindingKind kind{};
  FindingSeverity severity{};
  std::string file;
  std::uint64_t line = 0;  // from 1; 0: the file as a whole. In a .mcap log: the row `hop export` would write
  std::uint64_t column = 0;  // character of the line, from 1
  std::string channel{};     // the column's, channel's or key's name, where one is meant
  std::string what{};
  std::string cure{};

  bool operator==(const Finding&) const = default;
};

// "file:line:column: channel: what; cure"
std::string to_string(const Finding& finding);

bool any_unusable(const std::vector<Finding>& findings);  // a finding that rules the trial out

}  // namespace sandhopper
