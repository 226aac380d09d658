#pragma once
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

// A TOML document as a plain tree with the position of every key, so that the strict loader and its users do
// not need the parser's headers.
namespace sandhopper {

// Line and column count from 1.
struct ConfigPosition {
  std::uint32_t line = 1;
  std::uint32_t column = 1;
};

struct ConfigNode {
  enum class Kind : std::uint8_t { table, array, real, integer, boolean, text, date };

  Kind kind = Kind::table;
  std::string key;              // empty for the document and for elements of an array
  ConfigPosition key_position;  // of the key; of the header for a table
  ConfigPosition position;      // of the value
  double real = 0.0;
  std::int64_t integer = 0;
  bool boolean = false;
  std::string text;
  std::vector<ConfigNode> children;  // a table's members or an array's elements

  const ConfigNode* find(std::string_view name) const {
    for (const auto& child : children)
      if (child.key == name) return &child;
    return nullptr;
  }
};

// Name of a document for messages, and the tree of its text.
struct ConfigDocument {
  std::string name;
  ConfigNode root;
};

// Node of a key below this table; the key may be nested ("motor[1].can_id"). If there is no such key, the
// nearest table above it.
const ConfigNode& nearest_node(const ConfigNode& table, std::string_view key);

// Both throw ConfigError for a file that cannot be read, a syntax error or a duplicate key (with its line).
ConfigDocument parse_config_text(std::string name, std::string_view text);
ConfigDocument parse_config_file(const std::string& path);

}  // namespace sandhopper
