#include "firmware/log/mcap_reader.hpp"

#include <algorithm>
#include <array>
#include <sstream>
#include <utility>

#include "firmware/log/mcap_damage.hpp"
#include "firmware/log/mcap_unpack.hpp"

namespace sandhopper::mcap {
namespace {

// Other recording formats that are mistaken for MCAP, by their first bytes.
struct OtherFormat {
  std::string_view begins;
  const char* what;
};
using namespace std::string_view_literals;
constexpr std::array kOtherFormats{
    OtherFormat{"\x28\xb5\x2f\xfd"sv, "it is compressed with zstd as a whole: zstd -d FILE -o OTHER.mcap"},
    OtherFormat{"\x04\x22\x4d\x18"sv, "it is compressed with lz4 as a whole: lz4 -d FILE OTHER.mcap"},
    OtherFormat{"\x1f\x8b"sv, "it is compressed with gzip as a whole: gunzip -c FILE > OTHER.mcap"},
    OtherFormat{"SQLite format 3"sv, "it is a rosbag2 of the sqlite3 kind: mcap convert FILE OTHER.mcap"},
    OtherFormat{"#ROSBAG V2"sv, "it is a bag of ROS 1: mcap convert FILE OTHER.mcap"},
    OtherFormat{"LOGG"sv,
                "it is a Vector BLF log of CAN frames: hop replay --can FILE says how to convert it"},
    OtherFormat{"version https://git-lfs.github.com/spec/"sv,
                "it is a pointer of git LFS to a log that was not fetched: git lfs pull"},
    OtherFormat{"/annex/objects/"sv,
                "it is a pointer of git-annex to a log that was not fetched: git annex get FILE"}};

// The magic holds \r\n to show a transfer in text mode. Between them, each \n became \r\n or the reverse.
constexpr auto kLineFeedsDoubled = "\x89MCAP0\r\r\n"sv;
constexpr auto kCarriageReturnsGone = "\x89MCAP0\n"sv;

std::string first_bytes_are(Bytes file) {
  if (auto other = other_format_of(file); !other.empty()) return other;
  return file.empty() ? "it is empty" : "its first bytes are not MCAP's";
}

}  // namespace

std::string other_format_of(Bytes file) {
  const auto text = text_of(file);
  for (const auto& other : kOtherFormats)
    if (text.starts_with(other.begins)) return other.what;
  if (text.starts_with(kLineFeedsDoubled))
    return "a transfer in text mode put a carriage return before each line feed: transfer it again in binary "
           "mode, or perl -pe 's/\\r\\n/\\n/' FILE > OTHER.mcap";
  if (text.starts_with(kCarriageReturnsGone))
    return "a transfer in text mode took carriage returns out of it: transfer it again in binary mode; hop "
           "recover FILE saves the rest of this one";
  return "";
}

Reader::Reader(const std::filesystem::path& file, ReaderOptions options)
    : name_(file.string()), options_(options), map_(file), file_(map_.bytes()) {
  open();
}

Reader::Reader(Bytes data, std::string name, ReaderOptions options)
    : name_(std::move(name)), options_(options), file_(data) {
  open();
}

void Reader::open() {
  const std::size_t seen = std::min(file_.size(), kMagic.size());
  if (!std::equal(kMagic.begin(), kMagic.begin() + static_cast<std::ptrdiff_t>(seen), file_.begin()))
    throw Error(name_ + ": not an MCAP log (" + first_bytes_are(file_) + ")");
  file_bytes_ = file_.size();
  if (seen < kMagic.size()) {
    cut_at(0);
    return;
  }
  unpacked_ = unpack(file_);
  if (unpacked_) file_ = *unpacked_;
  closed_ =
      file_.size() >= 2 * kMagic.size() &&
      std::equal(kMagic.begin(), kMagic.end(), file_.end() - static_cast<std::ptrdiff_t>(kMagic.size()));
  position_ = kMagic.size();
  for (Record record; take_record(record) == Step::record;) {
    if (record.op == Op::message) {
      pending_ = record;
      return;
    }
    keep(record);
  }
}

const Channel* Reader::find(std::string_view topic) const {
  for (const auto& [number, channel] : channels_)
    if (channel.topic == topic) return &channel;
  return nullptr;
}

bool Reader::next(Message& message) {
  if (pending_) {
    const Record record = *pending_;
    pending_.reset();
    return take_message(record, message);
  }
  for (Record record; take_record(record) == Step::record;) {
    if (record.op == Op::message) return take_message(record, message);
    keep(record);
  }
  return false;
}

Reader::Step Reader::take_record(Record& record) {
  while (!ended_) {
    if (inner_end_ == 0) {
      if (take_outer(record) == Step::end) return Step::end;
      if (record.op != Op::chunk) return Step::record;
      continue;
    }
    const std::uint64_t rest = inner_end_ - inner_;
    const bool whole = rest >= kRecordHead && length_at(file_, inner_) <= rest - kRecordHead;
    if (whole && file_[inner_] != std::byte{0}) {
      const std::uint64_t length = length_at(file_, inner_);
      record = {static_cast<Op>(file_[inner_]), file_.subspan(inner_ + kRecordHead, length), inner_};
      inner_ += kRecordHead + length;
      return Step::record;
    }
    if (chunk_is_cut_) return cut_at(inner_);
    if (rest > 0) fail(inner_, "a record reaches beyond its chunk; the file is damaged");
    inner_end_ = 0;
  }
  return Step::end;
}

// Next record outside chunks. It enters a chunk instead of returning it.
Reader::Step Reader::take_outer(Record& record) {
  const std::uint64_t rest = file_.size() - position_;
  if (rest < kRecordHead || file_[position_] == std::byte{0}) return cut_at(position_);
  const std::uint64_t start = position_;
  const std::uint64_t length = length_at(file_, start);
  record.op = static_cast<Op>(file_[start]);
  record.offset = start;
  const bool whole = length <= rest - kRecordHead;
  if (!whole && closed_) fail(start, "a record reaches beyond the end of the file; the file is damaged");
  if (record.op == Op::chunk) {
    if (!whole && rest < kRecordHead + kChunkHead) return cut_at(start);
    position_ = whole ? start + kRecordHead + length : file_.size();
    enter_chunk(file_.subspan(start + kRecordHead, position_ - start - kRecordHead), start, length);
    return Step::record;
  }
  if (!whole) return cut_at(start);
  record.content = file_.subspan(start + kRecordHead, length);
  position_ = start + kRecordHead + length;
  if (record.op == Op::data_end) in_summary_ = true;
  if (record.op == Op::footer) {
    if (!closed_ || file_.size() - position_ != kMagic.size()) return cut_at(position_);
    ended_ = true;
    return Step::end;
  }
  return Step::record;
}

void Reader::enter_chunk(Bytes content, std::uint64_t offset, std::uint64_t length) {
  Cursor in(content);
  in.take(3 * sizeof(std::uint64_t));  // first and last time, unpacked size
  const auto crc = in.take<std::uint32_t>();
  const std::string_view compression = in.take_text();
  const auto records = in.take<std::uint64_t>();
  if (!in.ok && content.size() < length) {
    cut_at(offset);  // the cut is within a head that the compression's name made longer
    return;
  }
  if (!in.ok) fail(offset, "a chunk without a head; the file is damaged");
  if (!compression.empty())
    fail(offset,
         "a chunk is compressed with " + std::string(compression) + ", which is neither zstd nor lz4");
  chunk_is_cut_ = content.size() < length;
  if (!chunk_is_cut_ && records > in.rest().size()) fail(offset, "a chunk's records reach beyond it");
  const std::uint64_t present = std::min<std::uint64_t>(records, in.rest().size());
  const auto start = static_cast<std::uint64_t>(in.rest().data() - file_.data());
  if (!chunk_is_cut_ && !chunk_is_sound(in.rest().first(present), crc, offset, start + records)) return;
  inner_ = start;
  inner_end_ = start + present;
  if (present == 0 && !chunk_is_cut_) inner_end_ = 0;
}

// A wrong CRC at the very end of a log that was never closed also counts as a cut: a file system may have
// kept the length of the last write without its content.
bool Reader::chunk_is_sound(Bytes records, std::uint32_t crc, std::uint64_t offset, std::uint64_t end) {
  if (!options_.check_crc || crc == 0 || crc32(0, records) == crc) return true;
  const Bytes after = file_.subspan(end);
  if (!closed_ && std::all_of(after.begin(), after.end(), [](std::byte b) { return b == std::byte{0}; })) {
    cut_at(offset);
    return false;
  }
  if (!options_.skip_damaged) fail(offset, "a chunk's CRC is wrong; the file is damaged");
  damaged_chunks_.push_back(offset);
  return false;
}

Reader::Step Reader::cut_at(std::uint64_t offset) {
  truncated_at_ = offset;
  ended_ = true;
  return Step::end;
}

void Reader::keep(const Record& record) {
  if (in_summary_) return;  // the summary repeats the data section
  Cursor in(record.content);
  switch (record.op) {
    case Op::header:
      profile_ = in.take_text();
      library_ = in.take_text();
      break;
    case Op::schema: {
      const auto number = in.take<std::uint16_t>();
      Schema schema;
      schema.name = in.take_text();
      schema.encoding = in.take_text();
      schema.text = in.take_text();
      if (in.ok) schemas_.emplace(number, std::move(schema));
      break;
    }
    case Op::channel:
      keep_channel(in);
      break;
    case Op::attachment:
      keep_attachment(record.content, record.offset);
      break;
    case Op::metadata: {
      Metadata metadata;
      metadata.name = in.take_text();
      Cursor entries(in.take(in.take<std::uint32_t>()));
      while (entries.ok && !entries.rest().empty()) {
        std::string key(entries.take_text());
        metadata.entries[std::move(key)] = entries.take_text();
      }
      in.ok = in.ok && entries.ok;
      metadata_.push_back(std::move(metadata));
      break;
    }
    default:
      break;
  }
  if (!in.ok) fail(record.offset, "a record is shorter than its fields; the file is damaged");
}

void Reader::keep_channel(Cursor& in) {
  Channel channel;
  channel.number = in.take<std::uint16_t>();
  const auto schema = in.take<std::uint16_t>();
  channel.topic = in.take_text();
  channel.message_encoding = in.take_text();
  if (!in.ok) return;
  if (const auto found = schemas_.find(schema); found != schemas_.end()) channel.schema = found->second;
  const auto number = channel.number;
  const auto [place, added] = channels_.emplace(number, std::move(channel));
  if (by_number_.size() <= number) by_number_.resize(number + std::size_t{1});
  by_number_[number] = &place->second;
}

void Reader::keep_attachment(Bytes content, std::uint64_t offset) {
  Cursor in(content);
  Attachment attachment;
  attachment.log_ns = in.take<std::int64_t>();
  in.take<std::int64_t>();  // creation time
  attachment.name = in.take_text();
  attachment.media_type = in.take_text();
  attachment.data = in.take(in.take<std::uint64_t>());
  const std::size_t covered = content.size() - in.rest().size();
  const auto crc = in.take<std::uint32_t>();
  if (!in.ok) fail(offset, "an attachment is shorter than its fields; the file is damaged");
  if (options_.check_crc && crc != 0 && crc32(0, content.first(covered)) != crc)
    fail(offset, "the CRC of attachment " + std::string(attachment.name) + " is wrong; the file is damaged");
  attachments_.push_back(attachment);
}

bool Reader::take_message(const Record& record, Message& message) {
  if (record.content.size() < kMessageHead)
    fail(record.offset, "a message without a head; the file is damaged");
  Cursor in(record.content);
  const auto number = in.take<std::uint16_t>();
  if (number >= by_number_.size() || by_number_[number] == nullptr)
    fail(record.offset, "a message of channel " + std::to_string(number) + ", which no record declares");
  message.channel = by_number_[number];
  message.sequence = in.take<std::uint32_t>();
  message.stamp.log_ns = in.take<std::int64_t>();
  message.stamp.publish_ns = in.take<std::int64_t>();
  message.data = in.rest();
  message.offset = record.offset;
  return true;
}

void Reader::fail(std::uint64_t offset, const std::string& what) const {
  throw Damaged(name_ + ": byte " + std::to_string(offset) + ": " + what);
}

void require_schema(const Channel& channel, const std::string& schema_name, const std::string& schema_text) {
  const std::string where = "topic " + channel.topic + ": ";
  if (channel.message_encoding != "cdr" || channel.schema.encoding != "ros2msg")
    throw Error(where + "messages are " + channel.message_encoding + " with schema " +
                channel.schema.encoding + ", not cdr with ros2msg");
  if (channel.schema.name != schema_name)
    throw Error(where + "holds " + channel.schema.name + ", not " + schema_name);
  if (channel.schema.text == schema_text) return;
  std::istringstream theirs(channel.schema.text);
  std::istringstream ours(schema_text);
  std::string their_line;
  std::string our_line;
  do {
    if (!std::getline(theirs, their_line)) their_line = "(nothing)";
    if (!std::getline(ours, our_line)) our_line = "(nothing)";
  } while (their_line == our_line && (theirs || ours));
  throw Error(where + "was logged by another version: it has \"" + their_line + "\" where this one has \"" +
              our_line + "\"; use the version named in the log's build metadata");
}

}  // namespace sandhopper::mcap
