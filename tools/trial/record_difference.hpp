#pragma once
#include <fmt/format.h>

#include <array>
#include <bit>
#include <cstdint>
#include <string>

#include "config/fields.hpp"

namespace sandhopper {
namespace detail {

template <class T>
std::string difference_at(const std::string& path, const T& logged, const T& replayed) {
  if constexpr (HasFields<const T>) {
    std::string found;
    T::fields(logged, [&](std::string_view name, const auto& member, auto&&...) {
      using Member = std::remove_cvref_t<decltype(member)>;
      const auto offset =
          reinterpret_cast<const std::byte*>(&member) - reinterpret_cast<const std::byte*>(&logged);
      const auto& other =
          *reinterpret_cast<const Member*>(reinterpret_cast<const std::byte*>(&replayed) + offset);
      if (found.empty())
        found =
            difference_at(path.empty() ? std::string(name) : fmt::format("{}.{}", path, name), member, other);
    });
    return found;
  } else if constexpr (requires { logged.size(); }) {
    for (std::size_t i = 0; i < logged.size(); ++i)
      if (auto found = difference_at(fmt::format("{}[{}]", path, i), logged[i], replayed[i]); !found.empty())
        return found;
    return {};
  } else if constexpr (std::is_enum_v<T>) {
    return logged == replayed
               ? std::string{}
               : fmt::format("{}: logged {}, replayed {}", path, name_of(logged), name_of(replayed));
  } else if constexpr (std::is_same_v<T, double>) {
    const bool same = std::bit_cast<std::uint64_t>(logged) == std::bit_cast<std::uint64_t>(replayed);
    return same ? std::string{} : fmt::format("{}: logged {:.17g}, replayed {:.17g}", path, logged, replayed);
  } else {
    return logged == replayed ? std::string{}
                              : fmt::format("{}: logged {}, replayed {}", path, logged, replayed);
  }
}

}  // namespace detail

// First field in which two records differ, with both values; empty if they are equal. Doubles are compared
// bit by bit.
template <HasFields Record>
std::string first_difference(const Record& logged, const Record& replayed) {
  return detail::difference_at("", logged, replayed);
}

}  // namespace sandhopper
