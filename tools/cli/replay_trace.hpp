#pragma once
#include <string>

#include "tools/cli/session.hpp"

namespace sandhopper::cli {

struct ReplayTraceOptions {
  std::string trace;      // candump -L text
  std::string bus;        // interface of the trace to take; empty: all
  std::string interface;  // to play the replies on; empty: none
  std::string output;     // CSV of the replies; empty: none
};

// `hop replay --can`: the replies of a CAN trace, and what it contains besides them.
ExitCode replay_trace(Session& session, const ReplayTraceOptions& options);

}  // namespace sandhopper::cli
