#pragma once
#include <string>
#include <vector>

#include "tools/conceal/core/keys.hpp"
#include "tools/conceal/core/random.hpp"
#include "tools/conceal/core/table.hpp"
#include "tools/conceal/core/trace.hpp"

namespace sandhopper::conceal {

// What may be wrong with one recorded channel; nothing by default.
struct ChannelFaults {
  double offset = 0.0;
  double gain = 1.0;
  double late_s = 0.0;           // a value stands in a row this much after its instant
  double lag_s = 0.0;            // first-order
  double drift = 0.0;            // its clock runs fast by this share
  double limit = 0.0;            // clips beyond +-limit; 0: none
  double dropout_rate_Hz = 0.0;  // falls to zero this often …
  double dropout_s = 0.0;        // … for this long
  double stuck_rate_Hz = 0.0;    // repeats its last value
  double stuck_s = 0.0;
};

struct ChannelChain {
  double bandwidth_Hz = 0.0;  // first-order low pass; 0: none
  double latency_s = 0.0;
  double rate_Hz = 0.0;  // asynchronous sampling, empty cells between; 0: every row
  double offset = 0.0;   // of this trial
  double noise = 0.0;
  double quantum = 0.0;  // least step of the reading; 0: none
  int decimals = 6;
};

// A channel of the table: the truth through the chain and its faults, one value per instant of `rows_s`.
void record_channel(Table& table, const std::string& name, const Trace& truth,
                    const std::vector<double>& rows_s, const ChannelChain& chain, const ChannelFaults& faults,
                    const Random& trial);

}  // namespace sandhopper::conceal
