#pragma once
#include <iosfwd>
#include <optional>
#include <string>
#include <vector>

#include "tools/campaign/flag_columns.hpp"
#include "tools/campaign/names_again.hpp"
#include "tools/campaign/preamble_units.hpp"
#include "tools/campaign/read_table.hpp"
#include "tools/campaign/time_texts.hpp"
#include "tools/campaign/units_by_row.hpp"

namespace sandhopper {

// Facts that only the text of a file shows; its numbers do not.
struct TableText {
  std::vector<NamesLine> names_again{};
  std::vector<std::string> grouped{};  // index as in CsvTable::names: a cell with thousands or decimals
  std::vector<UnitsByRow> units_by_row{};
  std::vector<PreambleUnit> units_above{};
  std::optional<TimeTextDoubt> time{};
  std::vector<FlagColumn> flags{};
};

struct TextRange {
  std::optional<std::size_t> time{};                     // column of the times; empty: they are not compared
  std::uint64_t first_line = 0, last_line = UINT64_MAX;  // the times between are compared
};
// Reads the file a second time.
TableText look_at_text(std::istream& in, const CsvTable& table, const CsvFormat& format,
                       const TextRange& range);

// Writes units that stand above the names, or in every row of a column of their own, into `units` of the
// table. `dimensions`: of each column, or empty. Returns for each column the words for the place of that
// unit.
std::vector<std::string> take_units_of_text(const TableText& text, CsvTable& table,
                                            const std::vector<std::string>& dimensions);

// Adds what the text says against the columns that the trial uses.
void check_text(std::istream& in, const Campaign& campaign, const CampaignTrial& trial, TrialTable& table,
                std::vector<Finding>& findings);

}  // namespace sandhopper
