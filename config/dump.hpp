#pragma once
#include <array>
#include <concepts>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "config/fields.hpp"
#include "config/node.hpp"

// Writes any struct with `fields` as TOML, through the same tree that is used for reading (JSON:
// config/json.hpp).
namespace sandhopper {

// Tree of a value; empty optionals are left out.
template <class T>
ConfigNode to_node(const T& value);

namespace detail {

ConfigNode real_node(double value);
ConfigNode integer_node(std::int64_t value);
ConfigNode boolean_node(bool value);
ConfigNode text_node(std::string_view value);

template <class T>
struct NodeOf {
  static ConfigNode make(const T& value) {
    if constexpr (HasFields<const T>) {
      ConfigNode table;
      T::fields(value, [&]<class Member>(std::string_view key, const Member& member, Range = {}) {
        add(table, key, member);
      });
      return table;
    } else if constexpr (std::same_as<T, bool>) {
      return boolean_node(value);
    } else if constexpr (std::integral<T>) {
      return integer_node(static_cast<std::int64_t>(value));
    } else if constexpr (std::floating_point<T>) {
      return real_node(static_cast<double>(value));
    } else if constexpr (NamedEnum<T>) {
      return text_node(name_of(value));
    } else if constexpr (std::convertible_to<const T&, std::string_view>) {
      return text_node(value);
    } else {  // array or vector
      ConfigNode array;
      array.kind = ConfigNode::Kind::array;
      for (const auto& item : value) array.children.push_back(to_node(item));
      return array;
    }
  }

  template <class Member>
  static void add(ConfigNode& table, std::string_view key, const Member& member) {
    table.children.push_back(to_node(member));
    table.children.back().key = key;
  }
  template <class Member>
  static void add(ConfigNode& table, std::string_view key, const std::optional<Member>& member) {
    if (member) add(table, key, *member);
  }
};

}  // namespace detail

template <class T>
ConfigNode to_node(const T& value) {
  return detail::NodeOf<T>::make(value);
}

// TOML text of a table. Numbers have enough digits to give the same bits when read.
std::string to_toml(const ConfigNode& table);
// "key = value" on one line.
std::string to_toml_line(std::string_view key, const ConfigNode& value);

template <HasFields T>
std::string to_toml(const T& value) {
  return to_toml(to_node(value));
}

}  // namespace sandhopper
