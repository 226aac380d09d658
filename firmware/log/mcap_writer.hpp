#pragma once
#include <cstdint>
#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "config/fields.hpp"
#include "firmware/log/append_file.hpp"
#include "firmware/log/cdr.hpp"
#include "firmware/log/mcap_format.hpp"
#include "firmware/log/schema_text.hpp"

namespace sandhopper::mcap {

struct WriterOptions {
  std::string library = "sandhopper";
  std::size_t chunk_bytes = 262'144;          // a chunk is closed when it reaches this size
  std::int64_t chunk_span_ns = 100'000'000;   // or when a message is this much younger than its first
  std::int64_t sync_span_ns = 1'000'000'000;  // message time between two fdatasync(2); 0: never
  bool keep_going = false;                    // a chunk that cannot be written is dropped, see take_loss()
  std::uint64_t reserve_bytes = 0;            // disk space kept for the data after open_reserve()
  FileCalls calls = FileCalls::of_the_system();
};

// Messages that did not get into the file, or that may not be on the disk.
struct Loss {
  std::uint64_t messages = 0;
  std::int64_t first_ns = 0;  // log times
  std::int64_t last_ns = 0;
  bool synced = true;  // false: written, but fdatasync(2) failed
  int error = 0;       // errno
};

// Writes an MCAP file (profile "ros2") sequentially. After a crash or a power cut everything up to the last
// closed chunk is in the file, and the reader uses it. Chunks are closed by their content, not by the clock,
// and no time is read here: the same calls give the same bytes. Refuses to overwrite a file. Throws
// std::system_error if the file cannot be created or written. A chunk that could not be written is not in the
// file, not even in part. For one thread.
class Writer {
 public:
  explicit Writer(const std::filesystem::path& file, WriterOptions options = {});
  ~Writer();  // closes the file; an error is lost here, so call close()
  Writer(const Writer&) = delete;
  Writer& operator=(const Writer&) = delete;

  // Returns the channel's number. `schema_name` is "package/msg/Name"; equal schemas are stored once.
  std::uint16_t add_channel(std::string_view topic, std::string_view schema_name,
                            std::string_view schema_text);
  template <HasFields Record>
  std::uint16_t add_channel(std::string_view topic) {
    return add_channel(topic, schema::message_name<Record>(), schema::text_of<Record>());
  }

  void write(std::uint16_t channel, Stamp stamp, Bytes data);
  template <HasFields Record>
  void write(std::uint16_t channel, Stamp stamp, const Record& record) {
    cdr::encode(record, open_message(channel, stamp, cdr::size_of<Record>()));
    close_message(stamp);
  }

  // attach() and add_metadata() close the open chunk first.
  void attach(std::string_view name, std::string_view media_type, std::int64_t time_ns, Bytes data);
  void add_metadata(std::string_view name, const std::map<std::string, std::string>& entries);

  // Closes the open chunk if a message with this time would close it.
  void close_chunk_before(std::int64_t log_ns);
  void flush();  // closes the open chunk and writes it
  // Writes the open chunk, summary and footer; nothing may follow. If the disk has no room for the summary it
  // is left out.
  void close();

  // With `keep_going`: the last lost chunk, returned once; and the number of closed chunks, lost or not.
  std::optional<Loss> take_loss() { return std::exchange(loss_, std::nullopt); }
  std::uint64_t chunks_closed() const { return chunks_closed_; }
  // Later data may use the disk's reserve.
  void open_reserve() noexcept { file_.open_reserve(); }

  const std::filesystem::path& path() const { return file_.path(); }
  std::uint64_t bytes() const { return position_; }     // size of the file without the open chunk
  std::uint64_t messages() const { return messages_; }  // messages in the file without the open chunk
  std::int64_t first_ns() const { return low_ns_; }
  std::int64_t last_ns() const { return high_ns_; }

 private:
  struct Schema {
    std::string name;
    std::string text;
  };
  struct Channel {
    std::string topic;
    std::uint16_t schema = 0;
    std::uint32_t sequence = 0;                                 // also counts lost messages
    std::uint64_t messages = 0;                                 // in the file
    std::vector<std::pair<std::int64_t, std::uint64_t>> index;  // time and offset of each message in the open
                                                                // chunk
  };

  std::byte* open_message(std::uint16_t channel, Stamp stamp, std::size_t bytes);
  void close_message(Stamp stamp);
  void close_chunk();
  void drop_chunk(int error);
  void count_chunk();
  void sync();
  Buffer end_of_file(bool with_summary) const;
  void put_summary(Buffer& out, std::uint64_t start) const;
  void put_schema(Buffer& out, std::size_t number) const;
  void put_channel(Buffer& out, std::size_t number) const;
  void put_statistics(Buffer& out) const;
  void append(Bytes data);

  AppendFile file_;
  WriterOptions options_;
  std::uint64_t position_ = 0;
  std::uint32_t data_crc_ = 0;

  std::vector<Schema> schemas_;  // number i is stored as i + 1: 0 means "none" in the format
  std::vector<Channel> channels_;
  Buffer chunk_;  // the open chunk with its head
  std::uint64_t chunk_messages_ = 0;
  Stamp chunk_first_;
  std::int64_t chunk_low_ns_ = 0;
  std::int64_t chunk_high_ns_ = 0;

  Buffer chunk_indexes_;
  Buffer attachment_indexes_;
  Buffer metadata_indexes_;
  std::uint32_t chunks_ = 0;
  std::uint32_t attachments_ = 0;
  std::uint32_t metadata_ = 0;
  std::uint64_t messages_ = 0;
  std::int64_t low_ns_ = 0;
  std::int64_t high_ns_ = 0;
  std::int64_t synced_ns_ = 0;
  std::uint64_t chunks_closed_ = 0;
  std::optional<Loss> loss_;
};

}  // namespace sandhopper::mcap
