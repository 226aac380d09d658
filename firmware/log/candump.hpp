#pragma once
#include <array>
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <optional>
#include <stdexcept>
#include <string>
#include <string_view>

#include "firmware/log/append_file.hpp"

// CAN traffic as `candump -L` text, one line per frame. canplayer, log2asc and other CAN tools read it:
//   (1700000000.123456) can0 00A#7FFF7FF0000007FF T
// Three hexadecimal digits are a standard identifier, eight an extended one or, with bit 0x20000000, an error
// frame; R in place of data is a remote request.
namespace sandhopper {

// refused: not sent; written as a comment, so that no tool takes it for traffic.
enum class CanDirection : std::uint8_t { unknown, received, sent, refused };

struct CandumpFrame {
  std::int64_t time_ns = 0;  // since 1970, or since the recording's own zero
  std::uint32_t id =
      0;  // with the flags of linux/can.h: 0x80000000 extended, 0x40000000 remote, 0x20000000 error
  std::uint8_t length = 0;  // data bytes; for a remote request the number requested
  std::array<std::uint8_t, 8> data{};
  CanDirection direction = CanDirection::unknown;
};

struct CandumpFormat {
  int decimals = 6;       // fractions are truncated; 9 digits are possible, but Debian 12's canplayer refuses
                          // them
  bool direction = true;  // R or T at the end of the line, if known
};

// The line without its end.
std::string format_candump(const CandumpFrame& frame, std::string_view interface, CandumpFormat format = {});

class CandumpError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

struct CandumpLine {
  CandumpFrame frame;
  std::string_view interface;  // part of the given text
};

// Empty for a line that does not begin with '(' (blank, a comment); every CAN tool skips such lines. Tokens
// after the frame are ignored except R and T. Throws CandumpError on anything else, including CAN FD and CAN
// XL.
std::optional<CandumpLine> parse_candump(std::string_view line);

// Number in CandumpWriter's comment "# 12 frames lost: why"; 0 for any other line.
std::uint64_t frames_lost_in(std::string_view line);

struct CandumpDisk {
  bool keep_going = false;          // drop frames that cannot be written
  std::uint64_t reserve_bytes = 0;  // reserved for the last comment
  FileCalls calls = FileCalls::of_the_system();
};

// Appends to a new file. Throws std::system_error. With `keep_going`, frames that cannot be written are
// dropped instead; a comment with their number follows in their place as soon as there is room.
class CandumpWriter {
 public:
  explicit CandumpWriter(const std::filesystem::path& file, CandumpFormat format = {},
                         const CandumpDisk& disk = {});
  void write(const CandumpFrame& frame, std::string_view interface);
  void comment(std::string_view text);  // a line that CAN tools skip
  // A comment that `frames` are missing here, with the reason.
  void comment_lost(std::uint64_t frames, std::string_view why);
  void flush();                        // writes the buffer to the file
  int sync() { return file_.sync(); }  // fdatasync(2), see AppendFile
  void close();

  const std::filesystem::path& path() const { return file_.path(); }
  std::uint64_t lost() const { return lost_; }         // frames that the disk did not take
  const std::string& error() const { return error_; }  // error of the last flush; empty if it succeeded

 private:
  AppendFile file_;
  CandumpFormat format_;
  bool keep_going_;
  std::string buffer_;
  std::uint64_t frames_in_buffer_ = 0;
  std::uint64_t said_in_buffer_ = 0;  // lost frames that comments in the buffer report
  std::uint64_t unsaid_ = 0;          // lost frames that no comment in the file reports yet
  std::uint64_t lost_ = 0;
  std::string error_;
};

// Reads a file line by line; errors are "file:line: what".
class CandumpReader {
 public:
  explicit CandumpReader(const std::filesystem::path& file);

  // False at the end. `interface` stays valid until the next call.
  [[nodiscard]] bool next(CandumpFrame& frame, std::string_view& interface);
  std::uint64_t line_number() const { return line_number_; }

 private:
  std::string name_;
  std::ifstream in_;
  std::string line_;
  std::uint64_t line_number_ = 0;
};

}  // namespace sandhopper
