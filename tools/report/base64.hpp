#pragma once
#include <bit>
#include <cstddef>
#include <span>
#include <string>

namespace sandhopper {

// RFC 4648, section 4, with padding.
std::string base64(std::span<const std::byte> bytes);

// The numbers as they lie in memory; a page reads them back as a typed array, which is little-endian
// everywhere.
template <class Number>
std::string base64_numbers(std::span<const Number> numbers) {
  static_assert(std::endian::native == std::endian::little);
  return base64(std::as_bytes(numbers));
}

}  // namespace sandhopper
