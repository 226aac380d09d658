#include <algorithm>
#include <array>
#include <memory>
#include <system_error>
#include <utility>

#include "firmware/log/append_file.hpp"
#include "firmware/log/cycle_count.hpp"
#include "firmware/log/log_recovery.hpp"
#include "firmware/log/mapped_file.hpp"
#include "firmware/log/mcap_damage.hpp"
#include "firmware/log/mcap_parts.hpp"
#include "firmware/log/mcap_reader.hpp"
#include "firmware/log/mcap_salvage.hpp"
#include "firmware/log/mcap_unpack.hpp"
#include "firmware/log/mcap_writer.hpp"
#include "firmware/log/topics.hpp"

namespace sandhopper {
namespace {

using mcap::Bytes;
using mcap::Cursor;
using mcap::Op;

struct SavedChannel {
  std::string topic;
  mcap::Schema schema;
  std::uint16_t number_in_copy = 0;
  bool has_schema_of_gap = false;
  bool has_schema_of_cycle = false;  // its schema is that of SensorFrame, StepOutput or Event, as its topic
                                     // requires

  // State of the last message read.
  bool met = false;
  std::uint32_t sequence = 0;
  std::int64_t log_ns = 0;
  std::int64_t own_ns = 0;      // its own time; each record of this firmware begins with it
  std::size_t with_own_ns = 0;  // number of messages with this time
  std::uint64_t damage_before = 0;
  std::uint64_t gaps_before = 0;

  void forget() { met = false, own_ns = 0, with_own_ns = damage_before = gaps_before = 0; }
};

// Goes through the file, a second time if a copy is written: the first pass only inspects.
class Recovery {
 public:
  // `file` must outlive this object.
  Recovery(Bytes file, std::string name)
      : unpacked_(mcap::unpack(file)), file_(unpacked_ ? Bytes(*unpacked_) : file), name_(std::move(name)) {}

  bool has_channels() const { return !channels_.empty(); }

  LogRecovery look() {
    learn_channels();
    walk(nullptr);
    return result_;
  }

  LogRecovery copy(const std::filesystem::path& to, std::span<const FreezeCycle> newest) {
    mcap::Writer writer(to);
    for (auto& [number, channel] : channels_) {
      channel.number_in_copy = writer.add_channel(channel.topic, channel.schema.name, channel.schema.text);
      channel.forget();
    }
    gap_channel_ = channel_for_gaps(writer);
    walk(&writer);
    restore_end(writer, newest);
    writer.add_metadata("recovery", {{"file", name_},
                                     {"saved_records", std::to_string(result_.saved())},
                                     {"lost_records", std::to_string(result_.lost())},
                                     {"restored_cycles", std::to_string(restored())},
                                     {"unreadable_bytes", std::to_string(result_.unreadable_bytes)}});
    writer.close();
    return result_;
  }

 private:
  // Reads schemas and channels from everywhere: the summary at the end repeats those that damage in front may
  // hide.
  void learn_channels() {
    mcap::Salvage salvage(file_);
    for (mcap::Salvage::Piece piece; salvage.next(piece);) {
      if (piece.op == Op::chunk)
        for_each_record(piece, [&](Op op, Bytes content) { learn(op, content); });
      else
        learn(piece.op, piece.content);
    }
    for (auto& [number, channel] : channels_) {
      if (const auto schema = schemas_.find(schema_of_[number]); schema != schemas_.end())
        channel.schema = schema->second;
      if (encoding_of_[number] != "cdr" || channel.schema.encoding != "ros2msg")
        throw mcap::Error(name_ + ": topic " + channel.topic + " is not of this firmware (" +
                          encoding_of_[number] + " with " + channel.schema.encoding +
                          "); try: mcap recover FILE -o OTHER");
      channel.has_schema_of_gap = channel.schema.name == schema::message_name<LogGap>() &&
                                  channel.schema.text == schema::text_of<LogGap>();
      channel.has_schema_of_cycle = is_of<SensorFrame>(channel, topic::kFrame) ||
                                    is_of<StepOutput>(channel, topic::kOutput) ||
                                    is_of<Event>(channel, topic::kEvent);
    }
  }

  template <HasFields Record>
  static bool is_of(const SavedChannel& channel, std::string_view topic) {
    return channel.topic == topic && channel.schema.name == schema::message_name<Record>() &&
           channel.schema.text == schema::text_of<Record>();
  }

