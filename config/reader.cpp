#include "config/reader.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "config/hint.hpp"

namespace sandhopper {
namespace {

using Kind = ConfigNode::Kind;

std::string number_text(double value) {
  auto text = fmt::format("{}", value);
  if (text.find_first_of(".einf") == std::string::npos) text += ".0";
  return text;
}

std::string shortened(const std::string& text) {
  constexpr std::size_t kLongest = 40;
  return text.size() <= kLongest ? text : text.substr(0, kLongest) + "...";
}

std::string what_it_is(const ConfigNode& node) {
  switch (node.kind) {
    case Kind::table:
      return "a table";
    case Kind::array:
      return fmt::format("an array of {}", node.children.size());
    case Kind::real:
      return number_text(node.real);
    case Kind::integer:
      return fmt::format("{}", node.integer);
    case Kind::boolean:
      return node.boolean ? "true" : "false";
    case Kind::text:
      return fmt::format("the text \"{}\"", shortened(node.text));
    case Kind::date:
      return "a date or time";
  }
  return "?";
}

std::string interval(Range range) {
  constexpr double kHuge = 1e15;  // larger limits are those of the type and are not shown
  const bool low = range.low > -kHuge, high = range.high < kHuge;
  if (low && high) return fmt::format(" from {} to {}", range.low, range.high);
  if (low) return fmt::format(" of at least {}", range.low);
  if (high) return fmt::format(" of at most {}", range.high);
  return "";
}

std::string header_of(const std::string& path) {
  return path.empty() ? "the top of the file" : fmt::format("[{}]", path);
}

// Numbers in quotes are the most common error.
std::string_view cure_for_type(const ConfigNode& node, std::string_view expected) {
  const bool wants_number = expected.starts_with("a number") || expected.starts_with("an integer");
  if (node.kind == Kind::text && wants_number) return ": write the number alone, without quotes or unit";
  if (node.kind == Kind::real && expected.starts_with("an integer")) return ": write it without decimals";
  if (node.kind == Kind::table && expected.starts_with("an array of"))
    return ": write the header in double brackets, [[...]]";
  return "";
}

}  // namespace

std::string ConfigReader::join(const std::string& path, std::string_view key) {
  return path.empty() ? std::string(key) : fmt::format("{}.{}", path, key);
}

std::string ConfigReader::element(const std::string& path, std::size_t index) {
  return fmt::format("{}[{}]", path, index);
}

std::string ConfigReader::expected_table(std::string_view path, const ConfigNode& keys) {
  std::vector<std::string_view> names;
  for (const auto& child : keys.children) names.push_back(child.key);
  return fmt::format("a table [{}] with {}", path, fmt::join(names, ", "));
}

std::string ConfigReader::expected_number(std::string_view what, std::string_view path, Range range) {
  const auto limits = interval(range);
  const auto unit = unit_of_key(last_key(path));
  return fmt::format("{}{}{}{}", what, limits, unit.empty() ? "" : limits.empty() ? " in " : " ", unit);
}

std::string ConfigReader::expected_name(std::span<const std::string_view> names) {
  std::string text = "one of";
  for (std::size_t i = 0; i < names.size(); ++i)
    text += fmt::format("{} \"{}\"", i == 0 ? "" : ",", names[i]);
  return text;
}

std::string ConfigReader::expected_array(std::string_view path, bool of_tables,
                                         std::optional<std::size_t> size) {
  const auto count = size ? fmt::format(" {}", *size) : std::string();
  if (of_tables) return fmt::format("an array of{} tables [[{}]]", count, path);
  const auto unit = unit_of_key(last_key(path));
  return fmt::format("an array of{} numbers{}{}", count, unit.empty() ? "" : " in ", unit);
}

void ConfigReader::read(const ConfigNode& node, const std::string& path, bool& value, Range) {
  if (node.kind != Kind::boolean) return wrong_type(node, path, "true or false");
  value = node.boolean;
}

void ConfigReader::read(const ConfigNode& node, const std::string& path, std::string& value, Range) {
  if (node.kind != Kind::text) return wrong_type(node, path, "text in quotes");
  value = node.text;
}

bool ConfigReader::read_real(const ConfigNode& node, const std::string& path, Range range, double& value) {
  if (node.kind != Kind::real && node.kind != Kind::integer) {
    wrong_type(node, path, expected_number("a number", path, range));
    return false;
  }
  value = node.kind == Kind::real ? node.real : static_cast<double>(node.integer);
  return is_within(node, path, "a number", range, value);
}

bool ConfigReader::read_integer(const ConfigNode& node, const std::string& path, Range range,
                                std::int64_t& value) {
  if (node.kind != Kind::integer) {
    wrong_type(node, path, expected_number("an integer", path, range));
    return false;
  }
  value = node.integer;
  return is_within(node, path, "an integer", range, static_cast<double>(value));
}

bool ConfigReader::is_within(const ConfigNode& node, const std::string& path, std::string_view what,
                             Range range, double value) {
  if (std::isfinite(value) && value >= range.low && value <= range.high) return true;
  add(node.position, path,
      fmt::format("key '{}' is {}: expected {}, got {}", path,
                  std::isfinite(value) ? "out of range" : "not a finite number",
                  expected_number(what, path, range), what_it_is(node)));
  return false;
}

bool ConfigReader::read_name(const ConfigNode& node, const std::string& path,
                             std::span<const std::string_view> names, std::size_t& index) {
  if (node.kind != Kind::text) {
    wrong_type(node, path, expected_name(names));
    return false;
  }
  const auto found = std::find(names.begin(), names.end(), node.text);
  index = static_cast<std::size_t>(found - names.begin());
  if (found != names.end()) return true;
  const std::vector<std::string> known(names.begin(), names.end());
  const auto nearest = nearest_words(node.text, known, 1);
  add(node.position, path,
      fmt::format("key '{}' has no such value: expected {}, got \"{}\"{}", path, expected_name(names),
                  shortened(node.text),
                  nearest.empty() ? "" : fmt::format("; did you mean \"{}\"?", nearest.front())));
  return false;
}

bool ConfigReader::is_array(const ConfigNode& node, const std::string& path,
                            std::optional<std::size_t> size) {
  const auto wanted = size ? fmt::format("an array of {}", *size) : std::string("an array");
  if (node.kind != Kind::array) {
    wrong_type(node, path, wanted);
    return false;
  }
  if (!size || node.children.size() == *size) return true;
  add(node.position, path,
      fmt::format("key '{}' has the wrong size: expected {}, got {}", path, wanted, what_it_is(node)));
  return false;
}

void ConfigReader::wrong_type(const ConfigNode& node, const std::string& path, std::string_view expected) {
  add(node.position, path,
      fmt::format("key '{}' has the wrong type: expected {}, got {}{}", path, expected, what_it_is(node),
                  cure_for_type(node, expected)));
}

void ConfigReader::missing(const ConfigNode& table, const std::string& path, std::string_view key,
                           std::string_view expected, std::string_view default_line) {
  auto text = fmt::format("key '{}' is missing: expected {}", join(path, key), expected);
  if (!default_line.empty())
    text += fmt::format("; add '{}' (the default) to {}", default_line, header_of(path));
  add(table.key_position, join(path, key), std::move(text));
  problems_.back().missing = true;
}

void ConfigReader::unknown_keys(const ConfigNode& table, const std::string& path,
                                std::span<const std::string> known) {
  std::vector<std::string> candidates(known.begin(), known.end());
  // Try keys that are not in the file yet first, because one of them was probably meant.
  std::stable_partition(candidates.begin(), candidates.end(), [&](auto& key) { return !table.find(key); });
  for (const auto& child : table.children) {
    if (std::find(known.begin(), known.end(), child.key) != known.end()) continue;
    std::optional<double> value;
    if (child.kind == Kind::real) value = child.real;
    if (child.kind == Kind::integer) value = static_cast<double>(child.integer);
    const auto cure = cure_for_unknown_key(child.key, value, candidates);
    forget_missing_named_in(cure, path, known);
    add(child.key_position, join(path, child.key),
        fmt::format("key '{}' is unknown in {}: {}", join(path, child.key), header_of(path), cure));
  }
}

// A misspelt key is also missing. Report it only once.
void ConfigReader::forget_missing_named_in(std::string_view cure, const std::string& path,
                                           std::span<const std::string> known) {
  for (const auto& key : known) {
    const bool named = cure.find(fmt::format("'{}'", key)) != std::string_view::npos ||
                       cure.find(fmt::format("'{} =", key)) != std::string_view::npos;
    if (named)
      std::erase_if(problems_, [&](const ConfigProblem& p) { return p.missing && p.key == join(path, key); });
  }
}

void ConfigReader::broken_rule(const ConfigNode& table, const std::string& path, std::string_view key,
                               std::string_view text) {
  add(nearest_node(table, key).key_position, join(path, key),
      fmt::format("key '{}' does not fit: {}", join(path, key), text));
}

void ConfigReader::add(ConfigPosition position, std::string path, std::string text) {
  problems_.push_back({file_, position, std::move(path), std::move(text)});
}

}  // namespace sandhopper
