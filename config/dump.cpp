#include "config/dump.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace sandhopper {
namespace {

using Kind = ConfigNode::Kind;

bool is_array_of_tables(const ConfigNode& node) {
  return node.kind == Kind::array && !node.children.empty() &&
         std::all_of(node.children.begin(), node.children.end(),
                     [](const ConfigNode& child) { return child.kind == Kind::table; });
}

std::string quoted_text(std::string_view text) {
  std::string out = "\"";
  for (const char c : text) {
    if (c == '"' || c == '\\')
      out += fmt::format("\\{}", c);
    else if (static_cast<unsigned char>(c) < 0x20 || c == 0x7f)
      out += fmt::format("\\u{:04X}", static_cast<unsigned>(static_cast<unsigned char>(c)));
    else
      out += c;
  }
  return out + "\"";
}

std::string real_text(double value) {
  if (std::isnan(value)) return "nan";
  if (std::isinf(value)) return value > 0 ? "inf" : "-inf";
  auto text = fmt::format("{}", value);
  if (text.find_first_of(".e") == std::string::npos) text += ".0";
  return text;
}

std::string inline_text(const ConfigNode& node) {
  switch (node.kind) {
    case Kind::real:
      return real_text(node.real);
    case Kind::integer:
      return fmt::format("{}", node.integer);
    case Kind::boolean:
      return node.boolean ? "true" : "false";
    case Kind::text:
    case Kind::date:
      return quoted_text(node.text);
    default:
      break;
  }
  const bool table = node.kind == Kind::table;
  std::string out = table ? "{" : "[";
  for (const auto& child : node.children) {
    if (&child != &node.children.front()) out += ", ";
    out += table ? to_toml_line(child.key, child) : inline_text(child);
  }
  return out + (table ? "}" : "]");
}

void write_table(const ConfigNode& table, const std::string& path, std::string& out) {
  const auto has_own_header = [](const ConfigNode& c) {
    return c.kind == Kind::table || is_array_of_tables(c);
  };
  for (const auto& child : table.children)
    if (!has_own_header(child)) out += to_toml_line(child.key, child) + "\n";
  for (const auto& child : table.children) {
    const auto name = path.empty() ? child.key : path + "." + child.key;
    if (child.kind == Kind::table) {
      out += fmt::format("\n[{}]\n", name);
      write_table(child, name, out);
    } else if (is_array_of_tables(child)) {
      for (const auto& element : child.children) {
        out += fmt::format("\n[[{}]]\n", name);
        write_table(element, name, out);
      }
    }
  }
}

}  // namespace

namespace detail {

ConfigNode real_node(double value) {
  ConfigNode node;
  node.kind = Kind::real;
  node.real = value;
  return node;
}

ConfigNode integer_node(std::int64_t value) {
  ConfigNode node;
  node.kind = Kind::integer;
  node.integer = value;
  return node;
}

ConfigNode boolean_node(bool value) {
  ConfigNode node;
  node.kind = Kind::boolean;
  node.boolean = value;
  return node;
}

ConfigNode text_node(std::string_view value) {
  ConfigNode node;
  node.kind = Kind::text;
  node.text = value;
  return node;
}

}  // namespace detail

std::string to_toml_line(std::string_view key, const ConfigNode& value) {
  return fmt::format("{} = {}", key, inline_text(value));
}

std::string to_toml(const ConfigNode& table) {
  std::string out;
  write_table(table, "", out);
  return out.starts_with('\n') ? out.substr(1) : out;
}

}  // namespace sandhopper
