#pragma once
#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <span>
#include <string_view>
#include <type_traits>

#include "config/fields.hpp"

// Common Data Representation, plain (XCDR version 1) and little-endian, as ROS 2 uses it in messages and bags
// (OMG DDSI-RTPS 2.5, section 10; OMG DDS-XTypes 1.3, section 7.4.1): four bytes {0, 1, 0, 0}, then each
// field at a multiple of its own size, counted from behind these four bytes. Records have no strings and no
// sequences, so the size of an encoded record is a compile-time constant. Padding is zero, so equal records
// give equal bytes. Nothing here allocates or throws.
namespace sandhopper::cdr {

static_assert(std::endian::native == std::endian::little, "records are copied, not byte-swapped");

inline constexpr std::size_t kHeaderBytes = 4;
inline constexpr std::array<std::byte, kHeaderBytes> kHeader{std::byte{0}, std::byte{1}, std::byte{0},
                                                             std::byte{0}};

namespace detail {

template <class T>
inline constexpr bool kIsArray = false;
template <class T, std::size_t N>
inline constexpr bool kIsArray<std::array<T, N>> = true;

template <class T>
concept Scalar = std::is_arithmetic_v<T> || std::is_enum_v<T>;

constexpr std::size_t aligned(std::size_t offset, std::size_t alignment) {
  return (offset + alignment - 1) & ~(alignment - 1);
}

struct Sizer {
  std::size_t offset = 0;
  template <class T>
  constexpr void operator()(std::string_view, const T& value) {
    add(value);
  }
  template <class T>
  constexpr void add(const T& value) {
    if constexpr (kIsArray<T>) {
      for (const auto& element : value) add(element);
    } else if constexpr (HasFields<T>) {
      T::fields(value, *this);
    } else {
      static_assert(Scalar<T>, "a record's field is a number, an enum, a record or an array of those");
      offset = aligned(offset, sizeof(T)) + sizeof(T);
    }
  }
};

struct Encoder {
  std::byte* out;
  std::size_t offset = 0;
  template <class T>
  [[gnu::always_inline]] void operator()(std::string_view, const T& value) noexcept {
    add(value);
  }
  template <class T>
  [[gnu::always_inline]] void add(const T& value) noexcept {
    if constexpr (kIsArray<T>) {
      for (const auto& element : value) add(element);
    } else if constexpr (HasFields<T>) {
      T::fields(value, *this);
    } else {
      const std::size_t start = aligned(offset, sizeof(T));
      while (offset < start) out[offset++] = std::byte{0};
      std::memcpy(out + start, &value, sizeof(T));
      offset = start + sizeof(T);
    }
  }
};

struct Decoder {
  const std::byte* in;
  std::size_t offset = 0;
  template <class T>
  [[gnu::always_inline]] void operator()(std::string_view, T& value) noexcept {
    take(value);
  }
  template <class T>
  [[gnu::always_inline]] void take(T& value) noexcept {
    if constexpr (kIsArray<T>) {
      for (auto& element : value) take(element);
    } else if constexpr (HasFields<T>) {
      T::fields(value, *this);
    } else {
      offset = aligned(offset, sizeof(T));
      if constexpr (std::is_same_v<T, bool>) {
        value = in[offset] != std::byte{0};
      } else {
        std::memcpy(&value, in + offset, sizeof(T));
      }
      offset += sizeof(T);
    }
  }
};

}  // namespace detail

// Bytes of an encoded record, including the four bytes of the header.
template <HasFields Record>
consteval std::size_t size_of() {
  detail::Sizer sizer;
  const Record record{};
  Record::fields(record, sizer);
  return kHeaderBytes + sizer.offset;
}

// Writes exactly size_of<Record>() bytes.
template <HasFields Record>
void encode(const Record& record, std::byte* out) noexcept {
  std::memcpy(out, kHeader.data(), kHeaderBytes);
  detail::Encoder encoder{out + kHeaderBytes};
  Record::fields(record, encoder);
}

// Returns false and leaves `record` unchanged if `bytes` is not a little-endian record of exactly this size.
template <HasFields Record>
[[nodiscard]] bool decode(std::span<const std::byte> bytes, Record& record) noexcept {
  if (bytes.size() != size_of<Record>()) return false;
  if (bytes[0] != kHeader[0] || bytes[1] != kHeader[1]) return false;
  detail::Decoder decoder{bytes.data() + kHeaderBytes};
  Record::fields(record, decoder);
  return true;
}

}  // namespace sandhopper::cdr
