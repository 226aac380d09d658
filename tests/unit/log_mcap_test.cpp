#include <gtest/gtest.h>
#include <unistd.h>

#include <algorithm>
#include <fstream>
#include <random>
#include <sstream>
#include <system_error>

#include "firmware/log/mcap_reader.hpp"
#include "firmware/log/mcap_writer.hpp"
#include "firmware/records.hpp"
#include "firmware/sensor_frame.hpp"

namespace sandhopper {
namespace {

class McapLog : public ::testing::Test {
 protected:
  void SetUp() override {
    folder_ = std::filesystem::temp_directory_path() /
              ("sandhopper_mcap_" + std::to_string(::getpid()) + "_" +
               ::testing::UnitTest::GetInstance()->current_test_info()->name());
    std::filesystem::create_directories(folder_);
  }
  void TearDown() override { std::filesystem::remove_all(folder_); }

  std::filesystem::path path(const std::string& name) const { return folder_ / name; }

  static std::string content(const std::filesystem::path& file) {
    std::ifstream in(file, std::ios::binary);
    return {std::istreambuf_iterator<char>(in), {}};
  }
  std::filesystem::path store(const std::string& name, const std::string& bytes) const {
    std::ofstream(path(name), std::ios::binary | std::ios::trunc) << bytes;
    return path(name);
  }

