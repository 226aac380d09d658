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
  Schema schema;  // empty if the file contains none
};

// Members refer to the file and stay valid as long as the reader.
struct Message {
  const Channel* channel = nullptr;
  std::uint32_t sequence = 0;
  Stamp stamp;
  Bytes data;
  std::uint64_t offset = 0;  // position of the message's record in the file
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
  bool skip_damaged = false;  // skip a chunk with a wrong CRC instead of throwing
};

// Reads an MCAP file sequentially, without its summary. A file cut at any byte gives every whole record
// before the cut, including whole messages of a cut chunk; then truncated_at() gives its end. The file is
// mapped, not loaded. A file with compressed chunks is unpacked into memory, and offsets then refer to the
// unpacked file (mcap_unpack.hpp). Unknown records are skipped. Throws Error, with file and byte, on damage
// that is not a cut, and std::system_error if the file cannot be opened. The file must not shrink while it is
// read.
class Reader {
 public:
  explicit Reader(const std::filesystem::path& file, ReaderOptions options = {});
  // A file already in memory, which must outlive the reader; `name` is used in messages.
  Reader(Bytes data, std::string name, ReaderOptions options = {});
  Reader(const Reader&) = delete;
  Reader& operator=(const Reader&) = delete;

  // Returns false at the end. Schemas, channels, attachments and metadata are kept when they are read; those
  // before the first message are available from the start.
  [[nodiscard]] bool next(Message& message);

  const std::string& profile() const { return profile_; }
  const std::string& library() const { return library_; }
  const std::map<std::uint16_t, Channel>& channels() const { return channels_; }
  const Channel* find(std::string_view topic) const;
  const std::vector<Attachment>& attachments() const { return attachments_; }
  const std::vector<Metadata>& metadata() const { return metadata_; }
  std::uint64_t file_bytes() const { return file_bytes_; }

  // After next() returned false: end of the last whole record, if the file does not end like a closed log.
  std::optional<std::uint64_t> truncated_at() const { return truncated_at_; }
  // Positions of the chunks that skip_damaged skipped.
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
  std::optional<Record> pending_;  // first message record, read while opening

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

// Throws Error with the first difference if a channel's messages do not match this build's `Record`.
void require_schema(const Channel& channel, const std::string& schema_name, const std::string& schema_text);
template <HasFields Record>
void require_schema(const Channel& channel) {
  require_schema(channel, schema::message_name<Record>(), schema::text_of<Record>());
}

}  // namespace sandhopper::mcap
