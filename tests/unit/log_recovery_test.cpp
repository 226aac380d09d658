// `hop recover`: the messages that are saved from a cut or damaged log, and the report on the rest.
#include "firmware/log/log_recovery.hpp"

#include <gtest/gtest.h>
#include <unistd.h>

#include <fstream>
#include <random>

#include "config/robot_config.hpp"
#include "firmware/log/candump.hpp"
#include "firmware/log/mcap_damage.hpp"
#include "firmware/log/mcap_parts.hpp"
#include "firmware/log/mcap_reader.hpp"
#include "firmware/log/mcap_writer.hpp"
#include "firmware/log/topics.hpp"
#include "firmware/records.hpp"
#include "tools/trial/sim_trial.hpp"

namespace sandhopper {
namespace {

struct Content {
  std::vector<std::uint64_t> ends;  // end of each message in the file
  std::vector<std::string> data;
  std::uint64_t gap_lost = 0;
  bool closed = false;
};

std::string bytes_of_file(const std::filesystem::path& file) {
  std::ifstream in(file, std::ios::binary);
  return {std::istreambuf_iterator<char>(in), {}};
}

Content read(const std::filesystem::path& file) {
  Content content;
  mcap::Reader log(file);
  TopicOf<LogGap> gaps(topic::kGap);
  LogGap gap;
  for (mcap::Message message; log.next(message);) {
    if (gaps.take(message, gap)) {
      content.gap_lost += gap.lost;
      continue;
    }
    content.ends.push_back(message.offset + mcap::kRecordHead + mcap::kMessageHead + message.data.size());
    content.data.emplace_back(mcap::text_of(message.data));
  }
  content.closed = !log.truncated_at();
  return content;
}

// A folder in memory if there is one, because each recovery ends with fdatasync(2).
std::filesystem::path scratch() {
  const std::filesystem::path memory = "/dev/shm";
  const auto parent = ::access(memory.c_str(), W_OK) == 0 ? memory : std::filesystem::temp_directory_path();
  return parent / ("sandhopper_recover_" + std::to_string(::getpid()));
}

class Recover : public ::testing::Test {
 protected:
  // Records the first 0.6 s of a simulated trial once for all tests.
  static void SetUpTestSuite() {
    folder_ = scratch();
    cut_ = folder_ / "cut.mcap";
    saved_ = folder_ / "saved.mcap";
    std::filesystem::create_directories(folder_);
    SimTrialSetup setup;
    setup.robot.limits.strides = 1;
    setup.log = folder_ / "trial.mcap";
    setup.longest_s = 0.6;
    run_sim_trial(setup);
    whole_ = bytes_of_file(setup.log);
    all_ = read(setup.log);
  }
  static void TearDownTestSuite() { std::filesystem::remove_all(folder_); }

  static LogRecovery recover(const std::string& bytes) {
    std::ofstream(cut_, std::ios::binary) << bytes;
    std::filesystem::remove(saved_);
    return recover_mcap(cut_, saved_);
  }

