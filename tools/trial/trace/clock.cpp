#include "tools/trial/trace/clock.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <limits>
#include <optional>

#include "tools/trial/trace/reply_steps.hpp"
#include "tools/trial/trace/timing.hpp"

namespace sandhopper::trace {
namespace {

// Largest number of frames in one batch: a millisecond of the shortest frames.
constexpr std::size_t kBatchFrames = static_cast<std::size_t>(kBatch_ns / kShortestFrame_ns);
// With fewer frames, round times may be a coincidence and do not show the resolution.
constexpr std::size_t kFewestForResolution = 10;
// Longest plausible time without any frame in a recording: a day.
constexpr std::int64_t kLongestSilence_ns = 86'400'000'000'000;

double seconds(std::int64_t ns) { return 1e-9 * static_cast<double>(ns); }

// True if a later frame of the same batch has a time not before `newest_ns`.
bool catches_up(const std::vector<Frame>& frames, std::size_t i, std::int64_t newest_ns) {
  const auto end = std::min(frames.size(), i + kBatchFrames);
  for (std::size_t j = i + 1; j < end; ++j)
    if (frames[j].time_ns >= newest_ns) return true;
  return i + 1 == frames.size();  // the last frame of the file has no successor that could contradict
}

// True if many times go backward and the second half of the times is not later than the first half.
bool are_differences(const std::vector<Frame>& frames) {
  std::uint64_t backward = 0;
  for (std::size_t i = 1; i < frames.size(); ++i) backward += frames[i].time_ns < frames[i - 1].time_ns;
  if (frames.size() < kFewestForResolution || 4 * backward < frames.size()) return false;
  const auto earlier = [](const Frame& a, const Frame& b) { return a.time_ns < b.time_ns; };
  const auto begin_ns = std::ranges::min_element(frames, earlier)->time_ns;
  if (begin_ns > kLongestSilence_ns) return false;  // the times are dates
  double first_s = 0.0, second_s = 0.0;
  for (std::size_t i = 0; i < frames.size(); ++i)
    (2 * i < frames.size() ? first_s : second_s) += seconds(frames[i].time_ns - begin_ns);
  return second_s < 2.0 * first_s;  // evenly increasing times would give a factor of three
}

std::int64_t resolution_of(const std::vector<Frame>& frames) {
  constexpr std::int64_t kCoarsest_ns = 1'000'000'000;
  if (frames.size() < kFewestForResolution) return 1;
  std::int64_t resolution_ns = kCoarsest_ns;
  for (const auto& frame : frames)
    while (resolution_ns > 1 && frame.time_ns % resolution_ns != 0) resolution_ns /= 10;
  return resolution_ns;
}

std::string places(const std::vector<ClockEvent>& events) {
  constexpr std::size_t kShown = 3;
  std::string text;
  for (std::size_t i = 0; i < std::min(events.size(), kShown); ++i)
    text += fmt::format("{}line {} ({:.3f} s)", i == 0 ? "" : ", ", events[i].line,
                        std::abs(seconds(events[i].change_ns)));
  if (events.size() > kShown) text += fmt::format(" and {} more", events.size() - kShown);
  return text;
}

// Counters of adapters that begin again: milliseconds of a minute (slcan), of 16 bits and of 32 bits, and
// microseconds of 32 bits.
constexpr std::array<std::int64_t, 4> kWraps_ns{60'000'000'000, 65'536'000'000, 4'294'967'296'000,
                                                4'294'967'296'000'000};

// Time after which the clock begins again; empty if some step back is another one. A step back by that time,
// less some periods, goes on without a pause.
std::optional<std::int64_t> wrap_of(const ClockReport& report, std::int64_t period_ns) {
  if (report.steps_back.empty() || period_ns <= 0) return std::nullopt;
  const auto found = std::ranges::find_if(kWraps_ns, [&](std::int64_t wrap_ns) {
    return std::ranges::all_of(report.steps_back, [&](const ClockEvent& step) {
      const std::int64_t goes_on_ns = step.change_ns + wrap_ns;
      return step.time_ns <= wrap_ns && goes_on_ns >= -report.resolution_ns &&
             goes_on_ns <= kLongestStep * period_ns;
    });
  });
  return found == kWraps_ns.end() ? std::nullopt : std::optional(*found);
}

Finding wrap_finding(const ClockReport& report, const std::string& file, std::int64_t wrap_ns) {
  const double wrap_s = seconds(wrap_ns);
  return {
      "clock_wraps",
      fmt::format("the times begin again after {:.10g} s, as a counter in the adapter does: {}", wrap_s,
                  places(report.steps_back)),
      fmt::format("let them go on: awk '/^[(]/ {{ t = substr($1, 2) + 0; if (n++) {{ if (t < l - {0:.10g}) "
                  "w += {1:.10g}; if (w > 0 && t > l + {0:.10g}) w -= {1:.10g} }} l = t; sub(/^[(][0-9.]+/, "
                  "sprintf(\"(%.6f\", t + w)) }} 1' '{2}' > unwrapped.log",
                  0.5 * wrap_s, wrap_s, file),
      false};
}

}  // namespace

ClockReport examine_clock(const std::vector<Frame>& frames, std::int64_t pause_ns) {
  ClockReport report;
  report.resolution_ns = resolution_of(frames);
  report.differences = are_differences(frames);
  if (report.differences || frames.empty()) return report;
  std::int64_t newest_ns = frames.front().time_ns;
  for (std::size_t i = 1; i < frames.size(); ++i) {
    const auto& frame = frames[i];
    const std::int64_t change_ns = frame.time_ns - newest_ns;
    if (change_ns >= 0) {
      if (change_ns > pause_ns) report.pauses.push_back({frame.line, newest_ns, change_ns});
      newest_ns = frame.time_ns;
    } else if (-change_ns <= kBatch_ns && catches_up(frames, i, newest_ns)) {
      ++report.swapped;
    } else {
      report.steps_back.push_back({frame.line, newest_ns, change_ns});
      newest_ns = frame.time_ns;
    }
  }
  return report;
}

void put_in_order(std::vector<Frame>& frames, const ClockReport& report) {
  const auto earlier = [](const Frame& a, const Frame& b) { return a.time_ns < b.time_ns; };
  auto begin = frames.begin();
  for (const auto& step : report.steps_back) {
    const auto end =
        std::find_if(begin, frames.end(), [&](const Frame& frame) { return frame.line >= step.line; });
    std::stable_sort(begin, end, earlier);
    begin = end;
  }
  if (!report.differences) std::stable_sort(begin, frames.end(), earlier);
}

Findings clock_findings(const ClockReport& report, const Trace& trace, std::int64_t period_ns) {
  Findings out;
  if (report.differences) {
    out.push_back({"times_are_differences",
                   "the times do not go on: each seems to be the time since the frame before",
                   "record with absolute times: candump -L, without -t", false});
    return out;
  }
  // A single clock is not set so often; see can-utils issue 233.
  constexpr std::size_t kManySteps = 3;
  if (const auto wrap_ns = wrap_of(report, period_ns))
    out.push_back(wrap_finding(report, trace.file, *wrap_ns));
  else if (report.steps_back.size() > kManySteps)
    out.push_back({"several_clocks",
                   fmt::format("times jump to and fro {} times, as of several clocks: {}",
                               report.steps_back.size(), places(report.steps_back)),
                   "record one interface on one computer, with the kernel's stamps: candump -L can0", false});
  else if (!report.steps_back.empty())
    out.push_back({"clock_step",
                   fmt::format("the clock was set back {} times: {}", report.steps_back.size(),
                               places(report.steps_back)),
                   "replay the parts before and after it as traces of their own; stop time synchronisation "
                   "while recording",
                   false});
  if (!report.pauses.empty())
    out.push_back({"pause",
                   fmt::format("{} times no frame at all came: {}; the recording paused, the host stood "
                               "still, or the clock was set forward",
                               report.pauses.size(), places(report.pauses)),
                   "replay the parts before and after it as traces of their own", false});
  if (report.swapped > 0)
    out.push_back(
        {"swapped", fmt::format("{} frames stand after a later one and were put in the order of their times",
                                report.swapped)});
  if (period_ns > 0 && 2 * report.resolution_ns >= period_ns)
    out.push_back({"coarse_times",
                   fmt::format("times have a resolution of {:g} ms, commands come every {:g} ms: late "
                               "replies and speeds cannot be told from {}",
                               1e-6 * static_cast<double>(report.resolution_ns),
                               1e-6 * static_cast<double>(period_ns), trace.file),
                   "record with microseconds: candump -L", report.resolution_ns <= period_ns});
  return out;
}

}  // namespace sandhopper::trace
