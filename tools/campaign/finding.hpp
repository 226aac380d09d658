#pragma once
#include <cstdint>
#include <string>
#include <vector>

#include "config/fields.hpp"

namespace sandhopper {

// Kind of a problem in a recording or in campaign.toml.
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
  file_format,     // The format of the file is unusual or unknown.
  unit_disagrees,  // the file and campaign.toml state different units
  coarse_time,     // times with too few digits
  held_samples,    // Repeated values, or zeros filled in between true samples.
  implausible      // Impossible on this plant; probably a wrong unit.
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

// Consequence. note: only what the text names is left out. channel_unusable: the channel is lost.
// trial_unusable: the trial is lost.
enum class FindingSeverity : std::uint8_t { note, channel_unusable, trial_unusable };
template <>
struct EnumNames<FindingSeverity> {
  static constexpr std::array<std::string_view, 3> value{"note", "channel_unusable", "trial_unusable"};
};

// One problem: its place, its cause, and what the user can do.
struct Finding {
  FindingKind kind{};
  FindingSeverity severity{};
  std::string file;
  // From 1; 0: the whole file. In a .mcap log: the row that `hop export` would write.
  std::uint64_t line = 0;
  std::uint64_t column = 0;  // character in the line, from 1
  std::string channel{};     // Name of the column, channel or key; may be empty.
  std::string what{};
  std::string cure{};

  bool operator==(const Finding&) const = default;
};

std::string to_string(const Finding& finding);

// The findings as lines, in their order. A problem that several files share (the same words apart from
// numbers) is one line: that of its first file, with the number of the others. Equal findings are one line,
// too.
std::vector<std::string> in_lines(const std::vector<Finding>& findings, bool with_severity);

bool any_unusable(const std::vector<Finding>& findings);  // True if a finding makes the trial unusable.

}  // namespace sandhopper
