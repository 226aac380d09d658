#pragma once
#include <array>
#include <concepts>
#include <limits>
#include <string_view>
#include <type_traits>

// Every role (a configuration table, a log record, a command, a status) is one struct whose fields are listed
// exactly once, in a static member template:
//
//   template <class Self, class Visitor>
//   static constexpr void fields(Self& self, Visitor&& visit) {
//     visit("mass_kg", self.mass_kg, Range{0.0, 10.0});
//   }
//
// Configuration loading, log schema, log encoding, CSV columns and JSON all use this one list. The unit is
// part of the name. `Range` is the closed interval that the loader accepts; records omit it.
namespace sandhopper {

struct Range {
  double low = -std::numeric_limits<double>::infinity();
  double high = std::numeric_limits<double>::infinity();
};

namespace detail {
struct AnyVisitor {
  template <class... Args>
  constexpr void operator()(Args&&...) const {}
};
}  // namespace detail

template <class T>
concept HasFields = requires(T& value) {
  std::remove_cv_t<T>::fields(value, detail::AnyVisitor{});
};

// Names of an enum's values, in the order 0, 1, 2, …; specialise next to the enum.
template <class E>
struct EnumNames;

template <class E>
concept NamedEnum = std::is_enum_v<E> && requires {
  EnumNames<E>::value.size();
};

template <NamedEnum E>
constexpr std::string_view name_of(E value) {
  const auto index = static_cast<std::size_t>(value);
  return index < EnumNames<E>::value.size() ? EnumNames<E>::value[index] : std::string_view{"?"};
}

}  // namespace sandhopper
