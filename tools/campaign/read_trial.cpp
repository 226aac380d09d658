#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "config/hint.hpp"
#include "tools/campaign/belief_sources.hpp"
#include "tools/campaign/check_channels.hpp"
#include "tools/campaign/clock_checks.hpp"
#include "tools/campaign/column_checks.hpp"
#include "tools/campaign/column_names.hpp"
#include "tools/campaign/companion.hpp"
#include "tools/campaign/exchanged_columns.hpp"
#include "tools/campaign/frozen_rows.hpp"
#include "tools/campaign/full_counters.hpp"
#include "tools/campaign/joined_press.hpp"
#include "tools/campaign/number_doubts.hpp"
#include "tools/campaign/plant_doubt.hpp"
#include "tools/campaign/position_loop.hpp"
#include "tools/campaign/read_table.hpp"
#include "tools/campaign/sample_checks.hpp"
#include "tools/campaign/sample_times.hpp"
#include "tools/campaign/second_cells.hpp"
#include "tools/campaign/shared_columns.hpp"
#include "tools/campaign/trial_recording.hpp"
#include "tools/campaign/trial_rows.hpp"
#include "tools/campaign/unit_check.hpp"

namespace sandhopper {
namespace {

using enum FindingSeverity;

class Reader {
 public:
  Reader(const Campaign& campaign, const CampaignTrial& trial) : campaign_(campaign), trial_(trial) {}

  TrialRecording run() {
    auto read = read_table(campaign_, trial_, out_.findings);
    if (!read) return std::move(out_);
    table_ = std::move(read->table);
    unusable_columns_ = std::move(read->unusable_columns);
    unit_sources_ = std::move(read->unit_sources);
    out_.own_log = read->own_log;
    file_ = places_.file = read->file;
    places_.format = trial_.format;
    if (!any_unusable(out_.findings)) take_columns();
    if (!any_unusable(out_.findings)) judge_time();
    if (!any_unusable(out_.findings)) forget_unused_columns();
    if (!any_unusable(out_.findings)) judge_plant();
    if (!any_unusable(out_.findings)) select_rows();
    if (!any_unusable(out_.findings)) judge_samples();
    return std::move(out_);
  }

  const RecordingPlaces& places() const { return places_; }

 private:
  void judge_samples() {
    if (!out_.own_log) drop_untrue_rows(out_, places_);
    if (!out_.own_log) check_times(out_, places_, trial_.format.spread_times);
    if (any_unusable(out_.findings)) return;
    join_equal_times(out_, places_);
    if (!out_.own_log) check_samples(out_, campaign_, trial_, places_);
    if (out_.has_time) note_gaps(out_, places_);
    check_channels(out_, campaign_.plant, places_);
  }

  void take_columns() {
    if (auto shared = shared_column(table_, trial_, campaign_.file.string()))
      return out_.findings.push_back(std::move(*shared));
    used_.assign(table_.names.size(), false);
    take_time();
    std::vector<std::string_view> taken{"t_s"};
    for (const auto& mapping : trial_.columns) {
      if (std::find(taken.begin(), taken.end(), mapping.channel) != taken.end()) continue;
      const bool plain =
          find_column(table_, mapping.column) == nullptr && table_.find(mapping.channel) != nullptr;
      if (plain) continue;  // The file already has a column with the channel's name.
      taken.push_back(mapping.channel);
      take_mapped(mapping);
    }
    for (std::size_t i = 0; i < table_.names.size(); ++i) {
      const auto& name = table_.names[i];
      if (used_[i] || name == trial_.rows.column) continue;
      const bool mapped = std::find(taken.begin(), taken.end(), name) != taken.end();
      if (find_channel(campaign_.plant, name) != nullptr && !mapped)
        take(i, ColumnMapping{name, name});
      else
        leave(i);
    }
    if (auto cell = second_cell(table_, file_, campaign_, trial_); cell && !out_.own_log)
      out_.findings.push_back(std::move(*cell));
  }

