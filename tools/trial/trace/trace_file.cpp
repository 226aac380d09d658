#include "tools/trial/trace/trace_file.hpp"

#include <algorithm>
#include <cerrno>
#include <fstream>
#include <string_view>
#include <system_error>

#include "tools/trial/trace/recorder_loss.hpp"
#include "tools/trial/trace/spreadsheet.hpp"

namespace sandhopper::trace {
namespace {

constexpr std::size_t kShownCharacters = 60;

std::string shown(std::string_view line) {
  std::string text;
  for (const char c : line.substr(0, kShownCharacters)) text += c >= ' ' && c <= '~' ? c : '?';
  return text;
}

// Counts a CAN FD frame: "(time) can0 ID##FDATA", F the digit of its flags. Reading the line with a classic
// frame in its place gives the identifier.
void count_fd(std::string_view line, Trace& trace) {
  const auto mark = line.find("##");
  const auto end = std::min(line.find_first_of(" \t\r", mark), line.size());
  constexpr std::size_t kMarkAndFlags = 3;
  ++trace.fd_frames;
  if (end < mark + kMarkAndFlags) return;
  try {
    const auto classic = parse_candump(std::string(line.substr(0, mark + 1)));
    if (!classic) return;
    auto& frames = trace.fd_by_id[classic->frame.id];
    ++frames.count;
    const auto bytes = static_cast<std::uint8_t>((end - mark - kMarkAndFlags) / 2);
    frames.longest = std::max(frames.longest, bytes);
  } catch (const CandumpError&) {
    // CAN XL, or no identifier: counted without one.
  }
}

class TraceBuilder {
 public:
  TraceBuilder(std::string file, const std::string& bus) : bus_(bus) { trace_.file = std::move(file); }

  void take(std::string_view line, std::uint64_t number) {
    forget_torn_line();
    const auto zeros = std::min(line.find_first_not_of('\0'), line.size());
    trace_.zero_bytes += zeros;
    line.remove_prefix(zeros);
    trace_.digits.see(line);
    try {
      if (const auto parsed = parse_candump(line))
        keep(*parsed, number);
      else
        pass_over(line, number);
    } catch (const CandumpError& error) {
      if (line.find("##") != std::string_view::npos)
        count_fd(line, trace_);
      else if (has_spreadsheet_number(line))
        take_number(line, number);
      else
        torn_ = BadLines{1, number, error.what()};
    }
  }

  std::size_t frames() const { return trace_.frames.size(); }

  // `complete`: the last line has a line end.
  Trace finish(bool complete) {
    if (torn_.count > 0 && (complete || trace_.frames.empty())) forget_torn_line();
    trace_.last_line_torn = torn_.count > 0;
    return std::move(trace_);
  }

 private:
  void keep(const CandumpLine& line, std::uint64_t number) {
    if (!bus_.empty() && line.interface != bus_) return;
    const auto found = std::ranges::find(trace_.interfaces, line.interface);
    const auto place = static_cast<std::uint16_t>(found - trace_.interfaces.begin());
    if (found == trace_.interfaces.end()) trace_.interfaces.emplace_back(line.interface);
    const auto& f = line.frame;
    trace_.frames.push_back({f.time_ns, number, f.id, place, f.length, f.direction, f.data});
  }

  void take_number(std::string_view line, std::uint64_t number) {
    auto& numbers = trace_.spreadsheet_numbers;
    if (numbers.count++ > 0) return;
    numbers.first_line = number;
    numbers.first = shown(line);
  }

  void pass_over(std::string_view line, std::uint64_t number) {
    const auto own = frames_lost_in(line);
    trace_.lost_by_recorder += own;
    if (const auto loss = own > 0 ? std::nullopt : loss_said_in(line)) {
      trace_.frames_in_losses += loss->frames;
      if (trace_.losses.count++ == 0) trace_.losses.first_line = number, trace_.losses.first = shown(line);
      return;
    }
    if (line.starts_with('#') || line.find_first_not_of(" \t\r") == std::string_view::npos) return;
    auto& passed = trace_.passed_over;
    if (passed.count++ > 0) return;
    passed.first_line = number;
    passed.first = shown(line);
  }

  // An unreadable last line counts as unreadable only if another line follows.
  void forget_torn_line() {
    if (torn_.count == 0) return;
    auto& bad = trace_.unreadable;
    if (bad.count++ == 0) {
      bad.first_line = torn_.first_line;
      bad.first = torn_.first;
    }
    torn_ = {};
  }

  const std::string& bus_;
  Trace trace_;
  BadLines torn_;
};

}  // namespace

Trace read_trace(const std::filesystem::path& file, const std::string& bus,
                 const std::function<void(std::uint64_t frames)>& progress) {
  constexpr std::uint64_t kLinesPerReport = 4096;
  std::ifstream in(file, std::ios::binary);
  if (!in) throw std::system_error(errno, std::generic_category(), file.string());
  TraceBuilder builder(file.string(), bus);
  std::string line;
  std::uint64_t number = 0;
  bool complete = true;
  while (std::getline(in, line)) {
    complete = !in.eof();
    builder.take(line, ++number);
    if (progress && number % kLinesPerReport == 0) progress(builder.frames());
  }
  return builder.finish(complete);
}

}  // namespace sandhopper::trace
