#include "tools/conceal/write_campaign.hpp"

#include <fmt/format.h>

#include <fstream>
#include <map>
#include <stdexcept>

#include "tools/conceal/cells.hpp"
#include "tools/conceal/visibility.hpp"

namespace sandhopper::conceal {
namespace {

// Another name and unit for a channel: channel = scale x column.
struct ForeignName {
  std::string column;
  double scale;
  int decimals_less;
};

std::map<std::string, ForeignName> foreign_names(const Case& c, const Table& sample) {
  std::map<std::string, ForeignName> names;
  if (!c.foreign_names) return names;
  auto random = c.recording.stream("names");
  int count = 0;
  for (const auto& column : sample.columns) {
    ++count;
    const bool renamed = random.chance(0.4);
    const bool milli = random.chance(0.5), turned = random.chance(0.3);
    if (column.name == "t_s" || column.name == "phase" || !renamed) continue;
    const double scale = (milli ? 1e-3 : 1.0) * (turned ? -1.0 : 1.0);
    names[column.name] = {fmt::format("ch{:02d}", count), scale, milli ? std::min(3, column.decimals) : 0};
  }
  return names;
}

void rename(Table& table, const std::map<std::string, ForeignName>& names) {
  for (auto& column : table.columns) {
    const auto found = names.find(column.name);
    if (found == names.end()) continue;
    column.name = found->second.column;
    column.decimals -= found->second.decimals_less;
    for (double& value : column.values) value /= found->second.scale;
  }
}

std::string campaign_toml(const Case& c, const std::vector<Setup>& setups,
                          const std::map<std::string, ForeignName>& names) {
  auto text = fmt::format("name = \"campaign\"\nplant = \"{}\"\nmodel = \"nominal.toml\"\n", c.plant->name());
  if (!names.empty()) text += "\n[columns]\n";
  for (const auto& [channel, foreign] : names)
    text += fmt::format("{} = {{ column = \"{}\", scale = {}, offset = 0.0 }}\n", channel, foreign.column,
                        toml_value(foreign.scale));
  for (std::size_t i = 0; i < setups.size(); ++i) {
    text += fmt::format("\n[[trial]]\nfile = \"trials/{:03d}.csv\"\n", i + 1);
    for (const auto& [key, value] : setups[i].keys.items())
      text += fmt::format("{} = {}\n", key, toml_value(value));
  }
  return text;
}

Json to_json(const EffectCells& cells) {
  if (!cells) return nullptr;
  auto all = Json::array();
  for (const auto& cell : *cells)
    all.push_back({{"channel", cell.channel},
                   {"phase", cell.phase},
                   {"ratio", six_digits(cell.ratio)},
                   {"max_trial_ratio", six_digits(cell.max_trial_ratio)}});
  return all;
}

}  // namespace

void write_text(const std::filesystem::path& file, const std::string& text) {
  std::ofstream out(file, std::ios::binary);
  out << text;
  if (!out.flush()) throw std::runtime_error("cannot write " + file.string());
}

void write_campaign(const std::filesystem::path& folder, const Case& c, const std::vector<Setup>& extra) {
  std::filesystem::create_directories(folder / "trials");
  auto setups = c.setups;
  setups.insert(setups.end(), extra.begin(), extra.end());
  std::map<std::string, ForeignName> names;
  for (std::size_t i = 0; i < setups.size(); ++i) {
    auto table = record(c, *c.bench, setups[i], c.recording.stream("trial", i));
    if (i == 0) names = foreign_names(c, table);
    rename(table, names);
    write_text(folder / fmt::format("trials/{:03d}.csv", i + 1), to_csv(table));
  }
  write_text(folder / "nominal.toml", to_toml(c.bench->belief()));
  write_text(folder / "campaign.toml", campaign_toml(c, setups, names));
}

Json answer(const Case& c, const Request& request, std::uint64_t index) {
  Json json{{"plant", c.plant->name()}, {"kind", name_of(c.kind)}, {"effects", c.effects}};
  const auto cells = cells_of_effects(c);
  for (std::size_t e = 0; e < cells.size(); ++e) json["effects"][e]["cells"] = to_json(cells[e]);
  json["unknown_port"] = c.unknown_port;
  json["class"] = c.ambiguity;
  const auto seen = visibility(c, c.hidden);
  json["visibility"] = {{"channel", seen.channel}, {"ratio", seen.ratio}};
  json["dead_channel"] = c.dead_channel;
  json["gaps"] = c.gaps;
  json["seed"] = request.seed;
  json["index"] = index;
  json["request"] = request.to_json();
  return json;
}

}  // namespace sandhopper::conceal
