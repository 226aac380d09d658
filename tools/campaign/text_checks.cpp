#include "tools/campaign/text_checks.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <istream>

#include "tools/campaign/grouped_digits.hpp"
#include "tools/campaign/preamble_units.hpp"
#include "tools/campaign/written_unit.hpp"

namespace sandhopper {
namespace {

using enum FindingSeverity;

std::string without(std::string text, char mark) {
  std::erase(text, mark);
  return text;
}

class TextChecker {
 public:
  TextChecker(const Campaign& campaign, const CampaignTrial& trial, TrialTable& table,
              std::vector<Finding>& findings)
      : campaign_(campaign), trial_(trial), out_(table), table_(table.table), findings_(findings) {}

  void run(std::istream& in) {
    const auto* time = time_column(table_, trial_);
    const auto* mapping = mapping_of(trial_, "t_s");
    const bool is_one = trial_.rows.column.empty() && (mapping == nullptr || mapping->plus.column.empty());
    TextRange range{.first_line = trial_.rows.from_line, .last_line = trial_.rows.to_line};
    if (time != nullptr && is_one) range.time = index_of(*time);
    find_used_columns(time);
    const auto text = look_at_text(in, table_, trial_.format, range);
    out_.unit_sources = take_units_of_text(text, table_, dimensions_);
    complain_of_names(text.names_again);
    complain_of_groups(text.grouped);
    complain_of_units(text.units_by_row);
    for (const auto& flag : text.flags) tell_of_flag(flag);
    if (text.time) complain_of_time(*text.time, *range.time);
  }

 private:
  std::size_t index_of(const std::vector<double>& column) const {
    return static_cast<std::size_t>(&column - table_.columns.data());
  }

  void find_used_columns(const std::vector<double>* time) {
    is_used_.assign(table_.names.size(), false);
    dimensions_.assign(table_.names.size(), "");
    const auto use = [&](std::size_t i, std::string_view channel) {
      is_used_[i] = true;
      if (const auto unit = unit_of_channel(channel)) dimensions_[i] = unit->dimension;
    };
    for (std::size_t i = 0; i < table_.names.size(); ++i)
      if (find_channel(campaign_.plant, table_.names[i]) != nullptr) use(i, table_.names[i]);
    for (const auto& mapping : trial_.columns) {
      if (const auto* column = find_column(table_, mapping.column)) use(index_of(*column), mapping.channel);
      for (const auto& name : mapping.added)
        if (const auto* column = find_column(table_, name)) use(index_of(*column), mapping.channel);
      const auto& second = mapping.plus.column;
      if (const auto* column = second.empty() ? nullptr : find_column(table_, second))
        is_used_[index_of(*column)] = true;
    }
    if (time != nullptr) use(index_of(*time), "t_s");
  }

  // The first used column that the line calls otherwise than the names in force, or gives another unit.
  std::optional<std::size_t> difference(const NamesLine& line) const {
    const auto& before = line.are_units ? table_.units : table_.names;
    for (std::size_t i = 0; i < before.size(); ++i)
      if (is_used_[i] && without(line.texts[i], ' ') != without(before[i], ' ')) return i;
    return std::nullopt;
  }

  void complain_of_names(const std::vector<NamesLine>& lines) {
    const auto first = std::max(trial_.rows.from_line, table_.layout.first_row_line);
    const NamesLine* in_force = nullptr;  // the last one above the trial's rows
    for (const auto& line : lines) {
      if (line.line > trial_.rows.to_line) break;
      if (line.line < first) {
        in_force = &line;
        continue;
      }
      if (in_force != nullptr) break;
      if (const auto i = difference(line)) return complain_of_names(line, *i, false);
    }
    if (in_force == nullptr) return;
    if (const auto i = difference(*in_force)) complain_of_names(*in_force, *i, true);
  }

