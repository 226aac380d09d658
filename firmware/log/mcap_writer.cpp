#include "firmware/log/mcap_writer.hpp"

#include <algorithm>
#include <limits>
#include <stdexcept>
#include <system_error>
#include <utility>

namespace sandhopper::mcap {

namespace {

// Position of a group of equal records in the summary.
struct Group {
  Op op;
  std::size_t start;
  std::size_t length;
};

// True if more than span_ns passed. In a recovered log the difference of two times may overflow.
bool passed(std::int64_t from_ns, std::int64_t to_ns, std::int64_t span_ns) {
  std::int64_t since_ns = 0;
  return __builtin_sub_overflow(to_ns, from_ns, &since_ns) || since_ns >= span_ns;
}

}  // namespace

Writer::Writer(const std::filesystem::path& file, WriterOptions options)
    : file_(file, options.reserve_bytes, options.calls), options_(std::move(options)) {
  chunk_.bytes.reserve(options_.chunk_bytes + options_.chunk_bytes / 4);
  Buffer out;
  out.put(Bytes(kMagic));
  const std::size_t content = out.open_record(Op::header);
  out.put_text("ros2");
  out.put_text(options_.library);
  out.close_record(content);
  append(out.bytes);
}

Writer::~Writer() {
  try {
    close();
  } catch (const std::exception&) {
  }
}

std::uint16_t Writer::add_channel(std::string_view topic, std::string_view schema_name,
                                  std::string_view schema_text) {
  flush();
  Buffer out;
  auto schema = std::find_if(schemas_.begin(), schemas_.end(),
                             [&](const Schema& s) { return s.name == schema_name && s.text == schema_text; });
  const auto number = static_cast<std::size_t>(schema - schemas_.begin());
  if (schema == schemas_.end()) {
    schemas_.push_back({std::string(schema_name), std::string(schema_text)});
    put_schema(out, number);
  }
  if (channels_.size() >= std::numeric_limits<std::uint16_t>::max())
    throw std::length_error("too many topics");
  channels_.push_back({std::string(topic), static_cast<std::uint16_t>(number + 1), 0, 0, {}});
  put_channel(out, channels_.size() - 1);
  append(out.bytes);
  return static_cast<std::uint16_t>(channels_.size() - 1);
}

void Writer::put_schema(Buffer& out, std::size_t number) const {
  const std::size_t content = out.open_record(Op::schema);
  out.put(static_cast<std::uint16_t>(number + 1));
  out.put_text(schemas_[number].name);
  out.put_text("ros2msg");
  out.put_text(schemas_[number].text);
  out.close_record(content);
}

void Writer::put_channel(Buffer& out, std::size_t number) const {
  const std::size_t content = out.open_record(Op::channel);
  out.put(static_cast<std::uint16_t>(number));
  out.put(channels_[number].schema);
  out.put_text(channels_[number].topic);
  out.put_text("cdr");
  out.put(std::uint32_t{0});  // no metadata
  out.close_record(content);
}

void Writer::write(std::uint16_t channel, Stamp stamp, Bytes data) {
  if (std::byte* place = open_message(channel, stamp, data.size()); !data.empty())
    std::memcpy(place, data.data(), data.size());
  close_message(stamp);
}

void Writer::close_chunk_before(std::int64_t log_ns) {
  if (chunk_messages_ > 0 && passed(chunk_first_.log_ns, log_ns, options_.chunk_span_ns)) close_chunk();
}

std::byte* Writer::open_message(std::uint16_t number, Stamp stamp, std::size_t bytes) {
  Channel& channel = channels_.at(number);
  close_chunk_before(stamp.log_ns);
  if (chunk_messages_ == 0) {
    chunk_.clear();
    chunk_.grow(kRecordHead + kChunkHead);
    chunk_first_ = stamp;
    chunk_low_ns_ = chunk_high_ns_ = stamp.log_ns;
  }
  channel.index.emplace_back(stamp.log_ns, chunk_.size() - kRecordHead - kChunkHead);
  chunk_.put(Op::message);
  chunk_.put(static_cast<std::uint64_t>(kMessageHead + bytes));
  chunk_.put(number);
  chunk_.put(channel.sequence++);
  chunk_.put(stamp.log_ns);
  chunk_.put(stamp.publish_ns);
  return chunk_.grow(bytes);
}

void Writer::close_message(Stamp stamp) {
  chunk_low_ns_ = std::min(chunk_low_ns_, stamp.log_ns);
  chunk_high_ns_ = std::max(chunk_high_ns_, stamp.log_ns);
  ++chunk_messages_;
  if (chunk_.size() >= options_.chunk_bytes) close_chunk();
}

void Writer::close_chunk() {
  if (chunk_messages_ == 0) return;
  const std::size_t head = kRecordHead + kChunkHead;
  const std::uint64_t records = chunk_.size() - head;
  Buffer front;
  front.put(Op::chunk);
  front.put(static_cast<std::uint64_t>(kChunkHead + records));
  front.put(chunk_low_ns_);
  front.put(chunk_high_ns_);
  front.put(records);
  front.put(crc32(0, Bytes(chunk_.bytes).subspan(head)));
  front.put_text("");  // compression: none
  front.put(records);
  std::copy(front.bytes.begin(), front.bytes.end(), chunk_.bytes.begin());
  const std::uint64_t chunk_start = position_;
  const std::uint64_t chunk_length = chunk_.size();

  const std::size_t indexes_before = chunk_indexes_.size();
  const std::size_t entry = chunk_indexes_.open_record(Op::chunk_index);
  chunk_indexes_.put(chunk_low_ns_);
  chunk_indexes_.put(chunk_high_ns_);
  chunk_indexes_.put(chunk_start);
  chunk_indexes_.put(chunk_length);
  const std::size_t offsets = chunk_indexes_.open_list();
  for (std::size_t i = 0; i < channels_.size(); ++i) {
    auto& index = channels_[i].index;
    if (index.empty()) continue;
    std::stable_sort(index.begin(), index.end(), [](auto& a, auto& b) { return a.first < b.first; });
    chunk_indexes_.put(static_cast<std::uint16_t>(i));
    chunk_indexes_.put(chunk_start + chunk_.size());
    const std::size_t content = chunk_.open_record(Op::message_index);
    chunk_.put(static_cast<std::uint16_t>(i));
    const std::size_t list = chunk_.open_list();
    for (const auto& [time_ns, place] : index) {
      chunk_.put(time_ns);
      chunk_.put(place);
    }
    chunk_.close_list(list);
    chunk_.close_record(content);
  }
  chunk_indexes_.close_list(offsets);
  chunk_indexes_.put(static_cast<std::uint64_t>(chunk_.size()) - chunk_length);
  chunk_indexes_.put_text("");
  chunk_indexes_.put(records);
  chunk_indexes_.put(records);
  chunk_indexes_.close_record(entry);

  ++chunks_closed_;
  try {
    append(chunk_.bytes);
  } catch (const std::system_error& error) {
    if (!options_.keep_going) throw;
    chunk_indexes_.bytes.resize(indexes_before);
    drop_chunk(error.code().value());
    return;
  }
  count_chunk();
  if (options_.sync_span_ns > 0 && passed(synced_ns_, chunk_high_ns_, options_.sync_span_ns)) sync();
}

void Writer::count_chunk() {
  for (Channel& channel : channels_) {
    channel.messages += channel.index.size();
    channel.index.clear();
  }
  low_ns_ = messages_ == 0 ? chunk_low_ns_ : std::min(low_ns_, chunk_low_ns_);
  high_ns_ = messages_ == 0 ? chunk_high_ns_ : std::max(high_ns_, chunk_high_ns_);
  messages_ += chunk_messages_;
  ++chunks_;
  chunk_messages_ = 0;
}

void Writer::drop_chunk(int error) {
  for (Channel& channel : channels_) channel.index.clear();
  loss_ =
      Loss{.messages = chunk_messages_, .first_ns = chunk_low_ns_, .last_ns = chunk_high_ns_, .error = error};
  chunk_messages_ = 0;
}

void Writer::sync() {
  const std::int64_t since_ns = synced_ns_;
  synced_ns_ = chunk_high_ns_;
  const int error = file_.sync();
  if (error == 0 || !options_.keep_going) return;
  loss_ = Loss{
      .first_ns = std::max(since_ns, low_ns_), .last_ns = chunk_high_ns_, .synced = false, .error = error};
}

void Writer::attach(std::string_view name, std::string_view media_type, std::int64_t time_ns, Bytes data) {
  flush();
  Buffer out;
  const std::size_t content = out.open_record(Op::attachment);
  out.put(time_ns);
  out.put(time_ns);
  out.put_text(name);
  out.put_text(media_type);
  out.put(static_cast<std::uint64_t>(data.size()));
  out.put(data);
  out.put(crc32(0, Bytes(out.bytes).subspan(content)));
  out.close_record(content);
  const std::uint64_t start = position_;
  append(out.bytes);

  const std::size_t entry = attachment_indexes_.open_record(Op::attachment_index);
  attachment_indexes_.put(start);
  attachment_indexes_.put(static_cast<std::uint64_t>(out.size()));
  attachment_indexes_.put(time_ns);
  attachment_indexes_.put(time_ns);
  attachment_indexes_.put(static_cast<std::uint64_t>(data.size()));
  attachment_indexes_.put_text(name);
  attachment_indexes_.put_text(media_type);
  attachment_indexes_.close_record(entry);
  ++attachments_;
}

void Writer::add_metadata(std::string_view name, const std::map<std::string, std::string>& entries) {
  flush();
  Buffer out;
  const std::size_t content = out.open_record(Op::metadata);
  out.put_text(name);
  const std::size_t list = out.open_list();
  for (const auto& [key, value] : entries) {
    out.put_text(key);
    out.put_text(value);
  }
  out.close_list(list);
  out.close_record(content);
  const std::uint64_t start = position_;
  append(out.bytes);

  const std::size_t entry = metadata_indexes_.open_record(Op::metadata_index);
  metadata_indexes_.put(start);
  metadata_indexes_.put(static_cast<std::uint64_t>(out.size()));
  metadata_indexes_.put_text(name);
  metadata_indexes_.close_record(entry);
  ++metadata_;
}

void Writer::put_statistics(Buffer& out) const {
  const std::size_t content = out.open_record(Op::statistics);
  out.put(messages_);
  out.put(static_cast<std::uint16_t>(schemas_.size()));
  out.put(static_cast<std::uint32_t>(channels_.size()));
  out.put(attachments_);
  out.put(metadata_);
  out.put(chunks_);
  out.put(low_ns_);
  out.put(high_ns_);
  const std::size_t list = out.open_list();
  for (std::size_t i = 0; i < channels_.size(); ++i) {
    out.put(static_cast<std::uint16_t>(i));
    out.put(channels_[i].messages);
  }
  out.close_list(list);
  out.close_record(content);
}

void Writer::flush() { close_chunk(); }

void Writer::close() {
  if (!file_.is_open()) return;
  flush();
  file_.open_reserve();
  try {
    append(end_of_file(true).bytes);
  } catch (const std::system_error&) {
    if (!options_.keep_going) throw;
    append(end_of_file(false).bytes);
  }
  sync();
  file_.close();
}

Buffer Writer::end_of_file(bool with_summary) const {
  Buffer out;
  std::size_t content = out.open_record(Op::data_end);
  out.put(data_crc_);
  out.close_record(content);
  if (with_summary) {
    put_summary(out, position_ + out.size());
  } else {
    content = out.open_record(Op::footer);
    out.put(std::uint64_t{0});  // no summary
    out.put(std::uint64_t{0});
    out.put(std::uint32_t{0});
    out.close_record(content);
  }
  out.put(Bytes(kMagic));
  return out;
}

// Appends summary and footer. The summary begins at `start` of the file, which is the present end of `out`.
void Writer::put_summary(Buffer& out, std::uint64_t start) const {
  const std::size_t before = out.size();
  std::vector<Group> groups;
  const auto add_group = [&](Op op, auto&& put_records) {
    const std::size_t place = out.size();
    put_records();
    if (out.size() > place) groups.push_back({op, place - before, out.size() - place});
  };
  add_group(Op::schema, [&] {
    for (std::size_t i = 0; i < schemas_.size(); ++i) put_schema(out, i);
  });
  add_group(Op::channel, [&] {
    for (std::size_t i = 0; i < channels_.size(); ++i) put_channel(out, i);
  });
  add_group(Op::statistics, [&] { put_statistics(out); });
  add_group(Op::chunk_index, [&] { out.put(Bytes(chunk_indexes_.bytes)); });
  add_group(Op::attachment_index, [&] { out.put(Bytes(attachment_indexes_.bytes)); });
  add_group(Op::metadata_index, [&] { out.put(Bytes(metadata_indexes_.bytes)); });
  const std::uint64_t offsets_start = start + (out.size() - before);
  for (const Group& group : groups) {
    const std::size_t content = out.open_record(Op::summary_offset);
    out.put(group.op);
    out.put(start + group.start);
    out.put(static_cast<std::uint64_t>(group.length));
    out.close_record(content);
  }
  const std::size_t content = out.open_record(Op::footer);
  out.put(start);
  out.put(offsets_start);
  out.put_at(content - sizeof(std::uint64_t),
             std::uint64_t{2 * sizeof(std::uint64_t) + sizeof(std::uint32_t)});
  out.put(crc32(0, Bytes(out.bytes).subspan(before)));
}

void Writer::append(Bytes data) {
  file_.append(data);
  data_crc_ = crc32(data_crc_, data);
  position_ += data.size();
}

}  // namespace sandhopper::mcap
