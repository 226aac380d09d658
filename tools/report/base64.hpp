#pragma once
#include <bit>
#include <cstddef>
#include <span>
#include <string>

namespace sandhopper {

// Base64 with padding, RFC 4648 section 4.
std::string base64(std::span<const std::byte> bytes);

// Encodes the numbers in little-endian byte order, as a JavaScript typed array of the page expects them.
template <class Number>
std::string base64_numbers(std::span<const Number> numbers) {
  static_assert(std::endian::native == std::endian::little);
  return base64(std::as_bytes(numbers));
}

}  // namespace sandhopper
