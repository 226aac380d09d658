#pragma once
#include <string>
#include <vector>

#include "tools/conceal/core/keys.hpp"
#include "tools/conceal/core/random.hpp"
#include "tools/conceal/core/table.hpp"
#include "tools/conceal/core/trace.hpp"

namespace sandhopper::conceal {

// Faults of one recorded channel; none by default.
struct ChannelFaults {
  double offset = 0.0;
  double gain = 1.0;
  double late_s = 0.0;           // A value appears in the row this long after its time, s.
  double lag_s = 0.0;            // time constant of a first-order lag
  double drift = 0.0;            // Its clock runs fast by this fraction.
  double limit = 0.0;            // Readings are clipped to +-limit; 0: no limit.
  double dropout_rate_Hz = 0.0;  // The reading drops to zero with this rate
  double dropout_s = 0.0;        // for this long.
  double stuck_rate_Hz = 0.0;    // Reading repeats its last value.
  double stuck_s = 0.0;
};

// Measuring chain of one channel without faults.
struct ChannelChain {
  double bandwidth_Hz = 0.0;  // first-order low pass; 0: none
  double latency_s = 0.0;
  double rate_Hz = 0.0;  // Samples on its own clock, empty cells in between; 0: a sample in every row.
  double offset = 0.0;   // offset in this trial
  double noise = 0.0;    // standard deviation of one sample
  double quantum = 0.0;  // step of the reading; 0: none
  int decimals = 6;
};

// Adds a channel to the table: the truth through its chain and its faults, one value for each time in
// `rows_s`.
void record_channel(Table& table, const std::string& name, const Trace& truth,
                    const std::vector<double>& rows_s, const ChannelChain& chain, const ChannelFaults& faults,
                    const TrialRandom& trial);

}  // namespace sandhopper::conceal
