#pragma once
#include <array>
#include <cctype>
#include <set>
#include <stdexcept>
#include <string>
#include <string_view>
#include <type_traits>

#include "config/fields.hpp"

// `ros2msg` definition of a record, made from its `fields`: one line per field. A nested record's definition
// follows after a line of 80 '=' and "MSG: package/Name". An enum's values are constants named after its
// field, before it. ROS 2 allows only lower case in field names. So current_A becomes current_a, and its true
// name with the unit follows as a comment. The encoded bytes contain no names. Not for the cycle.
namespace sandhopper::schema {

inline constexpr std::string_view kPackage = "sandhopper_msgs";

// A type's name without namespaces.
template <class T>
constexpr std::string_view type_name() {
  std::string_view text = __PRETTY_FUNCTION__;  // "… [with T = sandhopper::Event; …]", clang: "… [T = …]"
  text.remove_prefix(text.find("T = ") + 4);
  text = text.substr(0, text.find_first_of(";]"));
  if (const auto colon = text.rfind(':'); colon != std::string_view::npos) text.remove_prefix(colon + 1);
  return text;
}

// Name of a log's schema, such as "sandhopper_msgs/msg/Event".
template <HasFields Record>
std::string message_name() {
  return std::string(kPackage) + "/msg/" + std::string(type_name<Record>());
}

namespace detail {

template <class T>
struct Element {
  using type = T;
  static constexpr std::size_t count = 1;
  static constexpr bool is_array = false;
};
template <class T, std::size_t N>
struct Element<std::array<T, N>> {
  using type = typename Element<T>::type;  // an array of arrays is one array, row by row
  static constexpr std::size_t count = N * Element<T>::count;
  static constexpr bool is_array = true;
};

template <class T>
std::string scalar_name() {
  if constexpr (std::is_enum_v<T>) {
    return scalar_name<std::underlying_type_t<T>>();
  } else if constexpr (std::is_same_v<T, bool>) {
    return "bool";
  } else if constexpr (std::is_floating_point_v<T>) {
    return "float" + std::to_string(8 * sizeof(T));
  } else {
    return (std::is_signed_v<T> ? "int" : "uint") + std::to_string(8 * sizeof(T));
  }
}

inline std::string upper_case(std::string_view name) {
  std::string text(name);
  for (char& c : text) c = static_cast<char>(std::toupper(static_cast<unsigned char>(c)));
  return text;
}

inline std::string lower_case(std::string_view name) {
  std::string text(name);
  for (char& c : text) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  return text;
}

// Collects the definitions of a record's nested types, in the order of their first use.
struct Writer {
  std::string own;
  std::string nested;
  std::set<std::string, std::less<>>* done;
  std::set<std::string, std::less<>> names{};

  template <class T>
  void operator()(std::string_view name, const T&) {
    using E = typename Element<T>::type;
    const std::string field = lower_case(name);
    if (!names.insert(field).second)
      throw std::logic_error("two fields differ only in case: " + std::string(name));
    if constexpr (NamedEnum<E>) add_constants<E>(name);
    own += type_text<E>();
    if constexpr (Element<T>::is_array) own += '[' + std::to_string(Element<T>::count) + ']';
    own += ' ' + field;
    if (field != name) own += "  # " + std::string(name);
    own += '\n';
    if constexpr (HasFields<E>) add_definition<E>();
  }

  template <class E>
  void add_constants(std::string_view name) {
    for (std::size_t i = 0; i < EnumNames<E>::value.size(); ++i)
      own += scalar_name<E>() + ' ' + upper_case(name) + '_' + upper_case(EnumNames<E>::value[i]) + '=' +
             std::to_string(i) + '\n';
  }

  template <class E>
  static std::string type_text() {
    if constexpr (HasFields<E>) {
      return std::string(kPackage) + '/' + std::string(type_name<E>());
    } else {
      return scalar_name<E>();
    }
  }

  template <class E>
  void add_definition() {
    if (!done->insert(type_text<E>()).second) return;
    Writer inner{{}, {}, done};
    const E value{};
    E::fields(value, inner);
    nested += std::string(80, '=') + "\nMSG: " + type_text<E>() + '\n' + inner.own + inner.nested;
  }
};

}  // namespace detail

template <HasFields Record>
std::string text_of() {
  std::set<std::string, std::less<>> done;
  detail::Writer writer{{}, {}, &done};
  const Record record{};
  Record::fields(record, writer);
  return writer.own + writer.nested;
}

}  // namespace sandhopper::schema
