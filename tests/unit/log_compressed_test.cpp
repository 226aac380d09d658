#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <lz4frame.h>
#include <unistd.h>
#include <zstd.h>

#include <filesystem>
#include <fstream>

#include "firmware/log/log_recovery.hpp"
#include "firmware/log/mcap_reader.hpp"
#include "firmware/log/mcap_writer.hpp"
#include "firmware/records.hpp"

namespace sandhopper::mcap {
namespace {

constexpr std::uint32_t kMessages = 400;

std::vector<std::byte> bytes_in(const std::filesystem::path& file) {
  std::ifstream in(file, std::ios::binary);
  const std::string text(std::istreambuf_iterator<char>(in), {});
  const auto bytes = bytes_of(text);
  return {bytes.begin(), bytes.end()};
}

std::vector<std::byte> packed(const std::string& with, Bytes records) {
  std::vector<std::byte> out;
  if (with == "zstd") {
    out.resize(ZSTD_compressBound(records.size()));
    out.resize(ZSTD_compress(out.data(), out.size(), records.data(), records.size(), 3));
  } else {
    out.resize(LZ4F_compressFrameBound(records.size(), nullptr));
    out.resize(LZ4F_compressFrame(out.data(), out.size(), records.data(), records.size(), nullptr));
  }
  return out;
}

// A log as other recorders write it: with compressed chunks.
class Compressed : public ::testing::TestWithParam<const char*> {
 protected:
  void SetUp() override {
    std::filesystem::create_directories(folder_);
    Writer writer(folder_ / "plain.mcap");
    const auto channel = writer.add_channel<Event>("/event");
    for (std::uint32_t i = 0; i < kMessages; ++i) {
      const std::int64_t t_ns = std::int64_t{i} * 1'000'000;
      writer.write(channel, {t_ns, t_ns}, Event{.time_ns = t_ns});
      if (i % 100 == 99) writer.flush();
    }
    writer.close();
    const auto plain = bytes_in(folder_ / "plain.mcap");
    bytes_ = compress(plain);
  }
  void TearDown() override { std::filesystem::remove_all(folder_); }

  std::vector<std::byte> compress(Bytes plain) {
    Buffer out;
    out.put(plain.first(kMagic.size()));
    for (std::uint64_t at = kMagic.size(); at + kRecordHead <= plain.size();) {
      const auto length = length_at(plain, at);
      if (static_cast<Op>(plain[at]) != Op::chunk) {
        out.put(plain.subspan(at, std::min(kRecordHead + length, plain.size() - at)));
        at += kRecordHead + length;
        continue;
      }
      Cursor in(plain.subspan(at + kRecordHead, length));
      const auto head = in.take(28);  // times, size and CRC
      in.take_text();
      in.take<std::uint64_t>();
      const auto records = packed(GetParam(), in.rest());
      chunks_.push_back(out.size());
      const auto record = out.open_record(Op::chunk);
      out.put(head);
      out.put_text(GetParam());
      out.put(static_cast<std::uint64_t>(records.size()));
      out.put(Bytes(records));
      out.close_record(record);
      at += kRecordHead + length;
    }
    out.put(Bytes(kMagic));
    return out.bytes;
  }

  struct Seen {
    std::uint32_t messages = 0;
    bool in_order = true;
    bool cut = false;
    std::size_t damaged = 0;
    std::string error;
  };
  Seen read(Bytes bytes, bool skip_damaged = true) {
    Seen seen;
    try {
      Reader reader(bytes, "foreign", {.check_crc = true, .skip_damaged = skip_damaged});
      for (Message message; reader.next(message); ++seen.messages)
        seen.in_order &= message.sequence == seen.messages;
      seen.cut = reader.truncated_at().has_value();
      seen.damaged = reader.damaged_chunks().size();
    } catch (const Error& error) {
      seen.error = error.what();
    }
    return seen;
  }

  LogRecovery recover() {
    const auto file = folder_ / "foreign.mcap";
    std::ofstream(file, std::ios::binary) << text_of(bytes_);
    std::filesystem::remove(folder_ / "saved.mcap");
    return recover_mcap(file, folder_ / "saved.mcap", {});
  }