  // A frame every millisecond, and an event with every seventh.
  std::filesystem::path write_log(const std::string& name, int frames, std::size_t chunk_bytes) const {
    mcap::WriterOptions options;
    options.chunk_bytes = chunk_bytes;
    mcap::Writer writer(path(name), options);
    const auto frame_channel = writer.add_channel<SensorFrame>("/frame");
    const auto event_channel = writer.add_channel<Event>("/event");
    writer.attach("config.toml", "application/toml", 1'000, mcap::bytes_of("mass_kg = 1.0\n"));
    writer.add_metadata("build", {{"version", "1"}, {"compiler", "test"}});
    for (int i = 0; i < frames; ++i) {
      SensorFrame frame;
      frame.time_ns = std::int64_t{1'000'000} * i;
      frame.cycle = static_cast<std::uint64_t>(i);
      frame.motor[0].position_rad = 0.001 * i;
      const mcap::Stamp stamp{kOffset_ns + frame.time_ns, kOffset_ns + frame.time_ns};
      writer.write(frame_channel, stamp, frame);
      if (i % 7 == 0) writer.write(event_channel, stamp, Event{.time_ns = frame.time_ns});
    }
    writer.close();
    return path(name);
  }

  struct Read {
    std::vector<std::uint64_t> ends;  // end of each message's record in the file
    std::vector<std::uint64_t> cycles;
    std::uint64_t events = 0;
    std::optional<std::uint64_t> truncated_at;
  };
  static Read read(const std::filesystem::path& file, mcap::ReaderOptions options = {}) {
    mcap::Reader reader(file, options);
    return read(reader);
  }
  static Read read(mcap::Reader& reader) {
    Read result;
    for (mcap::Message message; reader.next(message);) {
      result.ends.push_back(message.offset + mcap::kRecordHead + mcap::kMessageHead + message.data.size());
      if (SensorFrame frame; message.channel->topic == "/frame" && cdr::decode(message.data, frame)) {
        EXPECT_EQ(message.stamp.log_ns, kOffset_ns + frame.time_ns);
        EXPECT_EQ(frame.motor[0].position_rad, 0.001 * static_cast<double>(frame.cycle));
        result.cycles.push_back(frame.cycle);
      } else {
        ++result.events;
      }
    }
    result.truncated_at = reader.truncated_at();
    return result;
  }

  // Reads every message that ends before the cut, and no other.
  void expect_readable_when_cut(const std::string& whole, const Read& all, std::size_t cut) const {
    mcap::Reader reader(mcap::bytes_of(std::string_view(whole).substr(0, cut)), "cut");
    const Read part = read(reader);
    const auto expected =
        std::count_if(all.ends.begin(), all.ends.end(), [&](auto end) { return end <= cut; });
    ASSERT_EQ(part.ends.size(), static_cast<std::size_t>(expected)) << "cut at " << cut;
    ASSERT_TRUE(part.truncated_at.has_value()) << "cut at " << cut;
    ASSERT_LE(*part.truncated_at, cut);
    if (!part.ends.empty()) {
      ASSERT_GE(*part.truncated_at, part.ends.back());
    }
  }

  static constexpr std::int64_t kOffset_ns = 1'700'000'000'000'000'000;

 private:
  std::filesystem::path folder_;
};

TEST_F(McapLog, WhatIsWrittenIsRead) {
  const auto file = write_log("a.mcap", 1'000, 16'384);
  const Read all = read(file);
  EXPECT_EQ(all.cycles.size(), 1'000U);
  EXPECT_EQ(all.events, 143U);
  EXPECT_FALSE(all.truncated_at.has_value());
  for (std::size_t i = 0; i < all.cycles.size(); ++i) ASSERT_EQ(all.cycles[i], i);
}

TEST_F(McapLog, ConfigurationAndBuildAreThereBeforeTheFirstMessage) {
  const mcap::Reader reader(write_log("a.mcap", 3, 16'384));
  EXPECT_EQ(reader.profile(), "ros2");
  ASSERT_EQ(reader.attachments().size(), 1U);
  EXPECT_EQ(reader.attachments()[0].name, "config.toml");
  EXPECT_EQ(mcap::text_of(reader.attachments()[0].data), "mass_kg = 1.0\n");
  ASSERT_EQ(reader.metadata().size(), 1U);
  EXPECT_EQ(reader.metadata()[0].entries.at("compiler"), "test");
  ASSERT_NE(reader.find("/event"), nullptr);
  EXPECT_EQ(reader.find("/event")->schema.name, "sandhopper_msgs/msg/Event");
  EXPECT_EQ(reader.find("/event")->schema.text, schema::text_of<Event>());
}

TEST_F(McapLog, SameCallsGiveSameBytes) {
  EXPECT_EQ(content(write_log("a.mcap", 500, 16'384)), content(write_log("b.mcap", 500, 16'384)));
}

TEST_F(McapLog, CutAtEveryByteEveryWholeMessageIsRead) {
  const auto file = write_log("a.mcap", 15, 2'048);
  const std::string whole = content(file);
  const Read all = read(file);
  for (std::size_t cut = 0; cut < whole.size(); ++cut) expect_readable_when_cut(whole, all, cut);
}

TEST_F(McapLog, CutAt200RandomBytesEveryWholeMessageIsRead) {
  const auto file = write_log("a.mcap", 2'000, 32'768);
  const std::string whole = content(file);
  const Read all = read(file);
  std::mt19937 random(7);
  std::uniform_int_distribution<std::size_t> place(0, whole.size() - 1);
  for (int i = 0; i < 200; ++i) expect_readable_when_cut(whole, all, place(random));
}

TEST_F(McapLog, WritesMadeBeforeACrashAreReadWithoutTheSummary) {
  mcap::Writer writer(path("a.mcap"));
  const auto channel = writer.add_channel<Event>("/event");
  writer.write(channel, {}, Event{});
  writer.flush();
  writer.write(channel, {}, Event{});  // stays in the open chunk
  const Read part = read(path("a.mcap"));
  EXPECT_EQ(part.ends.size(), 1U);
  EXPECT_TRUE(part.truncated_at.has_value());
}

TEST_F(McapLog, ATailOfZerosIsACut) {
  const auto file = write_log("a.mcap", 100, 8'192);
  const std::string whole = content(file);
  const Read all = read(file);
  const std::size_t cut = whole.size() / 2;
  std::string part = whole.substr(0, cut);
  part.resize(whole.size(), '\0');
  const Read seen = read(store("zeros.mcap", part));
  ASSERT_TRUE(seen.truncated_at.has_value());
  EXPECT_LE(*seen.truncated_at, cut);
  for (const auto cycle : seen.cycles) EXPECT_LT(cycle, all.cycles.size());
}

TEST_F(McapLog, DamageInAChunkIsNamedWithItsPlace) {
  std::string bytes = content(write_log("a.mcap", 200, 8'192));
  const Read all = read(path("a.mcap"));
  const std::size_t damaged = all.ends[100] - 5;
  bytes[damaged] = static_cast<char>(bytes[damaged] ^ 1);
  const auto file = store("damaged.mcap", bytes);
  try {
    read(file);
    FAIL() << "damage was not noticed";
  } catch (const mcap::Error& error) {
    EXPECT_NE(std::string(error.what()).find("CRC"), std::string::npos) << error.what();
    EXPECT_NE(std::string(error.what()).find("byte "), std::string::npos) << error.what();
  }
  mcap::ReaderOptions skip;
  skip.skip_damaged = true;
  const Read rest = read(file, skip);
  EXPECT_LT(rest.ends.size(), all.ends.size());
  EXPECT_EQ(rest.cycles.back(), all.cycles.back());
}

// Any damage, with CRCs unchecked, must give an Error or fewer messages. It must never read beyond the file
// or crash.
TEST_F(McapLog, NoDamageLeadsOutsideTheFile) {
  const std::string whole = content(write_log("a.mcap", 15, 2'048));
  std::mt19937 random(3);
  const auto below = [&random](std::size_t limit) { return static_cast<std::size_t>(random()) % limit; };
  mcap::ReaderOptions unchecked;
  unchecked.check_crc = false;
  int refused = 0;
  for (int i = 0; i < 5'000; ++i) {
    std::string bytes = whole.substr(0, i % 3 == 0 ? below(whole.size()) : whole.size());
    for (std::size_t flips = 1 + below(8); flips > 0 && bytes.size() > 8; --flips)
      bytes[8 + below(bytes.size() - 8)] = static_cast<char>(random());
    try {
      mcap::Reader reader(mcap::bytes_of(bytes), "damaged", unchecked);
      std::size_t sum = 0;
      for (mcap::Message message; reader.next(message);) sum += message.data.size();
      ASSERT_LE(sum, bytes.size());
    } catch (const mcap::Error&) {
      ++refused;
    }
  }
  EXPECT_GT(refused, 100);
}

TEST_F(McapLog, UnknownRecordsArePassedOver) {
  std::string bytes = content(write_log("a.mcap", 5, 65'536));
  const std::string unknown = std::string("\x90\x03\0\0\0\0\0\0\0abc", 12);
  const std::size_t after_header =
      mcap::kMagic.size() + mcap::kRecordHead + static_cast<unsigned char>(bytes[mcap::kMagic.size() + 1]);
  bytes.insert(after_header, unknown);
  EXPECT_EQ(read(store("unknown.mcap", bytes)).cycles.size(), 5U);
}

TEST_F(McapLog, OtherFilesAreRefused) {
  EXPECT_THROW(mcap::Reader{store("text.csv", "t_s,phase\n0,1\n")}, mcap::Error);
  EXPECT_THROW(mcap::Reader{path("missing.mcap")}, std::system_error);
}

TEST_F(McapLog, ALogIsNeverOverwritten) {
  write_log("a.mcap", 1, 1'024);
  EXPECT_THROW(write_log("a.mcap", 1, 1'024), std::system_error);
}

TEST_F(McapLog, ASchemaOfAnotherVersionIsNamed) {
  mcap::Channel channel;
  channel.topic = "/event";
  channel.message_encoding = "cdr";
  channel.schema = {"sandhopper_msgs/msg/Event", "ros2msg", schema::text_of<Event>()};
  EXPECT_NO_THROW(mcap::require_schema<Event>(channel));
  channel.schema.text.replace(channel.schema.text.find("uint32 stride"), 13, "uint16 stride");
  try {
    mcap::require_schema<Event>(channel);
    FAIL() << "accepted";
  } catch (const mcap::Error& error) {
    EXPECT_NE(std::string(error.what()).find("uint16 stride"), std::string::npos) << error.what();
  }
}

}  // namespace
}  // namespace sandhopper
