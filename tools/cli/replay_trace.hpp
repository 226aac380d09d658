#pragma once
#include <string>

#include "tools/cli/session.hpp"

namespace sandhopper::cli {

struct ReplayTraceOptions {
  std::string trace;      // file with candump -L text
  std::string bus;        // interface to take from the trace; empty: all
  std::string interface;  // interface to play the replies on; empty: none
  std::string output;     // file for the replies as CSV; empty: none
};

// `hop replay --can`: decodes the drives' replies of a CAN trace and lists the other frames.
ExitCode replay_trace(Session& session, const ReplayTraceOptions& options);

}  // namespace sandhopper::cli