  void complain_of_names(const NamesLine& line, std::size_t i, bool is_above) {
    const auto& before = line.are_units ? table_.units[i] : table_.names[i];
    const auto keys = line.are_units ? fmt::format("units_line = {}", line.line)
                                     : fmt::format("header_line = {}", line.line);
    auto what = fmt::format("line {} {} again, and otherwise (\"{}\" for \"{}\")", line.line,
                            line.are_units ? "states the units" : "names the columns", line.texts[i], before);
    if (is_above) what += fmt::format("; this trial's rows stand below it");
    add(FindingKind::file_format, line.line, table_.names[i], std::move(what),
        is_above ? fmt::format("give this trial format = {{ {} }} and columns of its own", keys)
                 : fmt::format(
                       "give each part a [[trial]] with columns of its own: the first with select = {{ "
                       "to_line = {} }}, the next with format = {{ {} }} and select = {{ from_line = {} }}",
                       line.line - 1, keys, line.line + 1));
  }

  void complain_of_groups(const std::vector<std::string>& cells) {
    for (std::size_t i = 0; i < cells.size(); ++i) {
      if (cells[i].empty() || !is_used_[i] || trial_.format.decimal || trial_.format.thousands) continue;
      if (dimensions_[i] == "time") forget_times_that_step_back();
      const char mark = table_.layout.numbers.decimal;
      add(FindingKind::file_format, table_.layout.first_row_line, table_.names[i],
          fmt::format(
              "\"{}\" may be {} or {}: wherever the column has a \"{}\" three digits follow, and its other "
              "numbers have at most three",
              cells[i], without(cells[i], mark), decimal_of(cells[i]), mark),
          fmt::format(
              "say which: [format] thousands = \"{}\" or decimal = \"{}\" in campaign.toml; if other columns "
              "have decimals, write this one without the sign for thousands",
              mark, mark));
    }
  }
  static std::string decimal_of(std::string text) {
    std::ranges::replace(text, ',', '.');
    return text;
  }

  void tell_of_flag(const FlagColumn& flag) {
    const auto& name = table_.names[flag.column];
    if (is_used_[flag.column] || name == trial_.rows.column) return;
    const auto select =
        flag.is_number
            ? fmt::format("leave them out with select = {{ column = \"{}\", value = {:g} }}", name, flag.good)
            : fmt::format(
                  "to leave them out write 1 and 0 for its words, and select = {{ column = \"{}\", "
                  "value = 1 }}",
                  name);
    findings_.push_back({FindingKind::file_format, note, out_.file, flag.first_line, 1, name,
                         fmt::format("marks {} of {} rows with {}, this one first, and they are used like "
                                     "all others",
                                     flag.marked, flag.rows, fmt::join(flag.texts, ", ")),
                         select + " in the [[trial]], if that means that they are not to be used"});
  }

  void complain_of_units(const std::vector<UnitsByRow>& columns) {
    for (const auto& [column, target, units] : columns) {
      if (units.size() < 2 || !is_used_[target]) continue;
      add(FindingKind::unit_disagrees, units[1].first_line, table_.names[target],
          fmt::format("the column \"{}\" holds units that change from row to row, {} from line {} and {} "
                      "from line {}: "
                      "the numbers of \"{}\" are not in one unit",
                      table_.names[column], units[0].text, units[0].first_line, units[1].text,
                      units[1].first_line, table_.names[target]),
          "write all its numbers in one unit, or set the meter to one range and record again");
    }
  }

  // Consequences of times that are read wrongly: the steps back, and the rows left out for them.
  void forget_times_that_step_back() {
    std::erase_if(findings_, [&](const Finding& finding) {
      return finding.file == out_.file &&
             (finding.kind == FindingKind::time_backwards || finding.kind == FindingKind::time_stands_still ||
              finding.kind == FindingKind::unreadable_file);
    });
  }

