#include <fmt/format.h>
#include <toml++/toml.h>

#include <algorithm>
#include <cerrno>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <sstream>

#include "config/node.hpp"
#include "config/problem.hpp"

namespace sandhopper {
namespace {

ConfigPosition position_of(const toml::source_region& region) {
  return region.begin ? ConfigPosition{region.begin.line, region.begin.column} : ConfigPosition{};
}

ConfigNode convert(const toml::node& node) {
  using Kind = ConfigNode::Kind;
  ConfigNode out;
  out.position = out.key_position = position_of(node.source());
  switch (node.type()) {
    case toml::node_type::table:
      out.kind = Kind::table;
      for (const auto& [key, value] : *node.as_table()) {
        out.children.push_back(convert(value));
        out.children.back().key = key.str();
        // The header of a sub-table may have named this table first.
        if (!value.is_table()) out.children.back().key_position = position_of(key.source());
      }
      break;
    case toml::node_type::array:
      out.kind = Kind::array;
      for (const auto& element : *node.as_array()) out.children.push_back(convert(element));
      break;
    case toml::node_type::integer:
      out.kind = Kind::integer;
      out.integer = node.as_integer()->get();
      break;
    case toml::node_type::floating_point:
      out.kind = Kind::real;
      out.real = node.as_floating_point()->get();
      break;
    case toml::node_type::boolean:
      out.kind = Kind::boolean;
      out.boolean = node.as_boolean()->get();
      break;
    case toml::node_type::string:
      out.kind = Kind::text;
      out.text = node.as_string()->get();
      break;
    default:
      out.kind = Kind::date;
  }
  return out;
}

// Rewords the parser's message for a user who edits a file.
std::string explain(std::string_view description) {
  constexpr std::string_view kTwice = "cannot redefine existing ";
  if (const auto at = description.find(kTwice); at != std::string_view::npos) {
    const auto what = description.substr(at + kTwice.size());
    const auto quote = what.find('\'');
    const auto key = quote == std::string_view::npos ? what : what.substr(quote);
    return fmt::format("key {} is given twice: keep one of the two", key);
  }
  const auto colon = description.find(": ");
  const auto detail = colon == std::string_view::npos ? description : description.substr(colon + 2);
  return fmt::format("this is not TOML: {}; expected lines of the form 'key = value' under '[table]' headers",
                     detail);
}

}  // namespace

ConfigDocument parse_config_text(std::string name, std::string_view text) {
  try {
    return {name, convert(toml::parse(text, std::string_view(name)))};
  } catch (const toml::parse_error& error) {
    throw ConfigError({{name, position_of(error.source()), "", explain(error.description())}});
  }
}

ConfigDocument parse_config_file(const std::string& path) {
  std::error_code error;
  if (std::filesystem::is_directory(path, error))
    throw ConfigError({{path, {0, 0}, "", "this is a directory: name a .toml file"}});
  std::ifstream file(path, std::ios::binary);
  if (!file) {
    const auto reason = std::strerror(errno);
    throw ConfigError(
        {{path, {0, 0}, "", fmt::format("cannot be read ({}): check the path and its permissions", reason)}});
  }
  std::ostringstream text;
  text << file.rdbuf();
  return parse_config_text(path, text.str());
}

const ConfigNode& nearest_node(const ConfigNode& table, std::string_view key) {
  const auto* node = &table;
  while (!key.empty()) {
    const auto end = std::min(key.find_first_of(".["), key.size());
    const ConfigNode* next = nullptr;
    if (key.front() == '[') {
      const auto index = static_cast<std::size_t>(std::atoi(std::string(key.substr(1)).c_str()));
      if (index < node->children.size()) next = &node->children[index];
      key.remove_prefix(std::min(key.find(']') + 1, key.size()));
    } else {
      next = node->find(key.substr(0, end));
      key.remove_prefix(end);
    }
    if (!key.empty() && key.front() == '.') key.remove_prefix(1);
    if (next == nullptr) break;
    node = next;
  }
  return *node;
}

}  // namespace sandhopper