  void take_time() {
    const auto* mapping = mapping_of(trial_, "t_s");
    const auto* column = time_column(table_, trial_);
    places_.lines = table_.lines;
    if (column == nullptr) return count_rows();  // judge_time handles this
    const auto i = index_of(*column);
    const bool mapped = mapping != nullptr && find_column(table_, mapping->column) == column;
    const auto scale = unit_scale(i, mapped ? *mapping : ColumnMapping{"t_s", table_.names[i]});
    if (!scale) return;
    if (!(*scale > 0.0))
      return complain_at(mapping->position, FindingKind::set_up, trial_unusable, "t_s",
                         "the scale of the time must be positive",
                         "write scale = 1.0 for seconds, 0.001 for milliseconds");
    used_[i] = true;
    const auto* second =
        mapped && !mapping->plus.column.empty() ? find_column(table_, mapping->plus.column) : nullptr;
    if (mapped && !mapping->plus.column.empty() && second == nullptr)
      return complain_at(mapping->position, FindingKind::missing_column, trial_unusable, "t_s",
                         fmt::format("no column is called \"{}\"; the columns are {}", mapping->plus.column,
                                     fmt::join(table_.names, ", ")),
                         "correct plus = { column = \"NAME\" }");
    out_.t_s = *column;
    for (std::size_t row = 0; row < out_.t_s.size(); ++row) {
      double& time_s = out_.t_s[row];
      time_s = *scale * time_s + (mapped ? mapping->offset : 0.0);
      if (second != nullptr) time_s += mapping->plus.scale * (*second)[row];
    }
    if (second != nullptr) used_[index_of(*second)] = true;
    if (!out_.own_log && !has_unit_of_time(i, mapped ? mapping : nullptr)) doubt(i);
    if (!out_.own_log && second == nullptr) check_other_clocks(out_, table_, i, places_);
  }

  // [format] row_every_s: times from line numbers, so that a row that was left out leaves a gap.
  void count_rows() {
    const double step_s = trial_.format.row_every_s;
    if (!(step_s > 0.0) || table_.lines.empty()) return;
    std::uint64_t stride = std::numeric_limits<std::uint64_t>::max();
    for (std::size_t row = 1; row < table_.lines.size(); ++row)
      stride = std::min(stride, table_.lines[row] - table_.lines[row - 1]);
    for (const auto line : table_.lines)
      out_.t_s.push_back(step_s * static_cast<double>((line - table_.lines.front()) / stride));
    add(FindingKind::no_time, note, table_.layout.header_line, 1, "t_s",
        fmt::format("the file has no time; rows come every {:.6g} s, as [format] says", step_s), "");
  }

  // True if the unit is known: from the name, the row of units, the format (date, time of day) or the
  // mapping.
  bool has_unit_of_time(std::size_t i, const ColumnMapping* mapping) const {
    if (mapping != nullptr && (mapping->has_scale || !mapping->unit.empty())) return true;
    const bool is_clock = std::ranges::find(table_.clocks, table_.names[i]) != table_.clocks.end();
    return is_clock || read_unit(table_.units[i], true) || unit_in_name(table_.names[i]);
  }
  void doubt(std::size_t i) {
    if (const auto doubt = doubt_time(table_.columns[i], table_.names[i]))
      add(FindingKind::unknown_unit, trial_unusable, table_.layout.header_line, header_character(i),
          table_.names[i], doubt->what, doubt->cure);
  }

  // Reports a missing time. Force against depth is accepted without time: its rows are taken in the order of
  // the file.
  void judge_time() {
    if (time_column(table_, trial_) != nullptr || !out_.t_s.empty()) return;
    const auto* mapping = mapping_of(trial_, "t_s");
    const std::string wanted = mapping == nullptr ? "t_s" : mapping->column;
    const std::string cure = cure_for_time(table_, campaign_.plant);
    const bool force_against_depth = campaign_.plant == CampaignPlant::intruder && mapping == nullptr &&
                                     out_.has("foot_z_m") && out_.has("force_N");
    if (force_against_depth && cure.empty()) {
      out_.has_time = false;
      out_.t_s.resize(table_.rows());
      for (std::size_t row = 0; row < out_.t_s.size(); ++row) out_.t_s[row] = static_cast<double>(row);
      add(FindingKind::no_time, note, table_.layout.header_line, 1, wanted,
          "the file has no time: force against depth is read in the order of the rows, and nothing that "
          "needs a speed "
          "can be said",
          "for that add a column of the time: [columns] t_s = { column = \"NAME\", scale = 1.0 }");
      return;
    }
    add(FindingKind::no_time, trial_unusable, table_.layout.header_line, 1, wanted,
        fmt::format("no column is called \"{}\"; the columns are {}", wanted, fmt::join(table_.names, ", ")),
        cure.empty() ? "add a column of the time, in s, and name it: [columns] t_s = { column = \"NAME\", "
                       "scale = 1.0 }; rows that come evenly need none: [format] row_every_s = 0.001"
                     : cure);
  }

  void take_mapped(const ColumnMapping& mapping) {
    const auto* column = find_column(table_, mapping.column);
    if (column == nullptr) {
      const auto near = nearest_words(mapping.column, table_.names, 1);
      add(FindingKind::missing_column, channel_unusable, table_.layout.header_line, 1, mapping.column,
          fmt::format("no such column for channel {}; the columns are {}", mapping.channel,
                      fmt::join(table_.names, ", ")),
          near.empty() ? "correct [columns] or export that column"
                       : fmt::format("did you mean \"{}\"? correct [columns]", near.front()));
      return;
    }
    take(index_of(*column), mapping);
  }