  void complain_of_time(const TimeTextDoubt& doubt, std::size_t i) {
    forget_times_that_step_back();
    if (doubt.kind == TimeTextDoubt::Kind::sorted_as_text)
      return add(FindingKind::time_backwards, doubt.line, table_.names[i],
                 fmt::format("the rows are sorted as text and not as numbers: {} stands behind {}",
                             doubt.after, doubt.before),
                 "sort them by the number of that column");
    const char mark = table_.layout.numbers.decimal;
    add(FindingKind::time_backwards, doubt.line, table_.names[i],
        fmt::format("{} follows {}: the digits behind the \"{}\" are a count of a smaller unit that is not "
                    "filled with "
                    "zeros, and no fraction",
                    doubt.after, doubt.before, mark),
        fmt::format(
            "write both parts as two columns, t_s = {{ column = \"sec\", plus = {{ column = \"nsec\", scale "
            "= "
            "1e-9 }} }}, or fill with zeros: \"%d.%09d\" for nanoseconds, \"%d.%03d\" for milliseconds"));
  }

  void add(FindingKind kind, std::uint64_t line, const std::string& channel, std::string what,
           std::string cure) {
    findings_.push_back(
        {kind, trial_unusable, out_.file, line, 1, channel, std::move(what), std::move(cure)});
  }

  const Campaign& campaign_;
  const CampaignTrial& trial_;
  TrialTable& out_;
  CsvTable& table_;
  std::vector<Finding>& findings_;
  std::vector<bool> is_used_;
  std::vector<std::string> dimensions_;  // of the channels that the columns become
};

bool has_unit(const CsvTable& table, std::size_t i) {
  return read_unit(table.units[i], true).has_value() || unit_in_name(table.names[i]).has_value();
}

void take_units_of_columns(const std::vector<UnitsByRow>& columns, CsvTable& table,
                           std::vector<std::string>& sources) {
  for (const auto& [column, target, units] : columns) {
    if (units.size() != 1 || !table.units[target].empty()) continue;
    const auto own = unit_in_name(table.names[target]), other = read_unit(units[0].text, false);
    if (own && !factor_between(*own, *other)) continue;  // It belongs to something else.
    table.units[target] = units[0].text;
    sources[target] = fmt::format("the column \"{}\" says", table.names[column]);
  }
}

void take_units_above(const std::vector<PreambleUnit>& above, CsvTable& table,
                      const std::vector<std::string>& dimensions, std::vector<std::string>& sources) {
  for (std::size_t i = 0; i < table.names.size(); ++i) {
    if (has_unit(table, i)) continue;
    const auto* stated = unit_above_for(above, table.names[i], dimensions[i]);
    if (stated == nullptr) continue;
    table.units[i] = stated->unit.text;
    sources[i] = fmt::format("line {}, \"{}\", says", stated->line, printable_cell(stated->text));
  }
}

}  // namespace

TableText look_at_text(std::istream& in, const CsvTable& table, const CsvFormat& format,
                       const TextRange& range) {
  NamesAgain names(table);
  GroupedDigits groups(table);
  UnitColumns units(table);
  FlagColumns flags(table);
  PreambleUnits above(table);
  std::optional<TimeTexts> times;
  if (range.time) times.emplace(table, *range.time);
  const auto first_row = std::max(table.layout.header_line, table.layout.units_line) + 1;
  for_each_text_row(in, table.layout, format, [&](const TextRow& row) {
    if (row.line < first_row) return above.take(row);
    names.take(row);
    groups.take(row);
    units.take(row);
    if (row.line >= range.first_line && row.line <= range.last_line) flags.take(row);
    if (times && row.line >= range.first_line && row.line <= range.last_line) times->take(row);
  });
  return {names.take_lines(),
          groups.cells(),
          units.found(),
          above.take_units(),
          times ? times->doubt() : std::nullopt,
          flags.found()};
}

std::vector<std::string> take_units_of_text(const TableText& text, CsvTable& table,
                                            const std::vector<std::string>& dimensions) {
  std::vector<std::string> sources(table.names.size());
  take_units_of_columns(text.units_by_row, table, sources);
  take_units_above(text.units_above, table, dimensions, sources);
  return sources;
}

void check_text(std::istream& in, const Campaign& campaign, const CampaignTrial& trial, TrialTable& table,
                std::vector<Finding>& findings) {
  TextChecker(campaign, trial, table, findings).run(in);
}

}  // namespace sandhopper
