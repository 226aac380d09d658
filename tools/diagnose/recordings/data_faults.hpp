#pragma once
#include <string>
#include <vector>

#include "tools/diagnose/model/context.hpp"
#include "tools/diagnose/model/trial.hpp"

namespace sandhopper::diagnose {

// A channel that held a value, fell out, or stopped at a limit while the quantity went on.
struct DataFault {
  std::string channel;
  std::string id;  // data.stuck, data.dropout, imu.clipping or sensor.saturation
  std::size_t stretches = 0;
  double duration_s = 0.0;  // median of a stretch
  double step_s = 0.0;      // between samples: how well a duration is known
  double rate_Hz = 0.0;     // stretches per second of recording
  double recorded_s = 0.0;
  double limit = 0.0;             // where the range ends; 0: it is another fault
  double limit_resolution = 0.0;  // half a step of the channel's grid
  bool borderline = false;        // a held value that short may be what a logger puts where samples are lost
  std::vector<std::string> trials;
};

// Finds them, and empties the cells that hold no measurement. A resting or coarse sensor repeats values, too:
// a stretch counts where its neighbourhood shows that repeats of that length do not come by chance. A gap
// now and then is no fault.
std::vector<DataFault> remove_data_faults(std::vector<Trial>& trials);

// Takes out of `faults` the accelerometers that stop where the belief says their range ends: nothing is
// missing there, the samples only tell that there was more.
std::vector<DataFault> take_known_limits(std::vector<DataFault>& faults, const Belief& belief);

// And those that happened once, in one trial of many: that is an event, no fault of the sensor.
std::vector<DataFault> take_single_events(std::vector<DataFault>& faults, std::size_t trials);

}  // namespace sandhopper::diagnose