  std::filesystem::path folder_ =
      std::filesystem::temp_directory_path() / ("compressed_" + std::to_string(::getpid()));
  std::vector<std::byte> bytes_;
  std::vector<std::size_t> chunks_;  // offsets in bytes_
};

TEST_P(Compressed, IsReadAsThePlainOne) {
  ASSERT_GE(chunks_.size(), 2U);
  const auto seen = read(bytes_);
  EXPECT_EQ(seen.error, "");
  EXPECT_EQ(seen.messages, kMessages);
  EXPECT_TRUE(seen.in_order);
  EXPECT_FALSE(seen.cut);
  EXPECT_TRUE(recover().whole);
}

TEST_P(Compressed, CutAnywhereGivesTheMessagesBeforeTheCut) {
  std::uint32_t before = kMessages;
  for (std::size_t size = bytes_.size() - 1; size > kMagic.size(); size -= std::min<std::size_t>(size, 97)) {
    const auto seen = read(Bytes(bytes_).first(size));
    EXPECT_EQ(seen.error, "") << size;
    EXPECT_TRUE(seen.cut) << size;
    EXPECT_TRUE(seen.in_order) << size;
    EXPECT_LE(seen.messages, before) << size;
    before = seen.messages;
  }
}

TEST_P(Compressed, ADamagedChunkIsSaidAndTheOthersAreRead) {
  for (std::size_t i = 0; i < 24; ++i) bytes_[chunks_[1] + 80 + i] ^= std::byte{0x5A};
  EXPECT_THAT(read(bytes_, false).error, ::testing::HasSubstr("CRC is wrong"));
  const auto seen = read(bytes_);
  EXPECT_EQ(seen.damaged, 1U);
  const auto recovered = recover();
  EXPECT_FALSE(recovered.whole);
  EXPECT_EQ(recovered.saved(), seen.messages);
  EXPECT_EQ(recovered.lost(), kMessages - seen.messages) << "the numbers of the messages tell";
}

TEST_P(Compressed, AnotherCompressionIsNamed) {
  const std::string other = GetParam() == std::string("zstd") ? "brot" : "bzp";
  for (const auto chunk : chunks_)
    std::ranges::copy(bytes_of(other), bytes_.begin() + static_cast<long>(chunk) + 41);
  EXPECT_THAT(read(bytes_).error, ::testing::HasSubstr("compressed with " + other));
}

TEST(Recovery, ANumberThatDoesNotBeginAtZeroIsNoLoss) {
  const auto folder = std::filesystem::temp_directory_path() / ("numbers_" + std::to_string(::getpid()));
  std::filesystem::create_directories(folder);
  Writer writer(folder / "plain.mcap");
  const auto channel = writer.add_channel<Event>("/event");
  for (std::int64_t i = 0; i < 20; ++i) writer.write(channel, {i, i}, Event{.time_ns = i});
  writer.flush();
  writer.close();
  // Sequence numbers as another recorder writes them; the CRC of a chunk may be absent (0).
  auto bytes = bytes_in(folder / "plain.mcap");
  for (std::uint64_t at = kMagic.size(); at + kRecordHead <= bytes.size();) {
    const auto length = length_at(bytes, at);
    const auto op = static_cast<Op>(bytes[at]);
    if (op == Op::chunk) {
      std::fill_n(bytes.begin() + static_cast<long>(at) + 9 + 24, 4, std::byte{0});
      at += kRecordHead + kChunkHead;
      continue;
    }
    if (op == Op::message) bytes[at + kRecordHead + 3] = std::byte{0x13};  // 0x1300 more
    if (op == Op::data_end) std::fill_n(bytes.begin() + static_cast<long>(at) + 9, 4, std::byte{0});
    at += kRecordHead + length;
  }
  std::ofstream(folder / "foreign.mcap", std::ios::binary) << text_of(bytes);
  const auto found = look_at_mcap(folder / "foreign.mcap");
  EXPECT_EQ(found.saved(), 20U);
  EXPECT_EQ(found.lost(), 0U);
  std::filesystem::remove_all(folder);
}

INSTANTIATE_TEST_SUITE_P(Both, Compressed, ::testing::Values("zstd", "lz4"));

}  // namespace
}  // namespace sandhopper::mcap
