#include "tools/campaign/column_mapping.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "config/hint.hpp"
#include "tools/campaign/column_rivals.hpp"
#include "tools/campaign/config_number.hpp"
#include "tools/campaign/read_table.hpp"
#include "tools/campaign/setup_vocabulary.hpp"
#include "tools/campaign/unit_check.hpp"

namespace sandhopper {
namespace {

using Kind = ConfigNode::Kind;

class TableReader {
 public:
  TableReader(CampaignPlant plant, const std::string& file) : plant_(plant), file_(file) {}

  ColumnTable run(const ConfigNode& table) {
    for (const auto& child : table.children) read_mapping(child);
    return std::move(out_);
  }

 private:
  void read_mapping(const ConfigNode& child) {
    ColumnMapping mapping{child.key, "", 1.0, 0.0, child.key_position, "", false, {}};
    std::string wrong, cure;
    if (child.kind == Kind::text) mapping.column = child.text;
    if (child.kind == Kind::table)
      for (const auto& part : child.children)
        if (!read_part(part, mapping) && wrong.empty()) wrong = wrong_part(part), cure = cure_of_part(part);
    if (wrong.empty() && mapping.column.empty()) wrong = "it names no column";
    if (!wrong.empty()) {
      if (cure.empty())
        cure = fmt::format("write {} = {{ column = \"NAME\", unit = \"mm\", scale = 0.001, offset = 0.0 }}",
                           child.key);
      return add(FindingKind::set_up, FindingSeverity::trial_unusable, child.key_position, child.key,
                 fmt::format("this mapping cannot be understood: {}", wrong), std::move(cure));
    }
    check_channel(mapping);
    out_.columns.push_back(std::move(mapping));
  }

  static bool read_part(const ConfigNode& part, ColumnMapping& mapping) {
    const auto number = number_of(part);
    if (part.key == "column" && part.kind == Kind::text)
      mapping.column = part.text;
    else if (part.key == "column" && part.kind == Kind::array && mapping.channel != "t_s")
      return read_sum(part, mapping);
    else if (part.key == "scale" && number)
      mapping.scale = *number, mapping.has_scale = true;
    else if (part.key == "scale" && part.kind == Kind::text && part.text == kUnknownNumber)
      mapping.unit = mapping.unit.empty() ? std::string(kUnknownUnit) : mapping.unit;
    else if (part.key == "unit" && part.kind == Kind::text)
      mapping.unit = part.text;
    else if (part.key == "offset" && number)
      mapping.offset = *number;
    else if (part.key == "plus" && part.kind == Kind::table && mapping.channel == "t_s")
      return read_plus(part, mapping.plus);
    else
      return false;
    return true;
  }

  static bool read_sum(const ConfigNode& list, ColumnMapping& mapping) {
    mapping.added.clear();
    for (const auto& part : list.children) {
      const bool is_new = std::ranges::find(mapping.added, part.text) == mapping.added.end();
      if (part.kind != Kind::text || part.text.empty() || !is_new) return false;
      mapping.added.push_back(part.text);
    }
    if (mapping.added.empty()) return false;
    mapping.column = mapping.added.front();
    mapping.added.erase(mapping.added.begin());
    return true;
  }

  static bool read_plus(const ConfigNode& table, AddedColumn& plus) {
    for (const auto& part : table.children) {
      const auto number = number_of(part);
      if (part.key == "column" && part.kind == Kind::text)
        plus.column = part.text;
      else if (part.key == "scale" && number)
        plus.scale = *number;
      else
        return false;
    }
    return !plus.column.empty();
  }

  static bool takes_number(std::string_view key) { return key == "scale" || key == "offset"; }

  static std::string wrong_part(const ConfigNode& part) {
    if (takes_number(part.key) && part.kind == Kind::text)
      return fmt::format("{} = \"{}\" is a text, not a number", part.key, part.text);
    return fmt::format("'{}' is no part of a mapping, or is of another type", part.key);
  }

  static std::string cure_of_part(const ConfigNode& part) {
    const auto number =
        takes_number(part.key) && part.kind == Kind::text ? number_in_text(part.text) : std::nullopt;
    if (number && number->dimension.empty()) return fmt::format("write {} = {:.9g}", part.key, number->value);
    return "";
  }

  void check_channel(const ColumnMapping& mapping) {
    if (mapping.channel == "t_s" || find_channel(plant_, mapping.channel)) return;
    std::vector<std::string> known{"t_s"};
    for (const auto& channel : known_channels())
      if (channel.plant == plant_) known.emplace_back(channel.name);
    add(FindingKind::unknown_column, FindingSeverity::note, mapping.position, mapping.channel,
        fmt::format("is no channel of plant \"{}\"", name_of(plant_)),
        cure_for_unknown_key(mapping.channel, std::nullopt, known));
  }

  void add(FindingKind kind, FindingSeverity severity, ConfigPosition position, const std::string& key,
           std::string what, std::string cure) {
    out_.findings.push_back(
        {kind, severity, file_, position.line, position.column, key, std::move(what), std::move(cure)});
  }

  CampaignPlant plant_;
  const std::string& file_;
  ColumnTable out_;
};

}  // namespace

ColumnTable read_column_table(const ConfigNode& table, CampaignPlant plant, const std::string& file) {
  return TableReader(plant, file).run(table);
}

ColumnUnits column_units(const CsvTable& table, const std::vector<std::string>& sources, std::size_t column,
                         const ColumnMapping& mapping) {
  double largest = 0.0;
  for (const double value : table.columns[column])
    if (!std::isnan(value)) largest = std::max(largest, std::abs(value));
  const bool has_own_unit = !mapping.added.empty() && mapping.unit.empty() && !mapping.has_scale;
  const auto own = has_own_unit ? unit_of_column(table, column) : std::nullopt;
  return {.column = table.names[column],
          .channel = mapping.channel,
          .row_unit = table.units[column],
          .row_source = column < sources.size() ? sources[column] : "",
          .stated_unit = own ? own->text : mapping.unit,
          .scale = mapping.scale,
          .has_scale = mapping.has_scale,
          .largest = largest};
}

}  // namespace sandhopper