  inline static std::filesystem::path folder_;
  inline static std::string whole_;
  inline static Content all_;
  inline static std::filesystem::path cut_;
  inline static std::filesystem::path saved_;
  void TearDown() override {
    std::filesystem::remove(cut_);
    std::filesystem::remove(saved_);
  }
};

TEST_F(Recover, AWholeLogIsSaidToBeWholeAndNotCopied) {
  const auto found = recover(whole_);
  EXPECT_TRUE(found.whole);
  EXPECT_EQ(found.saved(), all_.data.size());
  EXPECT_FALSE(std::filesystem::exists(saved_));
}

// The copy is a closed log with every message that lies whole before the cut, bit for bit. If not even the
// first record is whole, the log is refused.
TEST_F(Recover, AThousandCutLogsGiveEveryWholeMessage) {
  std::mt19937_64 random(20);
  std::uniform_int_distribution<std::size_t> anywhere(0, whole_.size() - 1);
  std::uniform_int_distribution<std::size_t> in_front(0, 20'000);
  int refused = 0;
  for (int i = 0; i < 1'000; ++i) {
    const std::size_t cut = i % 10 == 0 ? in_front(random) : anywhere(random);
    const std::string part = whole_.substr(0, cut);
    try {
      const auto found = recover(part);
      ASSERT_EQ(bytes_of_file(cut_), part) << "the original is left alone";
      ASSERT_FALSE(found.whole) << cut;
      ASSERT_EQ(found.lost(), 0U) << cut;
      const Content saved = read(saved_);
      ASSERT_TRUE(saved.closed) << cut;
      const auto expected = static_cast<std::size_t>(
          std::count_if(all_.ends.begin(), all_.ends.end(), [&](auto end) { return end <= cut; }));
      ASSERT_EQ(saved.data.size(), expected) << "cut at " << cut;
      ASSERT_EQ(found.saved(), expected);
      ASSERT_TRUE(std::equal(saved.data.begin(), saved.data.end(), all_.data.begin())) << cut;
    } catch (const mcap::Error&) {
      ASSERT_LT(cut, all_.ends.front()) << "refused, though there is a message in it";
      ++refused;
    }
  }
  EXPECT_LT(refused, 20);
}

// Each damaged or missing stretch costs whole chunks and no more. Their records are counted and a gap record
// replaces them.
TEST_F(Recover, DamageAnywhereIsCountedAndTheRestIsSaved) {
  std::mt19937_64 random(21);
  std::uniform_int_distribution<std::size_t> anywhere(all_.ends.front() + 1'000,
                                                      all_.ends[all_.ends.size() / 2]);
  std::uniform_int_distribution<std::size_t> length(1, 5'000);
  std::uniform_int_distribution<int> byte(0, 255);
  for (int i = 0; i < 150; ++i) {
    std::string bytes = whole_;
    const std::size_t from = anywhere(random);
    const std::size_t count = length(random);
    if (i % 3 == 0)
      bytes.erase(from, count);
    else if (i % 3 == 1)
      std::fill_n(bytes.begin() + static_cast<std::ptrdiff_t>(from), count, '\0');
    else
      std::generate_n(bytes.begin() + static_cast<std::ptrdiff_t>(from), count,
                      [&] { return static_cast<char>(byte(random)); });
    if (bytes == whole_) continue;  // zeros written over zeros
    const auto found = recover(bytes);
    ASSERT_FALSE(found.whole) << i;
    const Content saved = read(saved_);
    ASSERT_TRUE(saved.closed);
    ASSERT_EQ(saved.data.size() + found.lost(), all_.data.size()) << "damage " << i << " at " << from;
    ASSERT_EQ(saved.gap_lost, found.lost()) << i;
    ASSERT_GT(saved.data.size(), all_.data.size() / 4) << i;
    ASSERT_EQ(saved.data.back(), all_.data.back()) << i;
  }
}

TEST_F(Recover, AFrontThatIsGoneIsLearntFromTheEnd) {
  std::string bytes = whole_;
  std::fill_n(bytes.begin(), 3'000, '\x5A');
  const auto found = recover(bytes);
  const Content saved = read(saved_);
  EXPECT_TRUE(saved.closed);
  EXPECT_EQ(saved.data.size(), all_.data.size()) << "the schemas are in the summary, too";
  EXPECT_FALSE(found.damage.empty());
}

TEST_F(Recover, WhatTheLogItselfRecordsAsMissingIsNotCountedTwice) {
  const auto log = folder_ / "gap.mcap";
  {
    mcap::Writer writer(log);
    const auto gaps = writer.add_channel<LogGap>(topic::kGap);
    const auto events = writer.add_channel<Event>(topic::kEvent);
    for (int i = 0; i < 5; ++i) writer.write(events, {}, Event{.time_ns = i});
    writer.write(gaps, {}, LogGap{.lost = 7, .cause = LossCause::ring_full});
    for (int i = 12; i < 20; ++i) writer.write(events, {}, Event{.time_ns = i});
    writer.close();
  }
  const std::string bytes = bytes_of_file(log);
  const auto found = recover(bytes.substr(0, bytes.size() - 10));
  EXPECT_EQ(found.gaps, 1U);
  EXPECT_EQ(found.lost_in_gaps, 7U);
  EXPECT_EQ(found.lost(), 0U);
  EXPECT_EQ(found.topics.at("/event").saved, 13U);
}

std::string refusal(const std::filesystem::path& from, const std::filesystem::path& to) {
  try {
    recover_mcap(from, to);
  } catch (const mcap::Error& error) {
    return error.what();
  }
  return "";
}

TEST_F(Recover, AFormatThatIsMistakenForALogIsNamedWithItsConversion) {
  const auto other = folder_ / "mistaken.mcap", to = folder_ / "none.mcap";
  std::ofstream(other, std::ios::binary) << "\x89MCAP0\r\r\n" << std::string(50, 'x');
  EXPECT_NE(refusal(other, to).find("transfer in text mode"), std::string::npos) << refusal(other, to);
  EXPECT_NE(refusal(other, to).find("perl -pe 's/\\r\\n/\\n/' FILE"), std::string::npos);
  std::ofstream(other, std::ios::binary) << "\x1f\x8b" << std::string(50, 'x');
  EXPECT_NE(refusal(other, to).find("gunzip -c FILE > OTHER.mcap"), std::string::npos);
  std::ofstream(other, std::ios::binary) << std::string(50, 'x');
  EXPECT_NE(refusal(other, to).find("no MCAP log"), std::string::npos);
}

TEST_F(Recover, ADamagedLogIsToldFromAFileThatIsNone) {
  const auto file = folder_ / "one_bit.mcap";
  {
    mcap::Writer writer(file);
    const auto gaps = writer.add_channel<LogGap>(topic::kGap);
    for (int i = 0; i < 100; ++i) writer.write(gaps, {}, LogGap{.lost = 7});
    writer.close();
  }
  const auto read_all = [&] {
    mcap::Reader log(file);
    for (mcap::Message message; log.next(message);) {
    }
  };
  EXPECT_NO_THROW(read_all());
  std::string bytes = bytes_of_file(file);
  bytes[bytes.size() / 4] ^= 1;
  std::ofstream(file, std::ios::binary) << bytes;
  EXPECT_THROW(read_all(), mcap::Damaged);
  std::ofstream(file, std::ios::binary) << "no log";
  try {
    read_all();
    ADD_FAILURE() << "read";
  } catch (const mcap::Error& error) {
    EXPECT_EQ(dynamic_cast<const mcap::Damaged*>(&error), nullptr);
  }
}

TEST_F(Recover, AnExistingFileIsNotOverwritten) {
  recover(whole_.substr(0, whole_.size() / 2));
  const std::string before = bytes_of_file(saved_);
  EXPECT_THROW(recover_mcap(cut_, saved_), std::system_error);
  EXPECT_EQ(bytes_of_file(saved_), before);
}

TEST_F(Recover, OtherFilesAreRefused) {
  EXPECT_THROW(recover("t_s,phase\n0,1\n"), mcap::Error);
  EXPECT_THROW(recover(""), mcap::Error);
  EXPECT_FALSE(std::filesystem::exists(saved_));
}

TEST_F(Recover, ALogAppendedToItselfCountsOnce) {
  for (const auto& bytes : {whole_ + whole_, whole_ + whole_ + whole_.substr(0, whole_.size() / 2),
                            whole_.substr(0, whole_.size() / 2) + whole_}) {
    const auto found = recover(bytes);
    EXPECT_FALSE(found.whole);
    EXPECT_GE(found.copies, 2U);
    EXPECT_EQ(found.saved(), all_.data.size());
    EXPECT_EQ(found.lost(), 0U);
    EXPECT_TRUE(found.end_is_known());
    EXPECT_EQ(bytes_of_file(saved_), whole_);
  }
}

TEST_F(Recover, DifferentLogsInOneFileAreCutByTheCommandsGiven) {
  const auto other = folder_ / "other.mcap";
  {
    mcap::Writer writer(other);
    const auto events = writer.add_channel<Event>(topic::kEvent);
    for (int i = 0; i < 5; ++i) writer.write(events, {}, Event{.time_ns = i});
    writer.close();
  }
  const std::string second = bytes_of_file(other);
  try {
    recover(whole_ + second);
    FAIL() << "the second log would be mixed with the first";
  } catch (const mcap::SeveralLogs& error) {
    EXPECT_NE(std::string(error.what()).find("2 different logs"), std::string::npos) << error.what();
    const auto command = "cd '" + folder_.string() + "' && " + error.cure.substr(error.cure.find("tail"));
    ASSERT_EQ(std::system(command.c_str()), 0) << command;  // NOLINT(concurrency-mt-unsafe)
    EXPECT_EQ(bytes_of_file(folder_ / "log_1.mcap"), whole_);
    EXPECT_EQ(bytes_of_file(folder_ / "log_2.mcap"), second);
  }
  EXPECT_FALSE(std::filesystem::exists(saved_));
}

TEST_F(Recover, BytesBehindTheEndOfAClosedLogMissNothing) {
  for (const auto& tail : {std::string(65'536, '\0'), std::string("and some text\n")}) {
    const auto found = recover(whole_ + tail);
    EXPECT_FALSE(found.whole);
    EXPECT_FALSE(found.cut_at);
    EXPECT_TRUE(found.end_is_known());
    EXPECT_EQ(found.bytes_behind_end, tail.size());
    EXPECT_EQ(found.zeros_behind_end, tail[0] == '\0');
    EXPECT_EQ(found.saved(), all_.data.size());
    EXPECT_EQ(bytes_of_file(saved_), whole_);
  }
}

TEST_F(Recover, ZerosBehindALogThatWasNotClosedAreACut) {
  const auto found = recover(whole_.substr(0, whole_.size() / 2) + std::string(4'096, '\0'));
  EXPECT_TRUE(found.cut_at);
  EXPECT_FALSE(found.end_is_known());
}

TEST_F(Recover, ZerosInCanTextLoseTheFrameThatTheyCut) {
  std::string text;
  for (int i = 0; i < 100; ++i) text += "(1.0" + std::to_string(100 + i) + ") can0 001#0011223344556677\n";
  const auto line = text.find('\n') + 1;
  const auto recover_text = [&](std::size_t at) {
    std::string damaged = text;
    std::ofstream(cut_, std::ios::binary) << damaged.insert(at, 4'096, '\0');
    std::filesystem::remove(saved_);
    return recover_candump(cut_, saved_);
  };
  const auto within = recover_text(40 * line + 20);
  EXPECT_EQ(within.topics.at("can0").saved, 99U);
  EXPECT_EQ(within.topics.at("can0").lost, 1U);
  EXPECT_TRUE(within.loses_at_least);
  const auto between = recover_text(40 * line);
  EXPECT_EQ(between.topics.at("can0").saved, 100U);
  EXPECT_EQ(between.topics.at("can0").lost, 0U);
  EXPECT_TRUE(between.loses_at_least) << "the zeros may stand for frames";
  EXPECT_EQ(bytes_of_file(saved_), text);
}

TEST_F(Recover, CanTextAppendedToItselfCountsOnce) {
  std::string text;
  for (int i = 0; i < 100; ++i) text += "(1.0" + std::to_string(100 + i) + ") can0 001#0011223344556677\n";
  const auto recover_text = [&](const std::string& all) {
    std::ofstream(cut_, std::ios::binary) << all;
    std::filesystem::remove(saved_);
    return recover_candump(cut_, saved_);
  };
  const auto twice = recover_text(text + text);
  EXPECT_EQ(twice.copies, 2U);
  EXPECT_EQ(twice.saved(), 100U);
  EXPECT_EQ(bytes_of_file(saved_), text);
  EXPECT_TRUE(recover_text(text).whole);
}

TEST_F(Recover, CanTextLosesItsTornLineAndSaysSo) {
  const auto log = folder_ / "trial.candump";
  {
    CandumpWriter writer(log);
    for (int i = 0; i < 100; ++i) writer.write({.time_ns = i * 1'000'000, .id = 1, .length = 2}, "can0");
    writer.comment_lost(12, "of can0, the logger was too slow");
    writer.close();
  }
  const std::string bytes = bytes_of_file(log);
  EXPECT_TRUE(recover_candump(log, folder_ / "none").whole);
  const auto cut = folder_ / "cut.candump";
  std::ofstream(cut, std::ios::binary) << "(0.5) can0 001#00" << '\n'
                                       << "(0.6) can0 00" << '\n'
                                       << bytes << "(1.000000) can0 001#11";
  const auto found = recover_candump(cut, folder_ / "saved.candump");
  EXPECT_EQ(found.saved(), 101U);
  EXPECT_EQ(found.damage.size(), 1U);
  EXPECT_EQ(found.lost_in_gaps, 12U);
  EXPECT_TRUE(found.cut_at.has_value());
  EXPECT_EQ(bytes_of_file(folder_ / "saved.candump"), "(0.5) can0 001#00\n" + bytes);
}

}  // namespace
}  // namespace sandhopper