  void learn(Op op, Bytes content) {
    Cursor in(content);
    const auto number = in.take<std::uint16_t>();
    if (op == Op::schema) {
      mcap::Schema schema;
      schema.name = in.take_text();
      schema.encoding = in.take_text();
      schema.text = in.take_text();
      if (in.ok) schemas_.emplace(number, std::move(schema));
    } else if (op == Op::channel) {
      const auto schema = in.take<std::uint16_t>();
      SavedChannel channel;
      channel.topic = in.take_text();
      const std::string encoding(in.take_text());
      if (!in.ok || !channels_.emplace(number, channel).second) return;
      schema_of_[number] = schema;
      encoding_of_[number] = encoding;
    }
  }

  template <class Visit>
  static std::uint64_t for_each_record(const mcap::Salvage::Piece& chunk, Visit&& visit) {
    Bytes rest = chunk.content;
    while (rest.size() >= mcap::kRecordHead) {
      Cursor in(rest);
      const auto op = in.take<Op>();
      const Bytes content = in.take(in.take<std::uint64_t>());
      if (!in.ok) break;
      visit(op, content);
      rest = in.rest();
    }
    return rest.size();
  }

  void walk(mcap::Writer* writer) {
    result_ = {};
    result_.file_bytes = file_.size();
    cycle_count_ = {};
    in_summary_ = false;
    gaps_seen_ = damage_seen_ = 0;
    bool data_is_right = false;
    mcap::Salvage salvage(file_);
    for (mcap::Salvage::Piece piece; salvage.next(piece);) {
      damage_seen_ = salvage.damage().size();
      if (piece.op == Op::chunk) {
        const auto rest = for_each_record(piece, [&](Op op, Bytes content) {
          if (op == Op::message) save(content, writer);
        });
        if (piece.is_cut) result_.unreadable_bytes += rest;
      } else if (piece.op == Op::message) {
        save(piece.content, writer);
      } else if (piece.op == Op::data_end) {
        const auto crc = Cursor(piece.content).take<std::uint32_t>();
        // For an unpacked file this CRC, which covers packed bytes, is not checked: each chunk has its own.
        data_is_right = crc == 0 || unpacked_ ||
                        crc == mcap::crc32(0, file_.first(static_cast<std::size_t>(piece.offset)));
        in_summary_ = true;
      } else if (writer != nullptr && !in_summary_) {
        keep(piece, *writer);
      }
    }
    result_.cut_at = salvage.cut_at();
    if (result_.cycles && !result_.cut_at) result_.cycles->missing_at_end = 0;
    for (const auto& damage : salvage.damage()) {
      result_.damage.push_back({damage.from, damage.to, damage.what});
      result_.unreadable_bytes += damage.to - damage.from;
    }
    if (salvage.cut_at()) result_.unreadable_bytes += file_.size() - *salvage.cut_at();
    result_.whole = !result_.cut_at && result_.damage.empty() && data_is_right && result_.lost() == 0;
  }

  // A message's sequence number shows how many messages of its topic are missing before it. If a gap record
  // of the log lies between, that record already counts them.
  void save(Bytes content, mcap::Writer* writer) {
    Cursor in(content);
    const auto number = in.take<std::uint16_t>();
    const auto sequence = in.take<std::uint32_t>();
    mcap::Stamp stamp;
    stamp.log_ns = in.take<std::int64_t>();
    stamp.publish_ns = in.take<std::int64_t>();
    if (!in.ok) return;
    const auto found = channels_.find(number);
    if (found == channels_.end()) {
      ++result_.topics["(channel " + std::to_string(number) + ", declared nowhere)"].lost;
      return;
    }
    SavedChannel& channel = found->second;
    note_gap(channel, in.rest());
    // Other recorders may start counting at any number.
    const bool begins_here = !channel.met && damage_seen_ == 0 && gaps_seen_ == 0;
    const std::uint32_t expected = channel.met ? channel.sequence + 1 : begins_here ? sequence : 0;
    const std::uint32_t missing = sequence - expected;
    const bool is_damage = damage_seen_ > channel.damage_before || gaps_seen_ == channel.gaps_before;
    auto& topic = result_.topics[channel.topic];
    if (missing > 0 && missing < 0x8000'0000U && is_damage) {
      topic.lost += missing;
      if (writer != nullptr) write_gap(*writer, channel, stamp, missing, in.rest());
    }
    channel.met = true;
    channel.sequence = sequence;
    channel.log_ns = stamp.log_ns;
    note_cycle(channel, in.rest());
    channel.damage_before = damage_seen_;
    channel.gaps_before = gaps_seen_;
    result_.first_ns = result_.saved() == 0 ? stamp.log_ns : std::min(result_.first_ns, stamp.log_ns);
    result_.last_ns = std::max(result_.last_ns, stamp.log_ns);
    ++topic.saved;
    if (writer != nullptr) writer->write(channel.number_in_copy, stamp, in.rest());
  }

