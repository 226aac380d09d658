#include "tools/campaign/written_digits.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <numbers>
#include <vector>

#include "config/hint.hpp"
#include "config/load.hpp"

namespace sandhopper {
namespace {

std::vector<std::string> lines_in(const std::filesystem::path& file) {
  std::vector<std::string> lines;
  std::ifstream in(file);
  for (std::string line; std::getline(in, line);) lines.push_back(line);
  return lines;
}

// The text of a number that begins at a place of the file; empty if there is none.
std::string text_at(const std::vector<std::string>& lines, ConfigPosition place) {
  if (place.line == 0 || place.line > lines.size() || place.column == 0) return "";
  const auto& line = lines[place.line - 1];
  if (place.column > line.size()) return "";
  const auto from = line.substr(place.column - 1);
  return from.substr(0, from.find_first_not_of("0123456789+-._eE"));
}

bool is_number(const ConfigNode& node) {
  return node.kind == ConfigNode::Kind::real || node.kind == ConfigNode::Kind::integer;
}

std::optional<double> stated_diameter_m(const CampaignTrial& trial) {
  for (const auto key : kDiameterKeys)
    if (const auto number = trial.number(key)) return number;
  return std::nullopt;
}

}  // namespace

double half_of_last_digit(std::string_view text) {
  std::string digits;
  std::ranges::copy_if(text, std::back_inserter(digits), [](char c) { return c != '_'; });
  const auto exponent_at = digits.find_first_of("eE");
  const int exponent = exponent_at == std::string::npos ? 0 : std::stoi(digits.substr(exponent_at + 1));
  const auto mantissa = digits.substr(0, exponent_at);
  const auto point = mantissa.find('.');
  const int decimals = point == std::string::npos ? 0 : static_cast<int>(mantissa.size() - point) - 1;
  return 0.5 * std::pow(10.0, exponent - decimals);
}

// Twelve digits: more than anybody writes, and fewer than a change of unit gets wrong.
double half_of_last_digit(double size) { return half_of_last_digit(fmt::format("{:.12g}", size)); }

std::map<std::string, double> written_errors(const std::filesystem::path& model) {
  std::map<std::string, double> errors;
  if (model.empty()) return errors;
  const auto document = parse_config_file(model.string());
  const auto lines = lines_in(model);
  const auto take = [&](const std::string& path, const ConfigNode& node) {
    if (!is_number(node)) return;
    const auto text = text_at(lines, node.position);
    const bool is_decimal = !text.empty() && text.find_first_of("0123456789") != std::string::npos;
    if (is_decimal) errors[path] = half_of_last_digit(text);
  };
  for (const auto& child : document.root.children) {
    take(child.key, child);
    if (child.kind == ConfigNode::Kind::table)
      for (const auto& inner : child.children) take(child.key + "." + inner.key, inner);
  }
  return errors;
}

double written_error(const CampaignTrial& trial, std::string_view path) {
  const auto key = last_key(path);
  if (const auto number = trial.number(key)) return half_of_last_digit(std::abs(*number));
  const auto diameter_m = stated_diameter_m(trial);
  if (!diameter_m) return 0.0;
  const double error_m = half_of_last_digit(*diameter_m);
  if (key == "radius_m" || key == "foot_radius_m") return 0.5 * error_m;
  if (key == "frontal_area_m2") return 0.5 * std::numbers::pi * *diameter_m * error_m;
  return 0.0;
}

}  // namespace sandhopper
