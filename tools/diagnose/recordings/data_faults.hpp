#pragma once
#include <string>
#include <vector>

#include "tools/diagnose/model/context.hpp"
#include "tools/diagnose/model/trial.hpp"

namespace sandhopper::diagnose {

// A fault of a channel's recording: it held a value, lost samples or stopped at a limit while the quantity
// changed.
struct DataFault {
  std::string channel;
  std::string id;  // data.stuck, data.dropout, data.spike, imu.clipping or sensor.saturation
  std::size_t stretches = 0;
  double duration_s = 0.0;  // median duration of a stretch
  double step_s = 0.0;      // sample period: resolution of duration_s
  double rate_Hz = 0.0;     // stretches per second of recording; data.stuck: per second between stretches
  double recorded_s = 0.0;
  double limit = 0.0;               // end of the range, or the largest jump; 0: neither
  bool at_both_ends = false;        // the range also ends at -limit
  double limit_resolution = 0.0;    // half a step of the channel's grid
  bool borderline = false;          // not certain; e.g. a logger may fill lost samples with the last value
  std::vector<std::string> trials;  // their names
};

// Finds data faults and empties the cells that hold no measurement. A resting or coarse sensor repeats
// values, too; a stretch counts only if repeats of that length are unlikely in its neighbourhood. Occasional
// gaps are no fault.
std::vector<DataFault> remove_data_faults(std::vector<Trial>& trials);

// Removes from `faults`, and returns, accelerometers that clip at the range that the belief states. It is no
// missing physics; the true values were only larger.
std::vector<DataFault> take_known_limits(std::vector<DataFault>& faults, const Belief& belief);

// Removes from `faults`, and returns, the spikes: they are left out, and nothing else follows from them.
std::vector<DataFault> take_spikes(std::vector<DataFault>& faults);

// Removes from `faults`, and returns, those that happened only once, if there are at least three trials: that
// is an event, no sensor fault.
std::vector<DataFault> take_single_events(std::vector<DataFault>& faults, std::size_t trials);

}  // namespace sandhopper::diagnose