  void note_gap(const SavedChannel& channel, Bytes data) {
    LogGap gap;
    if (channel.topic != topic::kGap || !channel.has_schema_of_gap || !cdr::decode(data, gap)) return;
    ++result_.gaps;
    result_.lost_in_gaps += gap.lost;
    if (gap.cause == LossCause::write_failed) ++gaps_seen_;
  }

  void note_cycle(SavedChannel& channel, Bytes data) {
    if (!channel.has_schema_of_cycle) return;
    Cursor in(data);
    in.take<std::uint32_t>();  // CDR's head
    const auto own_ns = in.take<std::int64_t>();
    if (!in.ok) return;
    channel.with_own_ns = own_ns == channel.own_ns ? channel.with_own_ns + 1 : 1;
    channel.own_ns = own_ns;
    SensorFrame frame;
    if (channel.topic == topic::kFrame && cdr::decode(data, frame)) cycle_count_.see(frame, result_);
  }

  std::uint64_t restored() const { return result_.cycles ? result_.cycles->restored : 0; }

  // Writes the cycles that the cut log lacks, in the order in which the logger would have written them.
  void restore_end(mcap::Writer& writer, std::span<const FreezeCycle> newest) {
    if (newest.empty() || !result_.cut_at || !result_.cycles) return;
    const auto channel_of = [&](std::string_view topic) -> SavedChannel* {
      for (auto& [number, channel] : channels_)
        if (channel.topic == topic && channel.has_schema_of_cycle) return &channel;
      return nullptr;
    };
    const std::array channels{channel_of(topic::kFrame), channel_of(topic::kOutput),
                              channel_of(topic::kEvent)};
    if (std::ranges::count(channels, nullptr) > 0) return;
    auto& cycles = *result_.cycles;
    const std::int64_t offset_ns = channels[0]->log_ns - channels[0]->own_ns;
    for (const FreezeCycle& cycle : newest) {
      if (cycle.frame.time_ns < cycles.last_ns) continue;
      const mcap::Stamp stamp{cycle.frame.time_ns + offset_ns, cycle.frame.time_ns + offset_ns};
      const auto put = [&](std::size_t i, const auto& record) {
        writer.write(channels[i]->number_in_copy, stamp, record);
        ++result_.topics[channels[i]->topic].saved;
        result_.last_ns = std::max(result_.last_ns, stamp.log_ns);
      };
      if (cycle.frame.time_ns > channels[0]->own_ns) {
        if (cycles.restored++ == 0)
          cycles.missing_at_end = cycle_count_.missing_until(cycle.frame, cycles.last);
        put(0, cycle.frame);
      }
      if (cycle.frame.time_ns > channels[1]->own_ns) put(1, cycle.output);
      const auto events = cycle.seen_events();
      const bool begun = channels[2]->own_ns == cycle.frame.time_ns;
      for (std::size_t i = begun ? channels[2]->with_own_ns : 0; i < events.size(); ++i) put(2, events[i]);
    }
    // The last cycle in the ring is also in the log: nothing is missing.
    if (newest.back().frame.cycle == cycles.last) cycles.missing_at_end = 0;
  }

  // Each record of this firmware begins with its own time.
  void write_gap(mcap::Writer& writer, const SavedChannel& channel, mcap::Stamp stamp, std::uint32_t missing,
                 Bytes data) const {
    Cursor in(data);
    in.take<std::uint32_t>();  // CDR's head
    const auto own_ns = in.take<std::int64_t>();
    const std::int64_t time_ns = in.ok ? own_ns : stamp.log_ns;
    // In a damaged log the difference of two times may overflow.
    std::int64_t since_last_ns = 0, first_ns = time_ns;
    if (channel.met && (__builtin_sub_overflow(stamp.log_ns, channel.log_ns, &since_last_ns) ||
                        __builtin_sub_overflow(time_ns, since_last_ns, &first_ns)))
      first_ns = time_ns;
    writer.write(gap_channel_, stamp,
                 LogGap{.time_ns = time_ns,
                        .first_lost_ns = first_ns,
                        .last_lost_ns = time_ns,
                        .lost = missing,
                        .cause = LossCause::damaged});
  }

