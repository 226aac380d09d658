#pragma once
#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <span>
#include <string>
#include <string_view>
#include <vector>

// Common parts of writer and reader of the MCAP container format, version 0 (mcap.dev/spec): a magic, then
// records of {opcode: 1 byte, length: 8 bytes, content}, then the magic again. Integers are little-endian. A
// string is its length in 4 bytes followed by its characters.
namespace sandhopper::mcap {

static_assert(std::endian::native == std::endian::little, "integers are copied, not byte-swapped");

inline constexpr std::array<std::byte, 8> kMagic{std::byte{0x89}, std::byte{'M'}, std::byte{'C'},
                                                 std::byte{'A'},  std::byte{'P'}, std::byte{'0'},
                                                 std::byte{'\r'}, std::byte{'\n'}};
inline constexpr std::size_t kRecordHead = 9;    // opcode and length
inline constexpr std::size_t kMessageHead = 22;  // channel, sequence, two times
inline constexpr std::size_t kChunkHead = 40;    // up to the records, with an empty compression string

enum class Op : std::uint8_t {
  header = 0x01,
  footer = 0x02,
  schema = 0x03,
  channel = 0x04,
  message = 0x05,
  chunk = 0x06,
  message_index = 0x07,
  chunk_index = 0x08,
  attachment = 0x09,
  attachment_index = 0x0A,
  statistics = 0x0B,
  metadata = 0x0C,
  metadata_index = 0x0D,
  summary_offset = 0x0E,
  data_end = 0x0F
};

using Bytes = std::span<const std::byte>;

// Times of a message or attachment, nanoseconds of CLOCK_REALTIME.
struct Stamp {
  std::int64_t log_ns = 0;
  std::int64_t publish_ns = 0;
};

inline Bytes bytes_of(std::string_view text) { return std::as_bytes(std::span(text)); }
inline std::string_view text_of(Bytes bytes) {
  return {reinterpret_cast<const char*>(bytes.data()), bytes.size()};
}

// Content length of the record at `offset`; the record's head must lie within `file`.
inline std::uint64_t length_at(Bytes file, std::uint64_t offset) {
  std::uint64_t length = 0;
  std::memcpy(&length, file.data() + offset + 1, sizeof length);
  return length;
}

// zlib's CRC-32 (polynomial 0xEDB88320 reflected), continued from `crc`; 0 to start.
std::uint32_t crc32(std::uint32_t crc, Bytes bytes);

// Byte buffer that grows at its end.
class Buffer {
 public:
  std::vector<std::byte> bytes;

  std::size_t size() const { return bytes.size(); }
  void clear() { bytes.clear(); }

  template <class T>
  void put(T value) {
    static_assert(std::is_trivially_copyable_v<T>);
    std::memcpy(grow(sizeof(T)), &value, sizeof(T));
  }
  void put(Bytes data) {
    if (!data.empty()) std::memcpy(grow(data.size()), data.data(), data.size());
  }
  void put_text(std::string_view text) {
    put(static_cast<std::uint32_t>(text.size()));
    put(bytes_of(text));
  }
  template <class T>
  void put_at(std::size_t offset, T value) {
    std::memcpy(bytes.data() + offset, &value, sizeof(T));
  }
  std::byte* grow(std::size_t count) {
    const std::size_t start = bytes.size();
    bytes.resize(start + count);
    return bytes.data() + start;
  }

  // open_record() begins a record and returns the start of its content; close_record() writes its length.
  std::size_t open_record(Op op) {
    put(op);
    put(std::uint64_t{0});
    return size();
  }
  void close_record(std::size_t content) {
    put_at(content - sizeof(std::uint64_t), static_cast<std::uint64_t>(size() - content));
  }
  // A map or array is preceded by its length in bytes: open_list() reserves it, close_list() writes it.
  std::size_t open_list() {
    put(std::uint32_t{0});
    return size();
  }
  void close_list(std::size_t content) {
    put_at(content - sizeof(std::uint32_t), static_cast<std::uint32_t>(size() - content));
  }
};

// Reads sequentially. `ok` becomes false at the first read beyond the end and stays false.
class Cursor {
 public:
  explicit Cursor(Bytes data) : data_(data) {}

  bool ok = true;
  Bytes rest() const { return data_; }

  template <class T>
  T take() {
    T value{};
    if (const Bytes part = take(sizeof(T)); ok) std::memcpy(&value, part.data(), sizeof(T));
    return value;
  }
  Bytes take(std::uint64_t count) {
    if (!ok || count > data_.size()) {
      ok = false;
      return {};
    }
    const Bytes part = data_.first(static_cast<std::size_t>(count));
    data_ = data_.subspan(static_cast<std::size_t>(count));
    return part;
  }
  std::string_view take_text() { return text_of(take(take<std::uint32_t>())); }

 private:
  Bytes data_;
};

}  // namespace sandhopper::mcap