  // Factor to the channel's unit; empty if the file and the mapping contradict each other.
  std::optional<double> unit_scale(std::size_t i, const ColumnMapping& mapping) {
    if (out_.own_log) return mapping.scale;
    const auto units = column_units(table_, unit_sources_, i, mapping);
    if (const auto exchanged = find_exchange(table_, trial_, campaign_.plant, units))
      return complain_of_unit(i, mapping, trial_unusable, exchanged->what, exchanged->cure), std::nullopt;
    const auto verdict = check_unit(units);
    if (!verdict.overruled.empty())
      complain_of_unit(i, mapping, note, verdict.overruled, "taken as stated in [columns]");
    if (verdict.problem.empty()) {
      places_.columns.push_back(used_column(units, verdict.scale, mapping.offset, mapping.is_stated()));
      places_.columns.back().added = mapping.added;
      return verdict.scale;
    }
    complain_of_unit(i, mapping, trial_unusable, verdict.problem, verdict.cure);
    return std::nullopt;
  }

  void complain_of_unit(std::size_t i, const ColumnMapping& mapping, FindingSeverity severity,
                        std::string_view what, std::string cure) {
    const bool by_row = table_.layout.units_line > 0 && !table_.units[i].empty();
    add(FindingKind::unit_disagrees, severity, by_row ? table_.layout.units_line : table_.layout.header_line,
        header_character(i), table_.names[i], fmt::format("for {}: {}", mapping.channel, what),
        std::move(cure));
  }

  void take(std::size_t i, const ColumnMapping& mapping) {
    used_[i] = true;
    if (is_unusable(i)) return;
    const auto scale = unit_scale(i, mapping);
    if (!scale) return;
    auto values = table_.columns[i];
    const bool empty =
        std::all_of(values.begin(), values.end(), [](double value) { return std::isnan(value); });
    if (empty) return;  // Treat it like a missing column.
    if (!out_.own_log) look_at_numbers(i, mapping);
    if (!out_.own_log) tell_done(i, mapping, put_register_back(values));
    if (!add_columns(mapping, *scale, values)) return;
    for (double& value : values) value = *scale * value + mapping.offset;
    if (!out_.own_log && mapping.channel.ends_with("position_rad"))
      tell_done(i, mapping, put_angle_back(values));
    out_.channels.push_back({mapping.channel, std::move(values)});
    places_.numbers.push_back(table_.numbers[i]);
  }

  void look_at_numbers(std::size_t i, const ColumnMapping& mapping) {
    for (auto& finding : doubts_of_numbers(table_, file_, trial_, i, mapping.is_stated()))
      out_.findings.push_back(std::move(finding));
  }

  bool is_unusable(std::size_t i) const {
    return std::ranges::find(unusable_columns_, table_.names[i]) != unusable_columns_.end();
  }

  // Adds the further columns of a mapping to the values of the first, in its unit. False: a finding says why
  // not.
  bool add_columns(const ColumnMapping& mapping, double scale, std::vector<double>& values) {
    for (const auto& name : mapping.added) {
      const auto* column = find_column(table_, name);
      if (column == nullptr)
        return complain_at(mapping.position, FindingKind::missing_column, trial_unusable, mapping.channel,
                           fmt::format("no column is called \"{}\"; the columns are {}", name,
                                       fmt::join(table_.names, ", ")),
                           "correct column = [\"NAME\", \"NAME\"]"),
               false;
      const auto i = index_of(*column);
      auto other = mapping;
      other.column = name, used_[i] = true;
      if (is_unusable(i)) return false;
      const auto verdict = check_unit(column_units(table_, unit_sources_, i, other));
      if (!verdict.problem.empty())
        return complain_of_unit(i, other, trial_unusable, verdict.problem, verdict.cure), false;
      look_at_numbers(i, other);
      auto more = *column;
      tell_done(i, other, put_register_back(more));
      for (std::size_t row = 0; row < values.size(); ++row) values[row] += verdict.scale / scale * more[row];
    }
    return true;
  }

  void tell_done(std::size_t i, const ColumnMapping& mapping, const std::string& done) {
    if (!done.empty())
      add(FindingKind::file_format, note, table_.layout.header_line, header_character(i), table_.names[i],
          fmt::format("for {}: {}", mapping.channel, done), "");
  }

  void leave(std::size_t i) {
    out_.unused_columns.push_back(table_.names[i]);
    auto finding = misnamed_column(table_, file_, campaign_.plant, trial_, i);
    if (!finding) return;
    finding->column = header_character(i);
    out_.findings.push_back(std::move(*finding));
  }