  // If the log's version has another gap record, a second topic is added for gaps.
  std::uint16_t channel_for_gaps(mcap::Writer& writer) const {
    bool taken = false;
    for (const auto& [number, channel] : channels_) {
      if (channel.topic != topic::kGap) continue;
      if (channel.has_schema_of_gap) return channel.number_in_copy;
      taken = true;
    }
    return writer.add_channel<LogGap>(taken ? std::string(topic::kGap) + "_recovered"
                                            : std::string(topic::kGap));
  }

  void keep(const mcap::Salvage::Piece& piece, mcap::Writer& writer) {
    Cursor in(piece.content);
    if (piece.op == Op::attachment) {
      const auto log_ns = in.take<std::int64_t>();
      in.take<std::int64_t>();
      const auto name = in.take_text();
      const auto media_type = in.take_text();
      const Bytes data = in.take(in.take<std::uint64_t>());
      const std::size_t covered = piece.content.size() - in.rest().size();
      const auto crc = in.take<std::uint32_t>();
      const bool sound = in.ok && (crc == 0 || mcap::crc32(0, piece.content.first(covered)) == crc);
      if (sound)
        writer.attach(name, media_type, log_ns, data);
      else
        result_.damage.push_back(
            {piece.offset, piece.offset + piece.content.size(), "an attachment whose CRC is wrong"});
    } else if (piece.op == Op::metadata) {
      const std::string name(in.take_text());
      std::map<std::string, std::string> entries;
      for (Cursor list(in.take(in.take<std::uint32_t>())); list.ok && !list.rest().empty();) {
        std::string key(list.take_text());
        entries[std::move(key)] = list.take_text();
      }
      writer.add_metadata(name, entries);
    }
  }

  std::optional<std::vector<std::byte>> unpacked_;  // of a file with compressed chunks
  Bytes file_;
  std::string name_;
  LogRecovery result_;
  std::map<std::uint16_t, mcap::Schema> schemas_;
  std::map<std::uint16_t, SavedChannel> channels_;
  std::map<std::uint16_t, std::uint16_t> schema_of_;
  std::map<std::uint16_t, std::string> encoding_of_;
  std::uint16_t gap_channel_ = 0;
  CycleCount cycle_count_{};
  bool in_summary_ = false;
  std::uint64_t damage_seen_ = 0;
  std::uint64_t gaps_seen_ = 0;
};

}  // namespace

LogRecovery look_at_mcap(const std::filesystem::path& from) {
  const MappedFile file(from);
  const auto log = mcap::one_log_of(file.bytes(), from);
  LogRecovery found = Recovery(log.bytes, from.filename().string()).look();
  found.add_rest_of_file(log);
  return found;
}

LogRecovery recover_mcap(const std::filesystem::path& from, const std::filesystem::path& to,
                         std::span<const FreezeCycle> newest) {
  const MappedFile file(from);
  const auto log = mcap::one_log_of(file.bytes(), from);
  Recovery recovery(log.bytes, from.filename().string());
  LogRecovery found = recovery.look();
  if (found.whole) {
    found.add_rest_of_file(log);
    if (found.whole) return found;
    AppendFile copy(to);
    copy.append(log.bytes);
    copy.close();
    return found;
  }
  if (found.topics.empty() && !recovery.has_channels()) {
    if (const auto other = mcap::other_format_of(file.bytes()); !other.empty())
      throw mcap::Error(from.string() + ": nothing can be read of it: " + other);
    throw mcap::Error(from.string() +
                      ": nothing can be read of it; it is no MCAP log, or was cut before its first record");
  }
  try {
    found = recovery.copy(to, newest);
    found.add_rest_of_file(log);
    return found;
  } catch (const std::system_error& error) {
    if (error.code() != std::errc::file_exists) {
      std::error_code ignored;
      std::filesystem::remove(to, ignored);
    }
    throw;
  }
}

}  // namespace sandhopper
