#include "tools/explain/explanation.hpp"

#include <fmt/chrono.h>
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <ctime>

#include "tools/explain/measured_channels.hpp"
#include "tools/report/event_text.hpp"

namespace sandhopper {
namespace {

constexpr double kBeforeSteps_s = 0.02;  // the steps begin so long before the instant
constexpr double kShortest_s = 0.004;    // a step of fewer cycles is passed over, unless it is the last

double seconds_from(const Recording& recording, std::int64_t time_ns) {
  return 1e-9 * static_cast<double>(time_ns - recording.time_ns);
}

std::string utc(std::int64_t realtime_ns) {
  const auto seconds = static_cast<std::time_t>(realtime_ns / 1'000'000'000);
  return fmt::format("{:%Y-%m-%d %H:%M:%S}.{:03} UTC", fmt::gmtime(seconds),
                     realtime_ns % 1'000'000'000 / 1'000'000);
}

std::string_view drives_of(const Command& command) {
  if (command.drive == DriveRequest::off) return "off";
  if (command.drive == DriveRequest::enable) return "on, zero gains";
  double torque = 0.0, kp = 0.0, kd = 0.0;
  for (const auto& motor : command.motor) {
    torque = std::max(torque, std::abs(motor.torque_Nm));
    kp = std::max(kp, motor.kp_Nm_per_rad);
    kd = std::max(kd, motor.kd_Nm_s_per_rad);
  }
  if (kp > 0.0) return "hold";
  if (kd > 0.0) return "damping";
  return torque > 0.0 ? "spring law" : "zero torque";
}

std::vector<ReactionStep> steps_of(const Recording& recording) {
  std::vector<ReactionStep> steps;
  const auto& cycles = recording.cycles;
  auto first = std::ranges::find_if(cycles, [&](const auto& cycle) {
    return seconds_from(recording, cycle.second.time_ns) >= -kBeforeSteps_s;
  });
  // After a gap there is none of those 20 ms: the last cycle before it says what was done until then.
  if (first != cycles.begin() && first != cycles.end() && first->second.time_ns >= recording.time_ns) --first;
  for (; first != cycles.end(); ++first) {
    const StepOutput& output = first->second;
    const double time_s = seconds_from(recording, output.time_ns);
    const auto drives = drives_of(output.command);
    if (!steps.empty() && steps.back().state == output.state && steps.back().drives == drives) {
      steps.back().to_s = time_s;
      continue;
    }
    if (!steps.empty()) steps.back().to_s = time_s;
    // The law passes through zero torque for a cycle or two: no step of its own.
    if (!steps.empty() && time_s - steps.back().from_s < kShortest_s && steps.size() > 1 &&
        steps[steps.size() - 2].state == output.state && steps[steps.size() - 2].drives == drives) {
      steps.pop_back();
      continue;
    }
    steps.push_back({time_s, time_s, output.state, std::string(drives)});
  }
  return steps;
}

// Cycle numbers that are missing between two cycles and that no overrun explains.
std::uint64_t missing_cycles(const Recording& recording) {
  std::uint64_t missing = 0;
  for (std::size_t i = 1; i < recording.cycles.size(); ++i) {
    const SensorFrame& before = recording.cycles[i - 1].first;
    const SensorFrame& now = recording.cycles[i].first;
    const std::uint64_t jump = now.cycle - before.cycle - 1;
    const std::uint64_t skipped = now.overruns - before.overruns;
    missing += jump > skipped ? jump - skipped : 0;
  }
  return missing;
}

void add_faults(const Recording& recording, Explanation& result) {
  const ConfigNode* robot = recording.robot ? &*recording.robot : nullptr;
  for (const Event& event : recording.events) {
    if (event.kind != EventKind::fault_raised || event.time_ns < recording.time_ns) continue;
    result.faults.push_back({seconds_from(recording, event.time_ns), event.fault, read_fault(event, robot)});
  }
}

void add_plots(const Recording& recording, Explanation& result) {
  ReportData& data = result.data;
  add_measured_channels(recording, data);
  for (const auto& [frame, output] : recording.cycles) {
    const double time_s = seconds_from(recording, output.time_ns);
    const auto name = name_of(output.state);
    if (data.phases.empty() || data.phases.back().name != name) {
      if (!data.phases.empty()) data.phases.back().to_s = time_s;
      data.phases.push_back({time_s, time_s, std::string(name)});
    }
    data.phases.back().to_s = time_s;
  }
  for (const Event& event : recording.events)
    data.events.push_back({seconds_from(recording, event.time_ns), event.stride,
                           in_plain_words(name_of(event.kind)), in_plain_words(name_of(event.reason)),
                           values_of(event)});
  data.configuration = recording.robot_toml;
}

std::vector<std::string> notes_of(const Recording& recording, const Explanation& e) {
  std::vector<std::string> notes;
  if (recording.cause == FreezeCause::killed)
    notes.emplace_back(
        "hopperd ended here without closing its log: it was killed, crashed or stood still. This is what it "
        "wrote "
        "last.");
  if (recording.cut) notes.emplace_back("The file was not closed; it is shown up to its last whole record.");
  if (e.missing_cycles > 0)
    notes.push_back(fmt::format("{} cycles are missing, by the cycle counter.", e.missing_cycles));
  if (!recording.robot)
    notes.emplace_back(
        "The file carries no configuration, so limits that the event does not name are not known.");
  return notes;
}

std::string fault_lines(const ExplainedFault& f) {
  const FaultEntry& entry = entry_of(f.fault);
  return fmt::format("  check:    {}\n  means:    {}\n  reaction: {}, lasting {}\n  cure:     {}\n",
                     in_words(f.reading), entry.meaning, name_of(entry.reaction), name_of(entry.latch),
                     entry.cure);
}

}  // namespace

std::string in_plain_words(std::string_view name) {
  std::string text(name);
  std::ranges::replace(text, '_', ' ');
  return text;
}

Explanation explain(const Recording& recording) {
  Explanation result;
  result.cause = recording.cause;
  result.date = utc(recording.time_ns + recording.realtime_offset_ns);
  add_faults(recording, result);
  result.steps = steps_of(recording);
  if (!recording.cycles.empty()) {
    result.before_s = std::max(0.0, -seconds_from(recording, recording.cycles.front().second.time_ns));
    result.after_s = std::max(0.0, seconds_from(recording, recording.cycles.back().second.time_ns));
  }
  result.missing_cycles = missing_cycles(recording);
  result.notes = notes_of(recording, result);
  result.title = result.faults.empty() ? std::string("hopperd ended without closing its log")
                                       : fmt::format("Fault {} {}", static_cast<int>(result.faults[0].fault),
                                                     name_of(result.faults[0].fault));
  add_plots(recording, result);
  ReportData& data = result.data;
  data.title = result.title;
  data.notes = result.notes;
  data.facts.emplace_back("date", result.date);
  for (const auto& key : {"log", "board", "version", "who", "bed"})
    if (const auto fact = recording.facts.find(key); fact != recording.facts.end() && !fact->second.empty())
      data.facts.emplace_back(key, fact->second);
  data.facts.emplace_back("shown",
                          fmt::format("{:.3f} s before, {:.3f} s after", result.before_s, result.after_s));
  return result;
}

std::string explanation_text(const Explanation& e) {
  std::string text = fmt::format("{}, {}\n", e.title, e.date);
  for (std::size_t i = 0; i < e.faults.size(); ++i) {
    if (i > 0)
      text += fmt::format("then, at {:+.3f} s, fault {} {}\n", e.faults[i].time_s,
                          static_cast<int>(e.faults[i].fault), name_of(e.faults[i].fault));
    text += fault_lines(e.faults[i]);
  }
  text += "  what was done:\n";
  for (const auto& step : e.steps)
    text += fmt::format("    {:+.3f} s to {:+.3f} s  {:<11} {}\n", step.from_s, step.to_s,
                        name_of(step.state), step.drives);
  for (const auto& note : e.notes) text += "  note: " + note + "\n";
  text += fmt::format("  the file holds {:.3f} s before and {:.3f} s after", e.before_s, e.after_s);
  return text;
}

}  // namespace sandhopper
