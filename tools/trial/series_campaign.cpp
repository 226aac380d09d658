#include "tools/trial/series_campaign.hpp"

#include <fmt/format.h>

#include <stdexcept>

#include "config/dump.hpp"
#include "tools/plant/world_config.hpp"
#include "tools/trial/text_file.hpp"

namespace sandhopper {
namespace {

namespace fs = std::filesystem;

std::string line(std::string_view key, const std::string& text) {
  return to_toml_line(key, detail::text_node(text)) + "\n";
}
std::string line(std::string_view key, double value) {
  return to_toml_line(key, detail::real_node(value)) + "\n";
}

// Configured values of the keys that a simulation of the robot also has.
template <class Configured, class Believed>
std::string shared_keys(std::string_view table, const Configured& configured, const Believed& believed) {
  std::string out = fmt::format("\n[{}]\n", table);
  const auto known = to_node(believed);
  for (const auto& entry : to_node(configured).children)
    if (known.find(entry.key) != nullptr && entry.kind == ConfigNode::Kind::real)
      out += to_toml_line(entry.key, entry) + "\n";
  return out;
}

std::string nominal(const RobotConfig& robot) {
  return "# What the simulation believes: the robot as robot.toml had it; the rest takes its default.\n" +
         shared_keys("robot", robot.robot, WorldRobotConfig{}) +
         shared_keys("controller", robot.controller, NominalControllerConfig{}) +
         "\n[sensors]\nencoder_latency_s = 0.001   # a row holds the reply to the previous cycle's command\n";
}

std::string trial_table(const RobotConfig& robot, const SeriesTrial& trial) {
  const auto file = trial.log.filename().string();
  if (!trial.unusable.empty()) return fmt::format("\n# {} is left out: {}\n", file, trial.unusable);
  std::string out = "\n[[trial]]\n" + line("file", file) + line("kind", std::string("hop"));
  out += line("compression_stiffness_N_per_m", robot.controller.compression_stiffness_N_per_m);
  out += line("extension_stiffness_N_per_m", robot.controller.extension_stiffness_N_per_m);
  for (const auto& entry : to_node(trial.sheet).children)
    if (entry.kind != ConfigNode::Kind::text || !entry.text.empty())
      out += to_toml_line(entry.key, entry) + "\n";
  return out;
}

}  // namespace

void write_series_campaign(const fs::path& folder, const RobotConfig& robot,
                           const std::vector<SeriesTrial>& trials) {
  if (trials.empty()) return;
  std::string campaign =
      line("name", fmt::format("{}, {}", trials.front().sheet.bed, folder.filename().string())) +
      line("plant", std::string("hopper")) + line("model", std::string("nominal.toml"));
  for (const auto& trial : trials) campaign += trial_table(robot, trial);
  write_text(folder / "nominal.toml", nominal(robot));
  write_text(folder / "campaign.toml", campaign);
}

}  // namespace sandhopper
