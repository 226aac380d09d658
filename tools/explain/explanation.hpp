#pragma once
#include <optional>
#include <string>
#include <vector>

#include "firmware/fault_check.hpp"
#include "tools/explain/recording.hpp"
#include "tools/report/report_data.hpp"

namespace sandhopper {

// A fault of the recording, with what its check compared.
struct ExplainedFault {
  double time_s = 0.0;  // from the recording's instant
  Fault fault = Fault::none;
  FaultReading reading{};
};

// A stretch of time in which the firmware did the same thing.
struct ReactionStep {
  double from_s = 0.0;
  double to_s = 0.0;
  State state = State::idle;
  std::string drives;  // "spring law", "damping", "hold", "off", …
};

// All that is said of a recording. Times are seconds from its instant.
struct Explanation {
  std::string title;
  std::string date;  // UTC, of the instant
  FreezeCause cause = FreezeCause::fault;
  std::vector<ExplainedFault>
      faults;                       // the first one is the recording's own, unless it was killed without one
  std::vector<ReactionStep> steps;  // from just before the instant on
  double before_s = 0.0;            // what the recording holds
  double after_s = 0.0;
  std::uint64_t missing_cycles = 0;  // by the cycle counter, overruns not counted
  std::vector<std::string> notes;
  ReportData data;  // columns, phases, events, configuration for the plots
};

Explanation explain(const Recording& recording);

// For a terminal: which check fired with value and limit, what was done, the cure.
std::string explanation_text(const Explanation& explanation);

// "bus passive" -> what a person reads; used by text and page.
std::string in_plain_words(std::string_view name);

}  // namespace sandhopper
