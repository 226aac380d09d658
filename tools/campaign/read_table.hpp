#pragma once
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "firmware/log/csv_import.hpp"
#include "tools/campaign/trial_recording.hpp"
#include "tools/campaign/unit_check.hpp"

namespace sandhopper {

// A trial's file as a table, before columns become channels.
struct TrialTable {
  CsvTable table{};
  std::string file{};
  bool own_log = false;
  // Unusable columns: most cells are not numbers, or the name occurs twice.
  std::vector<std::string> unusable_columns{};
  // For each column the words for the place of its unit ("line 3, \"Force unit: kN\", says"), if that is not
  // the row of units; see text_checks.
  std::vector<std::string> unit_sources{};
};

// Finds the file (a recording, or a folder that holds one), reads it, and adds its problems to `findings`.
// Returns an empty optional if there is no table.
std::optional<TrialTable> read_table(const Campaign& campaign, const CampaignTrial& trial,
                                     std::vector<Finding>& findings);

// The trial's mapping for a channel; null if there is none. A mapping of the trial precedes that of the
// campaign.
const ColumnMapping* mapping_of(const CampaignTrial& trial, std::string_view channel);
// Column with that name, null if there is none. A comment mark in front of the name ("# t_s") is ignored.
const std::vector<double>* find_column(const CsvTable& table, std::string_view name);
// The mapped time column, else t_s; null if there is neither.
const std::vector<double>* time_column(const CsvTable& table, const CampaignTrial& trial);

// A column for check_unit. `sources`: TrialTable::unit_sources. Columns that are added are each in the unit
// of their own, unless the mapping states one.
ColumnUnits column_units(const CsvTable& table, const std::vector<std::string>& sources, std::size_t column,
                         const ColumnMapping& mapping);

// The column of a hop's phase, and the words that it may hold in place of 0, 1, 2, in one sentence.
std::string phase_column(const CampaignTrial& trial);
std::string phase_names();

// "Time (s)", "timestamp", "t", "millis", "Zeit".
bool is_called_time(std::string_view name);
// Column that looks like a time by its name or unit; t_s itself is not considered.
std::optional<std::size_t> time_like_column(const CsvTable& table, CampaignPlant plant);
// Advice for a file without a time column: the column that looks like one, with its scale. Empty if there is
// none.
std::string cure_for_time(const CsvTable& table, CampaignPlant plant);

}  // namespace sandhopper