  // Drops findings in columns that are not used.
  void forget_unused_columns() {
    std::erase_if(out_.findings, [&](const Finding& finding) {
      const bool in_cells = finding.kind == FindingKind::non_numeric_cell ||
                            finding.kind == FindingKind::nan_cell ||
                            finding.kind == FindingKind::duplicate_column;
      return in_cells && std::find(out_.unused_columns.begin(), out_.unused_columns.end(), finding.channel) !=
                             out_.unused_columns.end();
    });
  }

  void judge_plant() {
    const bool own = std::any_of(out_.channels.begin(), out_.channels.end(), [&](const auto& channel) {
      return find_channel(campaign_.plant, channel.name) != nullptr;
    });
    if (own || any_lost_column()) return;
    auto doubt = doubt_plant(table_, campaign_.plant);
    add(doubt.kind, trial_unusable, table_.layout.header_line,
        doubt.first ? header_character(*doubt.first) : 1, std::move(doubt.channel), std::move(doubt.what),
        doubt.cure);
  }

  // True if a column of a channel holds no numbers. Its own message names it, and no other column is in
  // doubt.
  bool any_lost_column() {
    const auto is_of_channel = [&](const std::string& name) {
      return find_channel(campaign_.plant, name) != nullptr ||
             std::ranges::find(trial_.columns, name, &ColumnMapping::column) != trial_.columns.end();
    };
    const auto lost = std::ranges::find_if(unusable_columns_, is_of_channel), end = unusable_columns_.end();
    if (lost == end) return false;
    add(FindingKind::missing_column, trial_unusable, table_.layout.header_line, 1, *lost,
        "no channel is left: the cells of this column are no numbers", "see its own message");
    return true;
  }

  void select_rows() {
    const auto& rows = trial_.rows;
    const auto* column = rows.column.empty() ? nullptr : table_.find(rows.column);
    if (!rows.column.empty() && column == nullptr) {
      complain(FindingKind::missing_column, trial_unusable,
               fmt::format("the column \"{}\" to select rows by is not in {}", rows.column, file_),
               "correct select in this trial");
      return;
    }
    const auto keep = selected_rows(rows, out_.t_s, column);
    table_ = {};
    if (rows.selects() && keep.size() < kFewestSelectedRows)
      complain_at(trial_.position, FindingKind::empty_file, trial_unusable,
                  fmt::format("trial {}", trial_.entry), selection_text(rows, out_.t_s, keep, file_),
                  "from_s and to_s are seconds, after unit, scale and offset of t_s: correct select in this "
                  "trial, or the unit of the time");
    if (!keep.empty() && keep.size() != out_.t_s.size()) keep_rows(out_, places_, keep);
  }

  std::uint64_t header_character(std::size_t i) const {
    return places_.character(table_.layout.header_line, table_.numbers[i]);
  }

  std::size_t index_of(const std::vector<double>& column) const {
    return static_cast<std::size_t>(&column - table_.columns.data());
  }

  void add(FindingKind kind, FindingSeverity severity, std::uint64_t line, std::uint64_t column,
           std::string channel, std::string what, std::string_view cure) {
    out_.findings.push_back(
        {kind, severity, file_, line, column, std::move(channel), std::move(what), std::string(cure)});
  }
  void complain_at(ConfigPosition at, FindingKind kind, FindingSeverity severity, std::string key,
                   std::string what, std::string cure) {
    out_.findings.push_back({kind, severity, campaign_.file.string(), at.line, at.column, std::move(key),
                             std::move(what), std::move(cure)});
  }
  // Finding at the position of the trial's entry in campaign.toml.
  void complain(FindingKind kind, FindingSeverity severity, std::string what, std::string cure) {
    complain_at(trial_.position, kind, severity, "file", std::move(what), std::move(cure));
  }

  const Campaign& campaign_;
  const CampaignTrial& trial_;
  TrialRecording out_;
  CsvTable table_;
  std::string file_;
  RecordingPlaces places_;
  std::vector<bool> used_;  // Columns that became a channel.
  std::vector<std::string> unusable_columns_;
  std::vector<std::string> unit_sources_;
};

}  // namespace

TrialRecording read_trial(const Campaign& campaign, const CampaignTrial& trial,
                          const std::function<bool(std::string_view key)>& can_do_without) {
  Reader first(campaign, trial);
  auto recording = first.run();
  for (const auto& number : trial.unstated)
    recording.findings.push_back(
        finding_of(number, !can_do_without(number.key) && !is_replaced(number.key, trial.belief)));
  for (const auto& companion : trial.companions) {
    const auto other = trial_of(companion, trial);
    Reader second(campaign, other);
    auto more = second.run();
    const JoinedPress press(recording, first.places(), more, second.places());
    join_companion(recording, std::move(more), other.file.string());
    press.check(recording, campaign, trial);
  }
  if (recording.usable()) add_position_loop(recording, trial);
  return recording;
}

}  // namespace sandhopper
