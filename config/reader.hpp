#pragma once
#include <array>
#include <concepts>
#include <cstdint>
#include <limits>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <type_traits>
#include <vector>

#include "config/dump.hpp"
#include "config/fields.hpp"
#include "config/node.hpp"
#include "config/problem.hpp"

// Compares the fields of a struct with a document and collects every mismatch. Users include config/load.hpp.
namespace sandhopper {

enum class MissingKeys { error, use_default };

namespace detail {

template <class T>
inline constexpr bool is_optional = false;
template <class T>
inline constexpr bool is_optional<std::optional<T>> = true;

// True for types that are written as tables with headers of their own.
template <class T>
inline constexpr bool is_tabular = HasFields<T>;
template <class T, std::size_t N>
inline constexpr bool is_tabular<std::array<T, N>> = HasFields<T>;
template <class T>
inline constexpr bool is_tabular<std::vector<T>> = HasFields<T>;

}  // namespace detail

class ConfigReader {
 public:
  ConfigReader(std::string file, MissingKeys missing) : file_(std::move(file)), missing_(missing) {}

  template <HasFields T>
  void read(const ConfigNode& node, const std::string& path, T& value, Range = {}) {
    if (node.kind != ConfigNode::Kind::table) return wrong_type(node, path, "a table");
    const auto problems_before = problems_.size();
    std::vector<std::string> known;
    T::fields(value, [&]<class Member>(std::string_view key, Member& member, Range range = {}) {
      known.emplace_back(key);
      const auto member_path = join(path, key);
      if (const auto* child = node.find(key)) return read(*child, member_path, member, range);
      if constexpr (!detail::is_optional<Member>) {
        if (missing_ == MissingKeys::use_default) return;
        missing(node, path, key, expected<Member>(member_path, member, range),
                detail::is_tabular<Member> ? std::string() : to_toml_line(key, to_node(member)));
      }
    });
    unknown_keys(node, path, known);
    // Rules between keys make sense only for values that are right by themselves.
    if constexpr (requires { value.check([](std::string_view, const std::string&) {}); }) {
      if (problems_.size() == problems_before)
        value.check(
            [&](std::string_view key, const std::string& text) { broken_rule(node, path, key, text); });
    }
  }

  template <std::floating_point T>
  void read(const ConfigNode& node, const std::string& path, T& value, Range range = {}) {
    double number{};
    if (read_real(node, path, range, number)) value = static_cast<T>(number);
  }

  template <std::integral T>
  void read(const ConfigNode& node, const std::string& path, T& value, Range range = {}) {
    std::int64_t number{};
    if (read_integer(node, path, within_type<T>(range), number)) value = static_cast<T>(number);
  }

  template <NamedEnum T>
  void read(const ConfigNode& node, const std::string& path, T& value, Range = {}) {
    std::size_t index{};
    if (read_name(node, path, EnumNames<T>::value, index)) value = static_cast<T>(index);
  }

  void read(const ConfigNode& node, const std::string& path, bool& value, Range = {});
  void read(const ConfigNode& node, const std::string& path, std::string& value, Range = {});

  template <class T, std::size_t N>
  void read(const ConfigNode& node, const std::string& path, std::array<T, N>& value, Range range = {}) {
    if (!is_array(node, path, N)) return;
    for (std::size_t i = 0; i < N; ++i) read(node.children[i], element(path, i), value[i], range);
  }

  template <class T>
  void read(const ConfigNode& node, const std::string& path, std::vector<T>& value, Range range = {}) {
    if (!is_array(node, path, std::nullopt)) return;
    value.assign(node.children.size(), T{});
    for (std::size_t i = 0; i < value.size(); ++i) read(node.children[i], element(path, i), value[i], range);
  }

  template <class T>
  void read(const ConfigNode& node, const std::string& path, std::optional<T>& value, Range range = {}) {
    read(node, path, value.emplace(), range);
  }

  std::vector<ConfigProblem> take_problems() { return std::move(problems_); }

 private:
  static std::string join(const std::string& path, std::string_view key);
  static std::string element(const std::string& path, std::size_t index);

  // Description of the expected content of a missing key.
  template <class T>
  static std::string expected(const std::string& path, const T& by_default, Range range) {
    if constexpr (HasFields<T>) {
      return expected_table(path, to_node(by_default));
    } else if constexpr (std::same_as<T, bool>) {
      return "true or false";
    } else if constexpr (std::integral<T>) {
      return expected_number("an integer", path, within_type<T>(range));
    } else if constexpr (std::floating_point<T>) {
      return expected_number("a number", path, range);
    } else if constexpr (NamedEnum<T>) {
      return expected_name(EnumNames<T>::value);
    } else if constexpr (std::same_as<T, std::string>) {
      return "text in quotes";
    } else {
      return expected_array(path, HasFields<typename T::value_type>, array_size<T>());
    }
  }

  template <class T>
  static constexpr std::optional<std::size_t> array_size() {
    if constexpr (requires { std::tuple_size<T>::value; }) return std::tuple_size_v<T>;
    return std::nullopt;
  }

  template <std::integral T>
  static constexpr Range within_type(Range range) {
    const Range type{static_cast<double>(std::numeric_limits<T>::lowest()),
                     static_cast<double>(std::numeric_limits<T>::max())};
    return {range.low > type.low ? range.low : type.low, range.high < type.high ? range.high : type.high};
  }

  static std::string expected_table(std::string_view path, const ConfigNode& keys);
  static std::string expected_number(std::string_view what, std::string_view path, Range range);
  static std::string expected_name(std::span<const std::string_view> names);
  static std::string expected_array(std::string_view path, bool of_tables, std::optional<std::size_t> size);

  bool read_real(const ConfigNode& node, const std::string& path, Range range, double& value);
  bool read_integer(const ConfigNode& node, const std::string& path, Range range, std::int64_t& value);
  bool read_name(const ConfigNode& node, const std::string& path, std::span<const std::string_view> names,
                 std::size_t& index);
  bool is_array(const ConfigNode& node, const std::string& path, std::optional<std::size_t> size);
  bool is_within(const ConfigNode& node, const std::string& path, std::string_view what, Range range,
                 double value);

  void wrong_type(const ConfigNode& node, const std::string& path, std::string_view expected);
  void missing(const ConfigNode& table, const std::string& path, std::string_view key,
               std::string_view expected, std::string_view default_line);
  void unknown_keys(const ConfigNode& table, const std::string& path, std::span<const std::string> known);
  void forget_missing_named_in(std::string_view cure, const std::string& path,
                               std::span<const std::string> known);
  void broken_rule(const ConfigNode& table, const std::string& path, std::string_view key,
                   std::string_view text);
  void add(ConfigPosition position, std::string path, std::string text);

  std::string file_;
  MissingKeys missing_;
  std::vector<ConfigProblem> problems_;
};

}  // namespace sandhopper
