#pragma once
#include <cstdint>
#include <filesystem>
#include <map>
#include <optional>
#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

#include "firmware/log/cdr.hpp"
#include "firmware/log/mapped_file.hpp"
#include "firmware/log/mcap_format.hpp"
#include "firmware/log/schema_text.hpp"

namespace sandhopper::mcap {

class Error : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

struct Schema {
  std::string name;
  std::string encoding;
  std::string text;
};

struct Channel {
  std::uint16_t number = 0;
  std::string topic;
  std::string message_encoding;
  Schema schema;  // empty when the file gives none
};

// Views into the file; valid as long as the reader.
struct Message {
  const Channel* channel = nullptr;
  std::uint32_t sequence = 0;
  Stamp stamp;
  Bytes data;
  std::uint64_t offset = 0;  // of the message's record in the file
};

struct Attachment {
  std::string_view name;
  std::string_view media_type;
  std::int64_t log_ns = 0;
  Bytes data;
};

struct Metadata {
  std::string_view name;
  std::map<std::string, std::string> entries;
};

struct ReaderOptions {
  bool check_crc = true;
  bool skip_damaged = false;  // pass over a chunk whose CRC is wrong instead of throwing
};

// Reads an MCAP file front to back, as written, without its summary: a file cut at any byte gives every whole
// record before the cut, whole messages of a cut chunk included, and then says where it ends (truncated_at).
// The file is mapped, not loaded; one with compressed chunks is unpacked into memory, and bytes then count in
// the unpacked file (mcap_unpack.hpp). Unknown records are passed over. Throws Error, with file and byte, on
// damage that is not a cut; std::system_error when the file cannot be opened. The file must not shrink while
// it is read.
class Reader {
 public:
  explicit Reader(const std::filesystem::path& file, ReaderOptions options = {});
  // A file already in memory, which must outlive the reader; `name` is for messages.
  Reader(Bytes data, std::string name, ReaderOptions options = {});
  Reader(const Reader&) = delete;
  Reader& operator=(const Reader&) = delete;

  // False at the end. Schemas, channels, attachments and metadata met on the way are kept; those written in
  // front of the first message are there from the start.
  [[nodiscard]] bool next(Message& message);

  const std::string& profile() const { return profile_; }
  const std::string& library() const { return library_; }
  const std::map<std::uint16_t, Channel>& channels() const { return channels_; }
  const Channel* find(std::string_view topic) const;
  const std::vector<Attachment>& attachments() const { return attachments_; }
  const std::vector<Metadata>& metadata() const { return metadata_; }
  std::uint64_t file_bytes() const { return file_bytes_; }

  // After next() said false: where the last whole record ends, if the file does not end as a closed log does.
  std::optional<std::uint64_t> truncated_at() const { return truncated_at_; }
  // Places of chunks passed over because of skip_damaged.
  const std::vector<std::uint64_t>& damaged_chunks() const { return damaged_chunks_; }

 private:
  struct Record {
    Op op{};
    Bytes content;
    std::uint64_t offset = 0;
  };
  enum class Step { record, end };

  void open();
  Step take_record(Record& record);
  Step take_outer(Record& record);
  void enter_chunk(Bytes content, std::uint64_t offset, std::uint64_t length);
  bool chunk_is_sound(Bytes records, std::uint32_t crc, std::uint64_t offset, std::uint64_t end);
  void keep(const Record& record);
  void keep_channel(Cursor& in);
  void keep_attachment(Bytes content, std::uint64_t offset);
  bool take_message(const Record& record, Message& message);
  Step cut_at(std::uint64_t offset);
  [[noreturn]] void fail(std::uint64_t offset, const std::string& what) const;

  std::string name_;
  ReaderOptions options_;
  MappedFile map_;
  std::uint64_t file_bytes_ = 0;
  std::optional<std::vector<std::byte>> unpacked_;
  Bytes file_;
  bool closed_ = false;  // ends with the magic
  bool ended_ = false;
  bool in_summary_ = false;
  std::uint64_t position_ = 0;   // next record outside a chunk
  std::uint64_t inner_ = 0;      // next record in the chunk
  std::uint64_t inner_end_ = 0;  // 0: not in a chunk
  bool chunk_is_cut_ = false;
  std::optional<Record> pending_;  // first message record, met while opening

  std::string profile_;
  std::string library_;
  std::map<std::uint16_t, Schema> schemas_;
  std::map<std::uint16_t, Channel> channels_;
  std::vector<const Channel*> by_number_;
  std::vector<Attachment> attachments_;
  std::vector<Metadata> metadata_;
  std::optional<std::uint64_t> truncated_at_;
  std::vector<std::uint64_t> damaged_chunks_;
};

// Throws Error naming the first difference when a channel's messages are not this build's `Record`.
void require_schema(const Channel& channel, const std::string& schema_name, const std::string& schema_text);
template <HasFields Record>
void require_schema(const Channel& channel) {
  require_schema(channel, schema::message_name<Record>(), schema::text_of<Record>());
}

}  // namespace sandhopper::mcap
