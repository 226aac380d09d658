#include "tools/trial/trace/trace_file.hpp"

#include <algorithm>
#include <cerrno>
#include <fstream>
#include <string_view>
#include <system_error>

namespace sandhopper::trace {
namespace {

constexpr std::size_t kShownCharacters = 60;

class TraceBuilder {
 public:
  TraceBuilder(std::string file, const std::string& bus) : bus_(bus) { trace_.file = std::move(file); }

  void take(std::string_view line, std::uint64_t number) {
    forget_torn_line();
    const auto zeros = std::min(line.find_first_not_of('\0'), line.size());
    trace_.zero_bytes += zeros;
    line.remove_prefix(zeros);
    try {
      if (const auto parsed = parse_candump(line))
        keep(*parsed, number);
      else
        pass_over(line, number);
    } catch (const CandumpError& error) {
      if (line.find("##") != std::string_view::npos)
        ++trace_.fd_frames;
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

  void pass_over(std::string_view line, std::uint64_t number) {
    trace_.lost_by_recorder += frames_lost_in(line);
    if (line.starts_with('#') || line.find_first_not_of(" \t\r") == std::string_view::npos) return;
    auto& passed = trace_.passed_over;
    if (passed.count++ > 0) return;
    passed.first_line = number;
    for (const char c : line.substr(0, kShownCharacters)) passed.first += c >= ' ' && c <= '~' ? c : '?';
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
